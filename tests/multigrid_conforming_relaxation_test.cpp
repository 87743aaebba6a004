// SPDX-License-Identifier: MIT
// The relaxation on lattices that conform to curves against Gauss–Seidel and Kaczmarz on the
// assembled matrix, its transfers against their definitions.
#include <gtest/gtest.h>

#include <drumhead/kernels/reduce.h>

#include "support/conforming_scene.h"

namespace drumhead {
namespace {

using namespace conforming_scene;

/// Numbers of the unknowns in the assembled matrix.
struct Numbering {
  std::vector<int> node, cell, curve;  ///< of x (y follows) and of P, −1: none
  int first_part = 0;
  explicit Numbering(const Scene& scene) : node((kNx + 1) * (kNy + 1), -1), cell(kNx * kNy, -1) {
    int next = 0;
    Scene::for_interior([&](int i, int j) {
      if (scene.known(i, j)) return;
      node[std::size_t(j * (kNx + 1) + i)] = next;
      next += 2;
    });
    for (int j = 0; j < kNy; ++j)
      for (int i = 0; i < kNx; ++i)
        if (!scene.special(i, j)) cell[std::size_t(j * kNx + i)] = next++;
    first_part = next;
    next += scene.cells().parts();
    for (std::size_t n = 0; n < scene.cells().curve_node.size(); ++n) {
      curve.push_back(scene.known(n) ? -1 : next);
      if (!scene.known(n)) next += 2;
    }
  }
};

/// The relaxation as relax.h orders it, row by row of the assembled matrix.
class DenseRelaxation {
 public:
  DenseRelaxation(Scene& scene, Eigen::MatrixXd matrix, Eigen::VectorXd f)
      : scene_(scene), number_(scene), a_(std::move(matrix)), f_(std::move(f)), d_(f_.size()) {
    d_.setZero();
  }

  /// `bands`: relaxations of the regular cells within kBand columns and rows of special ones, and
  /// of those.
  Eigen::VectorXd run(int bands) {
    sweep([](int, int) { return true; }, true);
    for (int n = 0; n < bands; ++n) sweep([&](int i, int j) { return in_band(i, j); }, false);
    return d_;
  }

 private:
  static constexpr int kBand = 2;
  bool in_band(int i, int j) const {
    bool beside = false;
    for (int y = std::max(0, j - kBand); y <= std::min(kNy - 1, j + kBand); ++y)
      for (int x = i - kBand; x <= i + kBand; ++x) beside = beside || scene_.special(x, y);
    return beside && !scene_.special(i, j);
  }
  /// Of cells, and nodes at corners 00 of cells, that are `relaxed`.
  template <class F>
  void sweep(F&& relaxed, bool forwards) {
    for (const int colour : {0, 1})
      Scene::for_interior([&](int i, int j) {
        if ((i + j + colour) % 2 == 0 && !near(i, j) && relaxed(i, j)) gauss_seidel(i, j);
      });
    near_nodes();
    for (const bool reverse : {false, true})
      for (const int rows : {0, 1})
        if (reverse || forwards) volume_rows(rows != reverse, reverse, relaxed);
  }
  bool near(int i, int j) const {
    return scene_.known(i, j) || scene_.special(i - 1, j - 1) || scene_.special(i, j - 1) ||
           scene_.special(i - 1, j) || scene_.special(i, j);
  }
  void gauss_seidel(int i, int j) { gauss_seidel(number_.node[std::size_t(j * (kNx + 1) + i)]); }
  void gauss_seidel(int n) {
    if (n < 0) return;
    const Eigen::Vector2d r = f_.segment(n, 2) - a_.middleRows(n, 2) * d_;
    d_[n] += r[0] / a_(n, n);
    d_[n + 1] += r[1] / a_(n + 1, n + 1);
  }
  void near_nodes() {
    for (const int parity : {0, 1})
      for (int j = parity; j < kNy; j += 2) {
        for (int i = 1; i < kNx && j > 0; ++i)
          if (near(i, j)) gauss_seidel(i, j);
        for (std::size_t n = 0; n < number_.curve.size(); ++n)
          if (scene_.cells().curve_cell[n][1] == j) gauss_seidel(number_.curve[n]);
      }
  }
  /// Row by row the regular cells, then the parts, of each those of even columns first unless
  /// `reverse`.
  template <class F>
  void volume_rows(bool row_parity, bool reverse, F&& relaxed) {
    for (int j = row_parity; j < kNy; j += 2)
      for (const bool regular : {true, false})
        for (const bool columns : {reverse, !reverse})
          for (int i = int(columns); i < kNx; i += 2)
            if (!regular)
              parts(i, j, reverse);
            else if (!scene_.special(i, j) && relaxed(i, j))
              kaczmarz(number_.cell[std::size_t(j * kNx + i)], true);
  }
  void parts(int i, int j, bool reverse) {
    const int c = scene_.cells().find_cell(i, j);
    if (c < 0) return;
    const int begin = scene_.cells().part_begin[std::size_t(c)],
              end = scene_.cells().part_begin[std::size_t(c) + 1];
    for (int m = 0; m < end - begin; ++m)
      kaczmarz(number_.first_part + (reverse ? end - 1 - m : begin + m), false);
  }
  /// Regular rows take 1/K_ii = 1/4 for all their corners but those on the boundary.
  void kaczmarz(int p, bool regular) {
    const double r = f_[p] - a_.row(p).dot(d_);
    double s = -a_(p, p) + 1e-6 / 4.0;
    Eigen::VectorXd move = Eigen::VectorXd::Zero(d_.size());
    for (int n = 0; n < d_.size(); ++n) {
      if (n >= first_pressure() && n < number_.first_part + scene_.cells().parts()) continue;
      const double inverse = regular ? 0.25 : 1.0 / a_(n, n);
      move[n] = a_(p, n) * inverse;
      s += a_(p, n) * move[n];
    }
    d_ += r / s * move;
    d_[p] -= r / s;
  }
  int first_pressure() const {
    int first = number_.first_part;
    for (const int n : number_.cell)
      if (n >= 0) first = std::min(first, n);
    return first;
  }

