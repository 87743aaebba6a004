// SPDX-License-Identifier: MIT
// The strip beside exact rows, against the Newton system's own residual; its factorisation against
// Eigen's of the whole matrix; and the cycles that GCR takes with it.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "chain.h"
#include "curve_strip.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

constexpr int kReach = 2;  // cells around each cut one, as curve_strip.cpp has it

TEST(Chain, SolvesABlockTridiagonalMatrixWithoutADiagonal) {
  const std::vector<int> begin{0, 3, 4, 9, 16, 18, 18, 25};
  const int n = begin.back();
  std::mt19937 bits(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  auto block = [&](int row) {
    int k = 0;
    while (row >= begin[std::size_t(k) + 1]) ++k;
    return k;
  };
  multigrid::SparseRows rows;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i == j || std::abs(block(i) - block(j)) > 1) continue;
      matrix(i, j) = number(bits);
      rows.add(j, 0.25 * matrix(i, j));  // doubles are added up
      rows.add(j, 0.75 * matrix(i, j));
    }
    rows.end_row();
  }
  multigrid::Chain chain;
  matrix(3, 3) = 1.0;  // a block of one row
  multigrid::SparseRows whole;
  for (int i = 0; i < n; ++i) {
    for (int e = rows.begin[std::size_t(i)]; e < rows.begin[std::size_t(i) + 1]; ++e)
      whole.add(rows.column[std::size_t(e)], rows.value[std::size_t(e)]);
    if (i == 3) whole.add(3, 1.0);
    whole.end_row();
  }
  chain.factorise(whole, begin);
  std::vector<double> x(std::size_t(n), 0.0);
  for (double& value : x) value = number(bits);
  const Eigen::VectorXd right = Eigen::Map<Eigen::VectorXd>(x.data(), n);
  const Eigen::VectorXd expected = matrix.partialPivLu().solve(right);
  chain.solve(x);
  EXPECT_LT((Eigen::Map<Eigen::VectorXd>(x.data(), n) - expected).norm(), 1e-10 * expected.norm());
}

scenes::NewtonLevel<double> exact_level(int n, double kappa, double theta) {
  return {scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), n, kappa), 0.005, theta,
          multigrid::CurveMethod::averaged, std::numeric_limits<double>::infinity()};
}

class Strip : public testing::TestWithParam<double> {};

TEST_P(Strip, LeavesNoResidualBesideTheCurvesAndMovesNothingElse) {
  scenes::NewtonLevel<double> level = exact_level(48, GetParam(), 1e30);
  level.drop_jump();
  const multigrid::NewtonSystem<double> system = level.system();
  multigrid::Vector<double> f = system.make_vector(), x = system.make_vector(),
                            r = system.make_vector();
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto fv = f.fields.view();
  const int nx = level.level().nx, ny = level.level().ny;
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) fv.x.at(i, j) = number(bits), fv.y.at(i, j) = number(bits);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) fv.p.at(i, j) = 0.01 * number(bits);
  for (double& q : f.q) q = 0.01 * number(bits);
  multigrid::CurveStrip<double>(system).add_solution(f, x);
  system.residual(f, x, r);

  std::vector<int> near(std::size_t(nx * ny), 0);
  const kernels::Cuts<double> cuts = system.cuts();
  for (int j = 0; j < ny; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k)
      for (int b = std::max(0, j - kReach); b <= std::min(ny - 1, j + kReach); ++b)
        for (int a = std::max(0, cuts.column[k] - kReach);
             a <= std::min(nx - 1, cuts.column[k] + kReach); ++a)
          near[std::size_t(b * nx + a)] = 1;
  auto of_strip = [&](int i, int j) {
    return near[std::size_t((j - 1) * nx + i - 1)] || near[std::size_t((j - 1) * nx + i)] ||
           near[std::size_t(j * nx + i - 1)] || near[std::size_t(j * nx + i)];
  };
  const auto xv = x.fields.view(), rv = r.fields.view();
  double left = 0.0, moved = 0.0, largest = 0.0;
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) {
      largest = std::max({largest, std::abs(xv.x.at(i, j)), std::abs(xv.y.at(i, j))});
      if (of_strip(i, j))
        left = std::max({left, std::abs(rv.x.at(i, j)), std::abs(rv.y.at(i, j))});
      else
        moved = std::max({moved, std::abs(xv.x.at(i, j)), std::abs(xv.y.at(i, j))});
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (near[std::size_t(j * nx + i)])
        left = std::max(left, std::abs(rv.p.at(i, j)));
      else
        moved = std::max(moved, std::abs(xv.p.at(i, j)));
  for (const double q : r.q) left = std::max(left, std::abs(q));
  EXPECT_GT(largest, 0.1);
  EXPECT_EQ(moved, 0.0);
  EXPECT_LT(left, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Kappa, Strip, testing::Values(1.0, 1e4));

TEST(ExactRows, TakeFewCyclesAndDirectionsOnAFineLattice) {
  scenes::NewtonLevel<double> level = exact_level(180, 1e4, 1.0);
  ASSERT_GE(level.level().nodes(), multigrid::kStripNodes);
  level.drop_jump();
  const multigrid::LinearReport report =
      level.solve({.content = 1e-3, .reduction = 1e-3, .most_cycles = 60, .directions = 8});
  EXPECT_LE(report.residual, 1e-3);
  EXPECT_LE(report.cycles, 24);
}

}  // namespace
}  // namespace drumhead
