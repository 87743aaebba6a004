// SPDX-License-Identifier: MIT
// Kernels on lattices that conform to curves: force, product and energy against an energy that is
// summed up here from the geometry alone, and its differences.
#include <map>

#include <gtest/gtest.h>

#include "support/conforming_scene.h"
#include "support/random_curves.h"

namespace drumhead {
namespace {

using namespace conforming_scene;

/// Deformed place of a vertex of cell (i, j).
Point deformed(Scene& scene, int cell, int i, int j, int code) {
  const grid::ConformingCells& cells = scene.cells();
  if (code >= 4) {
    const grid::HeldNode& node = cells.curve_node[std::size_t(code - 4)];
    const kernels::HeldNode<double>& state = scene.special_cells().crossing[std::size_t(code - 4)];
    return node.rest + node.wanted + Point{state.off_x, state.off_y};
  }
  const int x = i + (code & 1), y = j + (code >> 1);
  const Point rest = cell >= 0 ? cells.rest(cell, j, code) : Point{double(x), double(y)};
  return rest + Point{scene.level.ux.view().at(x, y), scene.level.uy.view().at(x, y)};
}

constexpr double kGamma = 0.5;  // of the jumps between parts

struct Energy {
  double elastic = 0.0, volume = 0.0, merit = 0.0, constraint = 0.0, lagrangian = 0.0;
};

void add_volume(Energy& energy, double change, double area, double p) {
  energy.volume += 0.5 * kKappa * change * change / area;
  energy.merit += 0.5 * kKappa * change * change / area;
  energy.lagrangian += p * change - 0.5 * area * p * p / kKappa;
}

/// Of a part with jumps Σ (P − P_n) and Σ (P − P_n)², strengths included.
void add_joined(Energy& energy, double change, double area, double p, double jumps,
                double squares) {
  const double lagrangian = p * change - 0.5 * area * p * p / kKappa - 0.25 * squares;
  const double gap = change - area * p / kKappa - jumps;
  energy.volume += lagrangian;
  energy.merit += p * gap + 0.5 * kKappa * gap * gap / area;
  energy.lagrangian += lagrangian;
}

void add_regular(Scene& scene, int i, int j, Energy& energy) {
  std::array<Point, 4> x;
  for (int c = 0; c < 4; ++c) x[std::size_t(c)] = deformed(scene, -1, i, j, c);
  for (const auto& [a, b] : {std::pair{0, 1}, {2, 3}, {0, 2}, {1, 3}}) {
    const Point edge = x[std::size_t(b)] - x[std::size_t(a)];
    energy.elastic += 0.25 * grid::dot(edge, edge);
  }
  const double area = 0.5 * grid::cross(x[3] - x[0], x[2] - x[1]);
  add_volume(energy, area - 1.0, 1.0, scene.level.pressure.view().at(i, j));
}

/// A cell's or part's side of a piece of its outline.
struct Element {
  int cell, part;  // part −1: a regular cell
  Point from, to;
  bool held;
};
/// By the nodes at their ends.
using Pieces = std::map<std::pair<int, int>, std::vector<Element>>;

Pieces pieces_of(Scene& scene) {
  const grid::ConformingCells& cells = scene.cells();
  Pieces pieces;
  auto add = [&](int special, int i, int j, int part, const std::vector<int>& codes) {
    auto number = [&](int code) {
      return code < 4 ? (j + (code >> 1)) * (kNx + 1) + i + (code & 1) : 1000 + code;
    };
    auto held = [&](int code) {
      return code >= 4 || cells.find_node(i + (code & 1), j + (code >> 1)) >= 0;
    };
    for (std::size_t n = 0; n < codes.size(); ++n) {
      const int a = codes[n], b = codes[(n + 1) % codes.size()];
      pieces[std::minmax({number(a), number(b)})].push_back(
          {j * kNx + i, part, deformed(scene, special, i, j, a), deformed(scene, special, i, j, b),
           held(a) && held(b)});
    }
  };
  for (int j = 0; j < kNy; ++j)
    for (int i = 0; i < kNx; ++i) {
      const int c = cells.find_cell(i, j);
      if (c < 0) {
        add(-1, i, j, -1, {0, 1, 3, 2});
        continue;
      }
      for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1]; ++p)
        add(c, i, j, p,
            {cells.part_node.begin() + cells.part_node_begin[std::size_t(p)],
             cells.part_node.begin() + cells.part_node_begin[std::size_t(p) + 1]});
    }
  return pieces;
}

