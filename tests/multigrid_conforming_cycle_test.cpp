// SPDX-License-Identifier: MIT
// The relaxation on lattices that conform to curves against Gauss–Seidel and Kaczmarz on the
// assembled matrix, its restriction against the definition, bit-equality for any number of threads,
// and the convergence of cycles.
#include <limits>

#include <gtest/gtest.h>

#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/threads.h>

#include "support/conforming_scene.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

using namespace conforming_scene;

/// Numbers of the unknowns in the assembled matrix.
struct Numbering {
  std::vector<int> node, cell;  ///< of x (y follows) and of P, −1: none
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
  }
};

/// The relaxation as relax.h orders it, row by row of the assembled matrix.
class DenseRelaxation {
 public:
  DenseRelaxation(Scene& scene, Eigen::MatrixXd matrix, Eigen::VectorXd f)
      : scene_(scene), number_(scene), a_(std::move(matrix)), f_(std::move(f)), d_(f_.size()) {
    d_.setZero();
  }

  Eigen::VectorXd run() {
    for (const int colour : {0, 1})
      Scene::for_interior([&](int i, int j) {
        if ((i + j + colour) % 2 == 0 && !near(i, j)) gauss_seidel(i, j);
      });
    near_nodes();
    for (const bool reverse : {false, true})
      for (const int rows : {0, 1})
        for (const int columns : {0, 1}) volume_rows(rows != reverse, columns != reverse, reverse);
    near_nodes();
    for (const bool reverse : {false, true})
      for (const int rows : {0, 1})
        for (const int columns : {0, 1})
          volume_rows(rows != reverse, columns != reverse, reverse, false);
    return d_;
  }