  Scene& scene_;
  Numbering number_;
  Eigen::MatrixXd a_;
  Eigen::VectorXd f_, d_;
};

kernels::LevelSystem<double> system_of(Scene& scene) {
  Level<double>& level = scene.level;
  kernels::LevelSystem<double> system{.membrane = level.membrane(),
                                      .cuts = level.cuts.view(0.0),
                                      .d = level.d.view(),
                                      .f = level.f.view(),
                                      .dq = level.dq.data(),
                                      .fq = level.fq.data(),
                                      .band = &level.band};
  system.transfer = &level.conforming->to_coarse;
  system.coarse_special = &scene.hierarchy[1].conforming->rows;
  return system;
}

class ConformingRelaxation : public testing::TestWithParam<Weights> {};
INSTANTIATE_TEST_SUITE_P(HardAndSoft, ConformingRelaxation, testing::ValuesIn(kWeights));

TEST_P(ConformingRelaxation, IsGaussSeidelAndKaczmarzOnTheAssembledMatrix) {
  for (const auto& [jump, bands] : {std::pair(0.0, 0), std::pair(0.4, 0), std::pair(0.4, 2)}) {
    Scene scene(GetParam());
    scene.level.clamp_width = 0.5;
    scene.level.pressure_jump = jump;
    const Eigen::MatrixXd matrix = scene.assembled();
    const Eigen::VectorXd f = Eigen::VectorXd::Random(matrix.rows());
    scene.scatter(f, scene.level.f.view());
    scene.level.d.clear();
    kernels::relax<double>(system_of(scene), {.from_zero = true, .band = bands}, nullptr, nullptr,
                           scene.hierarchy.scratch());
    const Eigen::VectorXd expected = DenseRelaxation(scene, matrix, f).run(bands);
    EXPECT_LT((scene.gather(scene.level.d.view()) - expected).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_EQ(scene.gather(scene.level.f.view()), f);
  }
}

/// Weights of nodes of a coarse cell at a point.
struct CoarseWeights {
  std::array<double, 4> corner{};
  std::vector<std::pair<int, double>> curve;  ///< of soft curve nodes
  double depth = -1e9;
};

/// In special coarse cell c, by the triangle it is deepest in.
CoarseWeights triangle_weights(const grid::ConformingCells& coarse, int c, int J, Point at) {
  CoarseWeights weights;
  for (int p = coarse.part_begin[std::size_t(c)]; p < coarse.part_begin[std::size_t(c) + 1]; ++p)
    for (int t = coarse.part_triangle_begin[std::size_t(p)];
         t < coarse.part_triangle_begin[std::size_t(p) + 1]; ++t) {
      const grid::PartTriangle& triangle = coarse.triangle[std::size_t(t)];
      std::array<int, 3> code{};
      std::array<Point, 3> corner;
      for (std::size_t a = 0; a < 3; ++a) {
        code[a] =
            coarse
                .part_node[std::size_t(coarse.part_node_begin[std::size_t(p)] + triangle.node[a])];
        corner[a] = coarse.rest(c, J, code[a]);
      }
      std::array<double, 3> area{};
      const double whole = grid::cross(corner[1] - corner[0], corner[2] - corner[0]);
      for (std::size_t a = 0; a < 3; ++a)
        area[a] = grid::cross(corner[(a + 1) % 3] - at, corner[(a + 2) % 3] - at) / whole;
      const double least = *std::ranges::min_element(area);
      if (least <= weights.depth) continue;
      weights = {.depth = least};
      for (std::size_t a = 0; a < 3; ++a)
        if (code[a] < 4)
          weights.corner[std::size_t(code[a])] = area[a];
        else if (!std::isinf(coarse.curve_node[std::size_t(code[a] - 4)].stiffness))
          weights.curve.push_back({code[a] - 4, area[a]});
    }
  return weights;
}

/// Prolongation of the coarse correction to the fine unknowns, from the geometry: bilinear, in
/// special cells by their triangles (nodes on coarse lattice rows take nothing from other rows);
/// pressures constant on the coarse part or cell that holds the centre.
void prolong(const Scene& scene, const kernels::Unknowns<double>& from,
             const kernels::Unknowns<double>& to) {
  const grid::ConformingCells &fine = scene.cells(),
                              &coarse = scene.hierarchy[1].conforming->geometry;
  Scene::for_interior([&](int i, int j) {
    if (scene.known(i, j)) return;
    const int held = fine.find_node(i, j);
    const Point at = held < 0 ? Point{0.5 * i, 0.5 * j} : 0.5 * fine.node[std::size_t(held)].rest;
    int I = i / 2, J = j / 2;
    const double s = 0.5 * i - I, t = 0.5 * j - J;
    CoarseWeights weights{{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}, {}};
    for (int y = (j - 1) / 2; y <= j / 2; ++y)
      for (int x = (i - 1) / 2; x <= i / 2; ++x) {
        const int c = coarse.find_cell(x, y);
        if (c < 0) continue;
        const CoarseWeights candidate = triangle_weights(coarse, c, y, at);
        if (candidate.depth <= weights.depth + 1e-12) continue;
        weights = candidate;
        I = x;
        J = y;
      }
    to.x.at(i, j) = to.y.at(i, j) = 0.0;
    for (int c = 0; c < 4; ++c) {
      if (j % 2 == 0 && J + (c >> 1) != j / 2) continue;
      to.x.at(i, j) += weights.corner[std::size_t(c)] * from.x.at(I + (c & 1), J + (c >> 1));
      to.y.at(i, j) += weights.corner[std::size_t(c)] * from.y.at(I + (c & 1), J + (c >> 1));
    }
    for (const auto& [n, weight] : weights.curve) {
      to.x.at(i, j) += weight * from.curve[2 * n];
      to.y.at(i, j) += weight * from.curve[2 * n + 1];
    }
  });
  for (std::size_t n = 0; n < fine.curve_node.size(); ++n) {
    if (scene.known(n)) continue;
    const Point at = 0.5 * fine.curve_node[n].rest;
    int I = int(at.x), J = int(at.y);
    const double s = at.x - I, t = at.y - J;
    CoarseWeights weights{{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}, {}};
    for (int y = std::max(0, int(at.y - 0.3)); y <= std::min(coarse.ny - 1, int(at.y + 0.3)); ++y)
      for (int x = std::max(0, int(at.x - 0.3)); x <= std::min(coarse.nx - 1, int(at.x + 0.3));
           ++x) {
        const int c = coarse.find_cell(x, y);
        if (c < 0) continue;
        const CoarseWeights candidate = triangle_weights(coarse, c, y, at);
        if (candidate.depth <= weights.depth) continue;
        weights = candidate;
        I = x;
        J = y;
      }
    for (const int axis : {0, 1}) {
      const kernels::Plane<double>& plane = axis == 0 ? from.x : from.y;
      double value = 0.0;
      for (int c = 0; c < 4; ++c)
        value += weights.corner[std::size_t(c)] * plane.at(I + (c & 1), J + (c >> 1));
      for (const auto& [m, weight] : weights.curve) value += weight * from.curve[2 * m + axis];
      to.curve[2 * n + std::size_t(axis)] = value;
    }
  }
  auto pressure = [&](int i, int j, Point centre) {
    const int c = coarse.find_cell(i / 2, j / 2);
    return c < 0 ? from.p.at(i / 2, j / 2) : from.listed[coarse.part_at(c, j / 2, 0.5 * centre)];
  };
  for (int j = 0; j < kNy; ++j)
    for (int i = 0; i < kNx; ++i)
      if (const int c = fine.find_cell(i, j); c < 0)
        to.p.at(i, j) = pressure(i, j, {i + 0.5, j + 0.5});
      else
        for (int p = fine.part_begin[std::size_t(c)]; p < fine.part_begin[std::size_t(c) + 1]; ++p)
          to.listed[p] = pressure(i, j, fine.part_centre[std::size_t(p)]);
}

bool known(const grid::ConformingCells& cells, int i, int j) {
  const int n = cells.find_node(i, j);
  return n >= 0 && std::isinf(cells.node[std::size_t(n)].stiffness);
}

/// A random correction of the coarse level, 0 where that has no equation.
void fill_coarse(Level<double>& coarse) {
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const kernels::Unknowns<double> e = coarse.d.view();
  for (int J = 1; J < coarse.ny; ++J)
    for (int I = 1; I < coarse.nx; ++I)
      if (!known(coarse.conforming->geometry, I, J)) {
        e.x.at(I, J) = number(bits);
        e.y.at(I, J) = number(bits);
      }
  for (int J = 0; J < coarse.ny; ++J)
    for (int I = 0; I < coarse.nx; ++I)
      if (coarse.conforming->geometry.find_cell(I, J) < 0) e.p.at(I, J) = number(bits);
  for (int p = 0; p < e.listed_count; ++p) e.listed[p] = number(bits);
  for (int n = 0; n < e.curve_count; ++n)
    if (!std::isinf(coarse.conforming->geometry.curve_node[std::size_t(n / 2)].stiffness))
      e.curve[n] = number(bits);
}

// With the prolonged correction as the solution, the sweeps after it have nothing to do.
TEST_P(ConformingRelaxation, ProlongsByTrianglesAndSides) {
  Scene scene(GetParam());
  scene.level.clamp_width = 0.5;
  const Eigen::MatrixXd matrix = scene.assembled();
  Level<double>& coarse = scene.hierarchy[1];
  fill_coarse(coarse);
  prolong(scene, coarse.d.view(), scene.level.d.view());
  const Eigen::VectorXd expected = scene.gather(scene.level.d.view());
  scene.scatter(matrix * expected, scene.level.f.view());
  scene.level.d.clear();
  const kernels::Unknowns<const double> e = coarse.d.view();
  kernels::relax<double>(system_of(scene), {}, &e, nullptr, scene.hierarchy.scratch());
  EXPECT_LT((scene.gather(scene.level.d.view()) - expected).cwiseAbs().maxCoeff(), 1e-11);
}

TEST_P(ConformingRelaxation, RestrictsByTheAdjoint) {
  Scene scene(GetParam());
  scene.level.clamp_width = 0.5;
  scene.level.pressure_jump = 0.4;
  const Eigen::MatrixXd matrix = scene.assembled();
  const Eigen::VectorXd f = Eigen::VectorXd::Random(matrix.rows());
  scene.scatter(f, scene.level.f.view());
  Level<double>& coarse = scene.hierarchy[1];
  const kernels::Unknowns<double> to = coarse.f.view();
  kernels::relax<double>(system_of(scene), {.from_zero = true}, nullptr, &to,
                         scene.hierarchy.scratch());
  const Eigen::VectorXd left = f - matrix * scene.gather(scene.level.d.view());
  fill_coarse(coarse);
  prolong(scene, coarse.d.view(), scene.level.d.view());
  const kernels::Unknowns<const double> e = coarse.d.view(), r = to;
  const double restricted = kernels::dot<double>(r, e) + kernels::dot_listed<double>(r, e) +
                            kernels::dot_curve<double>(r, e);
  EXPECT_NEAR(restricted, left.dot(scene.gather(scene.level.d.view())), 1e-11);
  for (int J = 1; J < coarse.ny; ++J)
    for (int I = 1; I < coarse.nx; ++I)
      if (known(coarse.conforming->geometry, I, J)) {
        EXPECT_EQ(to.x.at(I, J), 0.0);
      }
}

}  // namespace
}  // namespace drumhead
