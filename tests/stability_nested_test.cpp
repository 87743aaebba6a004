// SPDX-License-Identifier: MIT
// Nested iteration on lattices that a direct solver would be slow on: it converges, in few Newton
// steps per level, to the error that it reports, and the lattices converge to one another with
// first order.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "support/field_difference.h"
#include "support/reference.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

constexpr int kCells = 256;

std::vector<scenes::ReferenceCase> large_cases() {
  const double offset = scenes::kStudyOffset;
  return {{"S1kappa1", scenes::sponge(offset), 1.0},
          {"S2kappa1", scenes::roundabout(90.0, offset), 1.0},
          {"S2kappa10", scenes::roundabout(90.0, offset), 10.0},
          {"S4kappa1", scenes::shift(offset), 1.0},
          {"S4kappa10", scenes::shift(offset), 10.0}};
}

multigrid::Solution solve_to(const scenes::ReferenceCase& c, int n, double tolerance_cells) {
  multigrid::SolverOptions options;
  options.curve_method = multigrid::CurveMethod::averaged;
  options.tolerance_px = tolerance_cells / n;
  return multigrid::solve(scenes::problem(c.scene, n, c.kappa), options);
}

std::vector<scenes::ReferenceCase> closed_curve_cases() {
  std::vector<scenes::ReferenceCase> cases = large_cases();
  std::erase_if(cases, [](const auto& c) { return c.scene.name == "S1"; });
  return cases;
}

class NestedIteration : public testing::TestWithParam<scenes::ReferenceCase> {};

TEST_P(NestedIteration, ConvergesToTheErrorThatItReports) {
  const scenes::ReferenceCase& c = GetParam();
  const multigrid::Solution usual = solve_to(c, kCells, 0.0);
  const multigrid::SolveReport& report = usual.report;
  EXPECT_EQ(report.status, multigrid::Status::converged) << multigrid::name(report.status);
  ASSERT_GE(report.levels.size(), 2u);
  EXPECT_EQ(report.levels.back().nx, kCells);
  std::printf("%-10s %.0f work units of %.2f ms, discretisation %.2f cells RMS; Newton steps",
              c.name.c_str(), report.work_units, 1e3 * report.work_unit_seconds,
              report.discretisation_rms_px * kCells);
  for (const auto& level : report.levels) std::printf(" %d²: %zu", level.nx, level.newton.size());
  std::printf("\n");
  EXPECT_LE(report.levels.back().newton.size(), 4u);
  EXPECT_GT(report.discretisation_rms_px, 0.0);
  EXPECT_LE(double(report.solver_bytes) / double(usual.lattice.nodes()), 90.0);

  const multigrid::Solution tight = solve_to(c, kCells, 1e-3);
  EXPECT_EQ(tight.report.status, multigrid::Status::converged)
      << multigrid::name(tight.report.status);
  const oracle::FieldDifference left = oracle::difference(usual, tight, 1);
  EXPECT_LT(left.rms, 0.2 * report.discretisation_rms_px * kCells);
}

// Four times as many cells leave a quarter of a first-order error.
TEST_P(NestedIteration, EstimatesItsDiscretisationErrorWithinAFactorOfTwo) {
  const scenes::ReferenceCase& c = GetParam();
  const multigrid::Solution coarse = solve_to(c, kCells / 4, 0.0);
  const multigrid::Solution fine = solve_to(c, kCells, 1e-2);
  const double truth = oracle::difference(coarse, fine, 4).rms / 0.75;  // coarse cells
  const double estimate = coarse.report.discretisation_rms_px * (kCells / 4);
  std::printf("%-10s discretisation error %.3f cells RMS, estimated %.3f\n", c.name.c_str(), truth,
              estimate);
  EXPECT_LT(estimate, 2.0 * truth);
  EXPECT_GT(estimate, 0.5 * truth);
}

class ClosedCurves : public testing::TestWithParam<scenes::ReferenceCase> {};

TEST_P(ClosedCurves, LatticesApproachOneAnotherWithFirstOrder) {
  const scenes::ReferenceCase& c = GetParam();
  const multigrid::Solution coarse = solve_to(c, kCells / 4, 1e-3);
  const multigrid::Solution middle = solve_to(c, kCells / 2, 1e-3);
  const multigrid::Solution fine = solve_to(c, kCells, 1e-3);
  // Both differences in units of the square.
  const double first = oracle::difference(coarse, middle, 2).rms / (kCells / 4);
  const double second = oracle::difference(middle, fine, 2).rms / (kCells / 2);
  const double order = std::log2(first / second);
  std::printf("%-10s observed order %.2f\n", c.name.c_str(), order);
  EXPECT_GT(order, 0.8);  // the oracle, 32², 64², 128²: 0.95 to 1.10
}

// At the tips of open curves a stiff membrane swirls ever finer: neither step counts nor an order
// hold.
TEST(StiffOpenCurves, ConvergeAllTheSame) {
  const multigrid::Solution solution =
      solve_to({"S1kappa10", scenes::sponge(scenes::kStudyOffset), 10.0}, kCells, 0.0);
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
}

const auto case_name = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Scenes, NestedIteration, testing::ValuesIn(large_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, ClosedCurves, testing::ValuesIn(closed_curve_cases()), case_name);

}  // namespace
}  // namespace drumhead