 private:
  bool near(int i, int j) const {
    return scene_.known(i, j) || scene_.special(i - 1, j - 1) || scene_.special(i, j - 1) ||
           scene_.special(i - 1, j) || scene_.special(i, j);
  }
  void gauss_seidel(int i, int j) {
    const int n = number_.node[std::size_t(j * (kNx + 1) + i)];
    if (n < 0) return;
    const Eigen::Vector2d r = f_.segment(n, 2) - a_.middleRows(n, 2) * d_;
    d_[n] += r[0] / a_(n, n);
    d_[n + 1] += r[1] / a_(n + 1, n + 1);
  }
  void near_nodes() {
    for (const int parity : {0, 1})
      Scene::for_interior([&](int i, int j) {
        if (j % 2 == parity && near(i, j)) gauss_seidel(i, j);
      });
  }
  void volume_rows(bool row_parity, bool column_parity, bool reverse, bool with_regular = true) {
    for (int j = row_parity; j < kNy; j += 2)
      for (int i = column_parity; i < kNx; i += 2) {
        const int c = scene_.cells().find_cell(i, j);
        if (c < 0) {
          if (with_regular) kaczmarz(number_.cell[std::size_t(j * kNx + i)], true);
          continue;
        }
        const int begin = scene_.cells().part_begin[std::size_t(c)],
                  end = scene_.cells().part_begin[std::size_t(c) + 1];
        for (int m = 0; m < end - begin; ++m)
          kaczmarz(number_.first_part + (reverse ? end - 1 - m : begin + m), false);
      }
  }
  /// Regular rows take 1/K_ii = 1/4 for all their corners but those on the boundary.
  void kaczmarz(int p, bool regular) {
    const double r = f_[p] - a_.row(p).dot(d_);
    double s = -a_(p, p) + 1e-6 / 4.0;
    Eigen::VectorXd move = Eigen::VectorXd::Zero(d_.size());
    for (int n = 0; n < first_pressure(); ++n) {
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
                                      .fq = level.fq.data()};
  system.transfer = &level.conforming->to_coarse;
  system.coarse_special = &scene.hierarchy[1].conforming->rows;
  return system;
}

TEST(ConformingRelaxation, IsGaussSeidelAndKaczmarzOnTheAssembledMatrix) {
  for (const double jump : {0.0, 0.4}) {
    Scene scene;
    scene.level.clamp_width = 0.5;
    scene.level.pressure_jump = jump;
    const Eigen::MatrixXd matrix = scene.assembled();
    const Eigen::VectorXd f = Eigen::VectorXd::Random(matrix.rows());
    scene.scatter(f, scene.level.f.view());
    scene.level.d.clear();
    kernels::relax<double>(system_of(scene), {.from_zero = true}, nullptr, nullptr,
                           scene.hierarchy.scratch());
    const Eigen::VectorXd expected = DenseRelaxation(scene, matrix, f).run();
    EXPECT_LT((scene.gather(scene.level.d.view()) - expected).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_EQ(scene.gather(scene.level.f.view()), f);
  }
}

/// Weights of the coarse corners at a point of special coarse cell c, by the triangle it is deepest
/// in.
std::array<double, 4> triangle_weights(const grid::ConformingCells& coarse, int c, int J, Point at,
                                       double& depth) {
  std::array<double, 4> weights{};
  depth = -1e9;
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
      if (least <= depth) continue;
      depth = least;
      weights = {};
      for (std::size_t a = 0; a < 3; ++a)
        if (code[a] < 4) weights[std::size_t(code[a])] = area[a];
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
    const Point at{0.5 * i, 0.5 * j};
    int I = i / 2, J = j / 2;
    std::array<double, 4> weights{(1 - (at.x - I)) * (1 - (at.y - J)),
                                  (at.x - I) * (1 - (at.y - J)), (1 - (at.x - I)) * (at.y - J),
                                  (at.x - I) * (at.y - J)};
    double deepest = -1e9;
    for (int y = (j - 1) / 2; y <= j / 2; ++y)
      for (int x = (i - 1) / 2; x <= i / 2; ++x) {
        const int c = coarse.find_cell(x, y);
        if (c < 0) continue;
        double depth = 0.0;
        std::array<double, 4> candidate = triangle_weights(coarse, c, y, at, depth);
        if (depth <= deepest + 1e-12) continue;
        deepest = depth;
        weights = candidate;
        I = x;
        J = y;
      }
    to.x.at(i, j) = to.y.at(i, j) = 0.0;
    for (int c = 0; c < 4; ++c) {
      if (j % 2 == 0 && J + (c >> 1) != j / 2) continue;
      to.x.at(i, j) += weights[std::size_t(c)] * from.x.at(I + (c & 1), J + (c >> 1));
      to.y.at(i, j) += weights[std::size_t(c)] * from.y.at(I + (c & 1), J + (c >> 1));
    }
  });
  auto pressure = [&](int i, int j, Point centre) {
    const int c = coarse.find_cell(i / 2, j / 2);
    return c < 0 ? from.p.at(i / 2, j / 2) : from.listed[coarse.part_at(c, 0.5 * centre)];
  };
  for (int j = 0; j < kNy; ++j)
    for (int i = 0; i < kNx; ++i)
      if (const int c = fine.find_cell(i, j); c < 0)
        to.p.at(i, j) = pressure(i, j, {i + 0.5, j + 0.5});
      else
        for (int p = fine.part_begin[std::size_t(c)]; p < fine.part_begin[std::size_t(c) + 1]; ++p)
          to.listed[p] = pressure(i, j, fine.part_centre[std::size_t(p)]);
}

/// A random correction of the coarse level, 0 where that has no equation.
void fill_coarse(Level<double>& coarse) {
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const kernels::Unknowns<double> e = coarse.d.view();
  for (int J = 1; J < coarse.ny; ++J)
    for (int I = 1; I < coarse.nx; ++I)
      if (coarse.conforming->geometry.find_node(I, J) < 0) {
        e.x.at(I, J) = number(bits);
        e.y.at(I, J) = number(bits);
      }
  for (int J = 0; J < coarse.ny; ++J)
    for (int I = 0; I < coarse.nx; ++I)
      if (coarse.conforming->geometry.find_cell(I, J) < 0) e.p.at(I, J) = number(bits);
  for (int p = 0; p < e.listed_count; ++p) e.listed[p] = number(bits);
}