/// Whether two parts of special cells, on one side of the curves, have the piece in common.
bool joins(const std::vector<Element>& piece) {
  return piece.size() == 2 && piece[0].cell != piece[1].cell && piece[0].part >= 0 &&
         piece[1].part >= 0 && !piece[0].held;
}

/// Of every part the parts that it is joined with.
std::vector<std::vector<int>> joined_parts(Scene& scene) {
  std::vector<std::vector<int>> joined(std::size_t(scene.cells().parts()));
  for (const auto& [ends, piece] : pieces_of(scene)) {
    if (!joins(piece)) continue;
    joined[std::size_t(piece[0].part)].push_back(piece[1].part);
    joined[std::size_t(piece[1].part)].push_back(piece[0].part);
  }
  return joined;
}

void add_special(Scene& scene, int cell, int i, int j, const std::vector<std::vector<int>>& joined,
                 Energy& energy) {
  const grid::ConformingCells& cells = scene.cells();
  for (int p = cells.part_begin[std::size_t(cell)]; p < cells.part_begin[std::size_t(cell) + 1];
       ++p) {
    double area = 0.0;
    const int first = cells.part_node_begin[std::size_t(p)];
    for (int t = cells.part_triangle_begin[std::size_t(p)];
         t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
      const grid::PartTriangle& triangle = cells.triangle[std::size_t(t)];
      Eigen::Matrix2d f = Eigen::Matrix2d::Zero();
      for (std::size_t a = 0; a < 3; ++a) {
        const int code = cells.part_node[std::size_t(first + triangle.node[a])];
        const Point x = deformed(scene, cell, i, j, code), g = triangle.gradient[a];
        f += Eigen::Vector2d(x.x, x.y) * Eigen::RowVector2d(g.x, g.y);
      }
      energy.elastic += 0.5 * triangle.area * f.squaredNorm();
      area += triangle.area * f.determinant();
    }
    const std::vector<double>& pressure = scene.level.conforming->pressure;
    const double own = pressure[std::size_t(p)], rest = cells.part_area[std::size_t(p)];
    double jumps = 0.0, squares = 0.0;
    for (const int other : joined[std::size_t(p)]) {
      const double jump = own - pressure[std::size_t(other)];
      jumps += 0.5 * kGamma * jump;  // 1/(mu_a + mu_b) = 1/2
      squares += 0.5 * kGamma * jump * jump;
    }
    if (joined[std::size_t(p)].empty())
      add_volume(energy, area - rest, rest, own);
    else
      add_joined(energy, area - rest, rest, own, jumps, squares);
  }
}

/// Of the springs of soft curves.
double constraint(Scene& scene) {
  const grid::ConformingCells& cells = scene.cells();
  double sum = 0.0;
  auto add = [&](const grid::HeldNode& node, Point u) {
    if (!std::isinf(node.stiffness))
      sum += 0.5 * node.stiffness * grid::dot(u - node.wanted, u - node.wanted);
  };
  for (int j = 0; j <= kNy; ++j)
    for (int n = cells.node_begin[std::size_t(j)]; n < cells.node_begin[std::size_t(j) + 1]; ++n) {
      const int i = cells.node_column[std::size_t(n)];
      add(cells.node[std::size_t(n)],
          {scene.level.ux.view().at(i, j), scene.level.uy.view().at(i, j)});
    }
  for (std::size_t n = 0; n < cells.curve_node.size(); ++n) {
    const kernels::HeldNode<double>& state = scene.special_cells().crossing[n];
    add(cells.curve_node[n], {state.ux(), state.uy()});
  }
  return sum;
}

