// SPDX-License-Identifier: MIT
// What a scene does not need is not stored: bytes of the solver per node, by material, and the work
// of a Newton step. Cycles alone solve this scene but for its start on a coarse lattice, whose
// directions of GCR are bounded apart.
#include <cstdio>
#include <ctime>

#include <gtest/gtest.h>

#include <drumhead/multigrid/warp.h>

namespace drumhead {
namespace {

constexpr int kCells = 256;
constexpr double kLevels = 4.0 / 3.0;  // all levels by the finest
// Fields have padded rows, and the curve rows are counted too.
constexpr double kPadding = 1.15, kStart = 10.0;
// The moves of every fourth node in this step and the last, on the finest lattice, where no mask of
// kappa is; they need not stand at the peak.
constexpr double kTurn = 4.0;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

multigrid::WarpProblem problem_of(double kappa, bool mu_cells, bool kappa_cells,
                                  kernels::Model model) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(kCells, kCells, {.cells = kCells, .margin = 0.0});
  problem.material.kappa = kappa;
  problem.material.model = model;
  if (mu_cells) problem.material.mu_cells.assign(problem.lattice.cells(), 1.0f);
  if (kappa_cells) problem.material.kappa_cells.assign(problem.lattice.cells(), float(kappa));
  grid::CurvePair bar{.name = "bar"};
  bar.source = {grid::straight({100.3, 80.1}, {100.3, 170.1})};
  bar.target = {grid::straight({108.3, 80.1}, {108.3, 170.1})};
  problem.curves = {bar};
  return problem;
}

multigrid::Solution solve(double kappa, bool mu_cells, bool kappa_cells,
                          kernels::Model model = kernels::Model::crpm, double tolerance_px = 0.0) {
  multigrid::Solution solution = multigrid::solve(
      problem_of(kappa, mu_cells, kappa_cells, model),
      {.curve_method = multigrid::CurveMethod::averaged, .tolerance_px = tolerance_px});
  EXPECT_EQ(solution.report.status, multigrid::Status::converged);
  return solution;
}

/// Work units of a Newton step on the finest lattice: of all but the last of a run to 1e-3 cells.
double work_of_step(double kappa, bool mu_cells, bool kappa_cells,
                    kernels::Model model = kernels::Model::crpm) {
  double first = 0.0, last = 0.0;
  int steps = 0;
  const multigrid::Solution solution =
      multigrid::solve(problem_of(kappa, mu_cells, kappa_cells, model),
                       {.curve_method = multigrid::CurveMethod::averaged,
                        .tolerance_px = 1e-3,
                        .threads = 1,
                        .progress = [&](const multigrid::Progress& progress) {
                          if (progress.nx != kCells) return true;
                          last = processor_seconds();
                          if (steps++ == 0) first = last;
                          return true;
                        }});
  EXPECT_EQ(solution.report.status, multigrid::Status::converged);
  EXPECT_GE(steps, 2);
  return (last - first) / (steps - 1) / solution.report.work_unit_seconds;
}

double bytes_per_node(const multigrid::Solution& solution) {
  return double(solution.report.solver_bytes) / double(solution.lattice.nodes());
}

void expect_floats(double bytes, double floats, double besides = 0.0) {
  EXPECT_GE(bytes, 0.99 * kLevels * 4.0 * floats);
  EXPECT_LE(bytes, kPadding * kLevels * 4.0 * floats + besides);
}

TEST(Memory, EachMaterialStoresItsOwnFieldsOnly) {
  const multigrid::Solution harmonic = solve(0.0, false, false), crpm = solve(1.0, false, false),
                            mu = solve(1.0, true, false), kappa = solve(1.0, false, true),
                            both = solve(1.0, true, true);
  std::printf(
      "bytes per node: harmonic %.1f, crpm %.1f, mu mask %.1f, kappa mask %.1f, both %.1f\n",
      bytes_per_node(harmonic), bytes_per_node(crpm), bytes_per_node(mu), bytes_per_node(kappa),
      bytes_per_node(both));
  // State, correction and right-hand side of x and y; the same of P; mu and 1/K_ii; 1/kappa.
  expect_floats(bytes_per_node(harmonic), 6, kStart);
  expect_floats(bytes_per_node(crpm), 9, kStart);
  expect_floats(bytes_per_node(mu) - bytes_per_node(crpm), 2);
  expect_floats(bytes_per_node(kappa) - bytes_per_node(crpm) + kTurn, 1, kTurn);
  expect_floats(bytes_per_node(both) - bytes_per_node(crpm) + kTurn, 3, kTurn);
  EXPECT_TRUE(harmonic.pressure.empty());
}

TEST(Memory, OtherMembranesStoreBlocksAndTangentsAndCornersTheirPressures) {
  const multigrid::Solution arap = solve(1.0, false, false, kernels::Model::arap),
                            free = solve(1.0, false, false, kernels::Model::fold_free);
  std::printf("bytes per node: arap %.1f, fold-free %.1f\n", bytes_per_node(arap),
              bytes_per_node(free));
  // State, correction, right-hand side and a product of x and y, blocks of the diagonal; tangents
  // on the coarser lattices; four corner pressures.
  const double tangents = 10.0 * (kLevels - 1.0) / kLevels;
  expect_floats(bytes_per_node(arap), 11 + tangents, kStart);
  expect_floats(bytes_per_node(free), 15 + tangents, kStart);
}

TEST(Memory, ANewtonStepCostsItsCycles) {
  using kernels::Model;
  const double harmonic = work_of_step(0.0, false, false), crpm = work_of_step(1.0, false, false),
               mu = work_of_step(1.0, true, false), kappa = work_of_step(1.0, false, true),
               both = work_of_step(1.0, true, true),
               arap = work_of_step(1.0, false, false, Model::arap),
               free = work_of_step(1.0, false, false, Model::fold_free);
  std::printf(
      "work units of a Newton step: harmonic %.1f, crpm %.1f, mu mask %.1f, kappa mask %.1f, both "
      "%.1f, arap %.1f, fold-free %.1f\n",
      harmonic, crpm, mu, kappa, both, arap, free);
  for (const double work : {harmonic, crpm, mu, kappa, both, arap, free}) {
    EXPECT_GT(work, 1.0);
    EXPECT_LT(work, 100.0);
  }
}

TEST(Memory, AMaskOfOneValueIsTheConstant) {
  const double tolerance_px = 1e-5;
  const multigrid::Solution constant = solve(1.0, false, false, kernels::Model::crpm, tolerance_px),
                            masked = solve(1.0, true, true, kernels::Model::crpm, tolerance_px);
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
