// SPDX-License-Identifier: MIT
// Masked scenes: S3 (a disc of kappa 1000 in 0.1, pinched by its rim) on four lattices, kappa masks
// of contrast 1e4, and discs of ten and a hundred times the stiffness, or a hundredth: Newton steps
// and cycles.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/scene_problem.h"

namespace drumhead {
namespace {

struct Masked {
  const char* name;
  scenes::Scene scene;
  int cells;
  float kappa_in, kappa_out, mu_in, mu_out;
  int most_steps, most_cycles;  ///< on the finest lattice; about twice what was found
};
void PrintTo(const Masked& c, std::ostream* out) { *out << c.name; }

multigrid::WarpProblem problem_of(const Masked& c) {
  scenes::Scene scene = c.scene;
  scene.kappa_mask = scenes::pinch(scenes::kStudyOffset).kappa_mask;
  multigrid::WarpProblem problem = scenes::problem(scene, c.cells, 1.0);
  grid::Material& material = problem.material;
  for (float& kappa : material.kappa_cells) {
    const bool inside = kappa > 1.0f;
    kappa = inside ? c.kappa_in : c.kappa_out;
    if (c.mu_in != 1.0f || c.mu_out != 1.0f)
      material.mu_cells.push_back(inside ? c.mu_in : c.mu_out);
  }
  return problem;
}

class Masks : public testing::TestWithParam<Masked> {};

TEST_P(Masks, ConvergeInBoundedSteps) {
  const Masked& c = GetParam();
  const multigrid::Solution solution =
      multigrid::solve(problem_of(c), {.curve_method = multigrid::CurveMethod::averaged});
  const auto& steps = solution.report.levels.back().newton;
  int cycles = 0;
  for (const multigrid::NewtonStep& step : steps) cycles += step.krylov;
  const multigrid::CurveReport& curve = solution.report.curves.front();
  const double gap_cells = curve.gap_rms_px * c.cells;
  std::printf("%s: %zu steps, %d cycles, gap %.3f cells\n", c.name, steps.size(), cycles,
              gap_cells);
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
  EXPECT_LE(int(steps.size()), c.most_steps);
  EXPECT_LE(cycles, c.most_cycles);
  EXPECT_LT(gap_cells, 0.2);
}

// Conforming cells: within a few steps of the averaged rows' bound, the curves met.
TEST_P(Masks, ConvergeWithConformingCells) {
  const Masked& c = GetParam();
  const multigrid::Solution solution =
      multigrid::solve(problem_of(c), {.curve_method = multigrid::CurveMethod::conforming});
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
  EXPECT_LE(int(solution.report.levels.back().newton.size()), c.most_steps + 4);
  EXPECT_LT(solution.report.curves.front().gap_rms_px * c.cells, 0.02);
}

/// Softer in the disc, kappa left as it is there: kappa/mu 1000. The curves' q-jump, which is by
/// the stiffness, opens gaps of a cell.
class SoftIslands : public testing::TestWithParam<Masked> {};

TEST_P(SoftIslands, Converge) {
  const Masked& c = GetParam();
  const multigrid::Solution solution =
      multigrid::solve(problem_of(c), {.curve_method = multigrid::CurveMethod::averaged});
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
  EXPECT_LE(int(solution.report.levels.back().newton.size()), c.most_steps);
  EXPECT_LT(solution.report.curves.front().gap_rms_px * c.cells, 1.5);
}

const scenes::Scene kPinch = scenes::pinch(scenes::kStudyOffset),
                    kTurn = scenes::roundabout(90.0, scenes::kStudyOffset),
                    kShift = scenes::shift(scenes::kStudyOffset);

INSTANTIATE_TEST_SUITE_P(
    Scenes, Masks,
    testing::Values(Masked{"S3At64", kPinch, 64, 1000, 0.1f, 1, 1, 6, 24},
                    Masked{"S3At128", kPinch, 128, 1000, 0.1f, 1, 1, 20, 60},
                    Masked{"S3At256", kPinch, 256, 1000, 0.1f, 1, 1, 20, 190},
                    Masked{"S3At512", kPinch, 512, 1000, 0.1f, 1, 1, 20, 100},
                    Masked{"S2KappaTo1e4", kTurn, 128, 1e4f, 1, 1, 1, 6, 30},
                    Masked{"S4KappaTo1e4", kShift, 128, 1e4f, 1, 1, 1, 6, 30},
                    Masked{"S3KappaTo1e4", kPinch, 64, 1e4f, 1, 1, 1, 20, 160},
                    Masked{"S2KappaFrom1e4th", kTurn, 128, 1, 1e-4f, 1, 1, 6, 24},
                    Masked{"S2StiffIsland", kTurn, 128, 10, 10, 10, 1, 8, 40},
                    Masked{"S4StiffIsland", kShift, 128, 10, 10, 100, 1, 8, 40}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(Scenes, SoftIslands,
                         testing::Values(Masked{"S2At160", kTurn, 160, 10, 10, 0.01f, 1, 30, 0},
                                         Masked{"S2At256", kTurn, 256, 10, 10, 0.01f, 1, 30, 0},
                                         Masked{"S4At256", kShift, 256, 10, 10, 0.01f, 1, 40, 0}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace drumhead