Energy energy_of(Scene& scene) {
  Energy energy;
  const std::vector<std::vector<int>> joined = joined_parts(scene);
  for (int j = 0; j < kNy; ++j)
    for (int i = 0; i < kNx; ++i)
      if (const int cell = scene.cells().find_cell(i, j); cell >= 0)
        add_special(scene, cell, i, j, joined, energy);
      else
        add_regular(scene, i, j, energy);
  energy.constraint = constraint(scene);
  energy.lagrangian += energy.elastic + energy.constraint;
  return energy;
}

/// The state moved by step·d.
Energy energy_at(Scene& scene, const Eigen::VectorXd& d, double step) {
  const Eigen::VectorXd before = scene.state();
  scene.set_state(before + step * d);
  const Energy energy = energy_of(scene);
  scene.set_state(before);
  return energy;
}

TEST(ConformingScene, HasAllKindsOfCells) {
  Scene scene;
  const auto& rows = scene.level.conforming->rows;
  EXPECT_GT(scene.cells().cells(), 15);
  EXPECT_GT(scene.cells().parts(), scene.cells().cells());
  EXPECT_GT(scene.cells().node.size(), 3u);
  EXPECT_GT(scene.cells().curve_node.size(), 10u);
  EXPECT_LT(rows.near_begin(kNy + 1), (kNx - 1) * (kNy - 1));
}

class ConformingKernels : public testing::TestWithParam<Weights> {};
INSTANTIATE_TEST_SUITE_P(HardAndSoft, ConformingKernels, testing::ValuesIn(kWeights));

// The energy is a polynomial of degree two in each of x and P: central differences are exact.
TEST_P(ConformingKernels, ForceIsMinusTheDerivativeOfTheEnergy) {
  Scene scene(GetParam());
  const Eigen::VectorXd force = scene.force();
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(force.size(), k);
    const double slope =
        0.5 * (energy_at(scene, unit, 1.0).lagrangian - energy_at(scene, unit, -1.0).lagrangian);
    ASSERT_NEAR(force[k], -slope, 1e-10) << "unknown " << k;
  }
}

