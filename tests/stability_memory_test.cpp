// SPDX-License-Identifier: MIT
// What a scene does not need is not stored: bytes of the solver per node, by material. Cycles alone
// solve this scene but for its start on a coarse lattice, whose directions of GCR are bounded
// apart.
#include <cstdio>

#include <gtest/gtest.h>

#include <drumhead/multigrid/warp.h>

namespace drumhead {
namespace {

constexpr int kCells = 256;
constexpr double kLevels = 4.0 / 3.0;  // all levels by the finest
// Fields have padded rows, and the curve rows are counted too.
constexpr double kPadding = 1.15, kStart = 10.0;

multigrid::Solution solve(double kappa, bool mu_cells, bool kappa_cells) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(kCells, kCells, {.cells = kCells, .margin = 0.0});
  problem.material.kappa = kappa;
  if (mu_cells) problem.material.mu_cells.assign(problem.lattice.cells(), 1.0f);
  if (kappa_cells) problem.material.kappa_cells.assign(problem.lattice.cells(), float(kappa));
  grid::CurvePair bar{.name = "bar"};
  bar.source = {grid::straight({100.3, 80.1}, {100.3, 170.1})};
  bar.target = {grid::straight({108.3, 80.1}, {108.3, 170.1})};
  problem.curves = {bar};
  multigrid::Solution solution =
      multigrid::solve(problem, {.curve_method = multigrid::CurveMethod::averaged});
  EXPECT_EQ(solution.report.status, multigrid::Status::converged);
  return solution;
}

double bytes_per_node(const multigrid::Solution& solution) {
  return double(solution.report.solver_bytes) / double(solution.lattice.nodes());
}

TEST(Memory, EachMaterialStoresItsOwnFieldsOnly) {
  const multigrid::Solution harmonic = solve(0.0, false, false), crpm = solve(1.0, false, false),
                            mu = solve(1.0, true, false), kappa = solve(1.0, false, true),
                            both = solve(1.0, true, true);
  std::printf(
      "bytes per node: harmonic %.1f, crpm %.1f, mu mask %.1f, kappa mask %.1f, both %.1f\n",
      bytes_per_node(harmonic), bytes_per_node(crpm), bytes_per_node(mu), bytes_per_node(kappa),
      bytes_per_node(both));
  const auto expect_floats = [](double bytes, double floats, double besides = 0.0) {
    EXPECT_GE(bytes, 0.99 * kLevels * 4.0 * floats);
    EXPECT_LE(bytes, kPadding * kLevels * 4.0 * floats + besides);
  };
  // State, correction and right-hand side of x and y; the same of P; mu and 1/K_ii; 1/kappa.
  expect_floats(bytes_per_node(harmonic), 6, kStart);
  expect_floats(bytes_per_node(crpm), 9, kStart);
  expect_floats(bytes_per_node(mu) - bytes_per_node(crpm), 2);
  expect_floats(bytes_per_node(kappa) - bytes_per_node(crpm), 1);
  expect_floats(bytes_per_node(both) - bytes_per_node(crpm), 3);
  EXPECT_TRUE(harmonic.pressure.empty());
}

TEST(Memory, AMaskOfOneValueIsTheConstant) {
  const multigrid::Solution constant = solve(1.0, false, false), masked = solve(1.0, true, true);
  for (std::size_t k = 0; k < constant.u_px.size(); ++k) {
    ASSERT_NEAR(masked.u_px[k], constant.u_px[k], 1e-4);
    ASSERT_NEAR(masked.v_px[k], constant.v_px[k], 1e-4);
  }
}

// No pressures exist where kappa is 0 in every cell, mask or not.
TEST(Memory, AKappaMaskOfZerosIsHarmonic) {
  multigrid::Solution zeros = solve(0.0, false, true);
  EXPECT_TRUE(zeros.pressure.empty());
  EXPECT_EQ(zeros.report.model, kernels::Model::harmonic);
  EXPECT_EQ(bytes_per_node(zeros), bytes_per_node(solve(0.0, false, false)));
}

}  // namespace
}  // namespace drumhead