// With the prolonged correction as the solution, the sweeps after it have nothing to do.
TEST(ConformingRelaxation, ProlongsByTrianglesAndSides) {
  Scene scene;
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

TEST(ConformingRelaxation, RestrictsByTheAdjoint) {
  Scene scene;
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
  const double restricted = kernels::dot<double>(r, e) + kernels::dot_listed<double>(r, e);
  EXPECT_NEAR(restricted, left.dot(scene.gather(scene.level.d.view())), 1e-11);
  for (int J = 1; J < coarse.ny; ++J)
    for (int I = 1; I < coarse.nx; ++I)
      if (coarse.conforming->geometry.find_node(I, J) >= 0) {
        EXPECT_EQ(to.x.at(I, J), 0.0);
      }
}

std::vector<float> after_cycles(int threads) {
  const kernels::ThreadLimit limit(threads);
  const multigrid::WarpProblem problem =
      scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), 512, 10.0);
  grid::MemoryMeter meter;
  multigrid::Hierarchy<float> hierarchy(problem.lattice, problem.material,
                                        grid::cut({}, problem.lattice, 1e6), {}, meter);
  hierarchy.conform(problem.curves, problem.lattice, meter);
  Level<float>& level = hierarchy[0];
  multigrid::Cycle<float> cycle(hierarchy, 0, true, 1.0f);
  kernels::force<float>(level.membrane(), level.f.view());
  cycle.run(multigrid::CycleKind::v, true);
  cycle.run(multigrid::CycleKind::v, false);
  std::vector<float> out = level.d.listed;
  for (int j = 0; j <= level.ny; ++j)
    for (int i = 0; i <= level.nx; ++i) {
      out.push_back(level.d.x.view().at(i, j));
      out.push_back(level.d.y.view().at(i, j));
    }
  return out;
}

TEST(ConformingRelaxation, GivesTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<float> one = after_cycles(1);
  EXPECT_EQ(one, after_cycles(2));
  EXPECT_EQ(one, after_cycles(5));
}

// The study found .21 to .23 for V(1,1) on S2 and S4 at 64² to 256².
TEST(ConformingCycle, ConvergesAsOnARegularLattice) {
  for (const scenes::Scene& scene :
       {scenes::roundabout(90.0, scenes::kStudyOffset), scenes::shift(scenes::kStudyOffset)})
    for (const int n : {64, 128}) {
      const multigrid::WarpProblem problem = scenes::problem(scene, n, 0.0);
      grid::MemoryMeter meter;
      multigrid::Hierarchy<double> hierarchy(problem.lattice, problem.material,
                                             grid::cut({}, problem.lattice, 1e6),
                                             {.pressure = false}, meter);
      hierarchy.conform(problem.curves, problem.lattice, meter);
      kernels::force<double>(hierarchy[0].harmonic(), hierarchy[0].f.view());
      multigrid::Cycle<double> cycle(hierarchy, 0, false, 1.0);
      const kernels::LevelSystem<double> system = cycle.system(0);
      std::vector<double> norm;
      for (int n_cycle = 0; n_cycle < 10; ++n_cycle) {
        cycle.run(multigrid::CycleKind::v, n_cycle == 0);
        norm.push_back(std::sqrt(kernels::residual_norm2<double>(system, hierarchy.scratch())));
      }
      const double factor = std::pow(norm[9] / norm[4], 0.2);
      std::printf("%s %d²: V(1,1) %.3f\n", scene.name.c_str(), n, factor);
      EXPECT_LT(factor, 0.26);
    }
}

// 128²: 4 to 5, 7 to 9, 10 to 15, 12 to 22, as many or fewer than with averaged rows but on S2
// (16).
TEST(ConformingCycle, ReducesResidualsBy1000ForEveryKappa) {
  const double offset = scenes::kStudyOffset, infinite = std::numeric_limits<double>::infinity();
  for (const scenes::Scene& scene :
       {scenes::sponge(offset), scenes::roundabout(90.0, offset), scenes::shift(offset)})
    for (const auto& [kappa, most] :
         {std::pair{1.0, 5}, {10.0, 9}, {100.0, 13}, {1e4, 22}, {infinite, 26}}) {
      scenes::NewtonLevel<double> level(scenes::problem(scene, 64, kappa), 0.005, 1.0,
                                        multigrid::CurveMethod::conforming);
      const multigrid::LinearReport report =
          level.solve({.content = 1e-3, .reduction = 1e-3, .most_cycles = 40});
      std::printf("%s 64² kappa %g: %d cycles, %.1e\n", scene.name.c_str(), kappa, report.cycles,
                  report.residual);
      EXPECT_LE(report.residual, 1e-3);
      EXPECT_LE(report.cycles, most);
    }
}

}  // namespace
}  // namespace drumhead
