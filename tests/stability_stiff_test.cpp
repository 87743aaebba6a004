// SPDX-License-Identifier: MIT
// The 31 cases of the study (six scenes at kappa/mu 1 to infinity, and the masked one) on the
// default path at 128²: all converge. Without the pressure jump of the coarse levels S2 took 38
// cycles on the finest lattice at kappa 100 and stalled at 1e4.
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "support/hard_cases.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

constexpr int kCells = 128;

multigrid::SolveReport solve(const scenes::Scene& scene, double kappa) {
  return multigrid::solve(scenes::problem(scene, kCells, kappa),
                          {.curve_method = multigrid::CurveMethod::averaged})
      .report;
}

void expect_converged(const multigrid::SolveReport& report, const std::string& what) {
  EXPECT_EQ(report.status, multigrid::Status::converged)
      << what << ": " << multigrid::name(report.status);
  std::printf("%s: energy %.4f, %zu Newton steps on the finest lattice\n", what.c_str(),
              report.energy.total, report.levels.back().newton.size());
}

TEST(StiffScenes, AllOfTheStudyConverge) {
  const std::vector<scenes::HardCase> cases = scenes::study_cases(kCells);
  EXPECT_EQ(cases.size(), 31u);
  for (const scenes::HardCase& c : cases) {
    const multigrid::SolveReport report =
        multigrid::solve(c.problem, {.curve_method = multigrid::CurveMethod::averaged}).report;
    expect_converged(report, c.name);
    EXPECT_LE(int(report.levels.back().newton.size()), c.most_steps) << c.name;
  }
}

TEST(StiffScenes, RoundaboutTakesFewCyclesHoweverStiff) {
  for (const double kappa : {10.0, 100.0, 1e4}) {
    const multigrid::SolveReport report =
        solve(scenes::roundabout(90.0, scenes::kStudyOffset), kappa);
    expect_converged(report, "S2");
    int cycles = 0;
    for (const multigrid::NewtonStep& step : report.levels.back().newton) cycles += step.krylov;
    EXPECT_LE(cycles, 14) << "kappa " << kappa;
  }
}

}  // namespace
}  // namespace drumhead