TEST_P(ConformingKernels, ProductIsTheDerivativeOfTheForce) {
  Scene scene(GetParam());
  const Eigen::MatrixXd matrix = scene.assembled();
  EXPECT_LT((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::VectorXd d = Eigen::VectorXd::Random(matrix.cols());
  const Eigen::VectorXd before = scene.state();
  scene.set_state(before + d);
  const Eigen::VectorXd ahead = scene.force();
  scene.set_state(before - d);
  const Eigen::VectorXd behind = scene.force();
  EXPECT_LT((matrix * d + 0.5 * (ahead - behind)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_P(ConformingKernels, TheHessianSeesPressuresClamped) {
  Scene scene(GetParam());
  scene.level.clamp_centre = 0.2;
  scene.level.clamp_width = 0.5;
  const Eigen::MatrixXd clamped = scene.assembled();
  auto clamp = [](double& p) { p = std::clamp(p - 0.2, -0.5, 0.5); };
  for (int j = 0; j < kNy; ++j)
    for (int i = 0; i < kNx; ++i) clamp(scene.level.pressure.view().at(i, j));
  for (double& p : scene.level.conforming->pressure) clamp(p);
  scene.level.clamp_centre = 0.0;
  scene.level.clamp_width = 1e30;
  EXPECT_LT((scene.assembled() - clamped).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(ConformingKernels, EnergySumsAreThoseOfTheGeometry) {
  Scene scene(GetParam());
  const Eigen::VectorXd d = 0.1 * Eigen::VectorXd::Random(scene.force().size());
  scene.scatter(d, scene.level.d.view());
  // Parts have the pressures of the full step.
  const Eigen::Index parts = scene.cells().parts(),
                     first = d.size() - scene.curve_unknowns() - parts;
  for (const double step : {0.0, 0.5}) {
    const kernels::EnergySums sums =
        kernels::energy<double>(scene.level.membrane(), scene.level.d.view(), step);
    Eigen::VectorXd move = step * d;
    move.segment(first, parts) = d.segment(first, parts);
    const Energy expected = energy_at(scene, move, 1.0);
    EXPECT_NEAR(sums.elastic, expected.elastic, 1e-10);
    EXPECT_NEAR(sums.volume, expected.volume, 1e-10);
    EXPECT_NEAR(sums.constraint, expected.constraint, 1e-10);
    EXPECT_NEAR(sums.volume_merit, expected.merit, 1e-10);  // kappa ≤ 100 mu
  }
}

/// The jump term from the geometry: the volume rows' matrix.
Eigen::MatrixXd jump_term(Scene& scene, double sigma) {
  std::vector<int> row(std::size_t(kNx * kNy), -1);  // of regular cells
  int first_part = 0;
  for (int j = 0; j < kNy; ++j)
    for (int i = 0; i < kNx; ++i)
      if (scene.cells().find_cell(i, j) < 0) row[std::size_t(j * kNx + i)] = first_part++;
  const int rows = first_part + scene.cells().parts();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, rows);
  for (const auto& [ends, elements] : pieces_of(scene)) {
    if (elements.size() != 2 || elements[0].cell == elements[1].cell) continue;
    const bool parts = elements[0].part >= 0 && elements[1].part >= 0;
    if (parts && !joins(elements)) continue;
    const Point edge = elements[0].to - elements[0].from;
    const double weight = sigma * grid::dot(edge, edge) / 16.0;
    const auto place = [&](const Element& e) {
      return e.part < 0 ? row[std::size_t(e.cell)] : first_part + e.part;
    };
    const int a = place(elements[0]), b = place(elements[1]);
    matrix(a, a) -= weight;
    matrix(b, b) -= weight;
    matrix(a, b) += weight;
    matrix(b, a) += weight;
  }
  return matrix;
}

TEST_P(ConformingKernels, TheJumpTermSeesPartsAndRegularCells) {
  Scene scene(GetParam());
  const Eigen::MatrixXd without = scene.assembled();
  scene.level.pressure_jump = 0.4;
  Eigen::MatrixXd difference = scene.assembled() - without;
  const Eigen::MatrixXd expected = jump_term(scene, 0.4);
  const Eigen::Index first = difference.rows() - scene.curve_unknowns() - expected.rows();
  difference.block(first, first, expected.rows(), expected.cols()) -= expected;
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(expected.bottomRows(scene.cells().parts()).cwiseAbs().maxCoeff(), 0.01);
}

// Among random curves there are parts with several neighbours across one side.
TEST(ConformingKernels, AConstantPressureHasNoJump) {
  int several = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    grid::RandomCurves random(seed, kNx, kNy);
    Scene scene(std::vector<grid::CurvePair>{random.any(), random.any(), random.any()});
    const kernels::Unknowns<double> d = scene.level.d.view(), out = scene.level.f.view();
    for (int j = 0; j < kNy; ++j)
      for (int i = 0; i < kNx; ++i) d.p.at(i, j) = scene.special(i, j) ? 0.0 : 1.0;
    std::fill_n(d.listed, d.listed_count, 1.0);
    std::vector<double> product[2];
    for (const double jump : {0.0, 0.4}) {
      scene.level.pressure_jump = jump;
      kernels::SpecialRows<double>& rows = scene.level.conforming->rows;
      rows.linearise(scene.level.membrane());
      kernels::apply_hessian<double>(scene.level.membrane(), d, out);
      product[jump > 0.0].assign(out.listed, out.listed + out.listed_count);
      for (int p = 0; p < out.listed_count && rows.has_jumps(); ++p) several += rows.jumps(p).more;
    }
    for (std::size_t p = 0; p < product[0].size(); ++p)
      EXPECT_NEAR(product[0][p], product[1][p], 1e-12) << seed << " part " << p;
  }
  EXPECT_GT(several, 0);
}

}  // namespace
}  // namespace drumhead
