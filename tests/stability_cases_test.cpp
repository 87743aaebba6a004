// SPDX-License-Identifier: MIT
// The 31 cases of the study with exact rows at 32²: a table of status, Newton steps, cycles and
// energy, and which of them converge. What does not, and degenerate constraints that do not, say
// what is left.
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "support/hard_cases.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

// Steps of the paths to the first state included.
constexpr int kCells = 32, kMostSteps = 320;

/// Rows met and energy flat, but nodes go on moving by more than 1e-7 cells a step.
constexpr std::string_view kStalls = "S2 180 degrees, kappa infinity";
// Energies are known to eight digits.
constexpr double kRounding = 1e-7;

/// Whether a note says what is left.
bool has_statement(const multigrid::SolveReport& report) {
  return std::ranges::any_of(report.notes, [](const std::string& note) {
    return note.starts_with("exact curve rows") && note.find(" px") != std::string::npos;
  });
}

TEST(ExactCases, AllButOneConverge) {
  std::puts("| case | status | Newton steps | cycles | energy |\n|---|---|---|---|---|");
  for (const scenes::HardCase& c : scenes::study_cases(kCells)) {
    const multigrid::SolveReport report = multigrid::solve(c.problem, {.exact = true}).report;
    const auto& steps = report.levels.back().newton;
    int cycles = 0;
    for (const multigrid::NewtonStep& step : steps) cycles += step.krylov;
    std::printf("| %s | %s | %zu | %d | %.7f |\n", c.name.c_str(), multigrid::name(report.status),
                steps.size(), cycles, report.energy.total);
    const bool converged = report.status == multigrid::Status::converged;
    EXPECT_TRUE(converged || c.name == kStalls) << c.name;
    EXPECT_EQ(converged, !has_statement(report)) << c.name;
    EXPECT_NE(report.status, multigrid::Status::infeasible) << c.name;
    EXPECT_LE(int(steps.size()), kMostSteps) << c.name;
    EXPECT_GT(report.energy.elastic, 1.0) << c.name;
    if (c.unique) {
      EXPECT_LE(report.energy.total, (1.0 + kRounding) * c.energy_at_32) << c.name;
    }
  }
}

TEST(ExactDegenerate, ConstraintsAreMetOrSaidToContradictOneAnother) {
  for (const scenes::HardCase& c : scenes::degenerate_cases()) {
    const multigrid::SolveReport report = multigrid::solve(c.problem, {.exact = true}).report;
    const bool contradictory = c.name == "ThreeCellsIncompressible";
    EXPECT_EQ(report.status,
              contradictory ? multigrid::Status::infeasible : multigrid::Status::converged)
        << c.name;
    EXPECT_EQ(has_statement(report), contradictory) << c.name;
  }
}

// A turn of more than 100 degrees has a load path, a large kappa one in kappa; on the lattice where
// the iteration starts their steps are counted besides its own.
TEST(Report, CountsTheStepsOfPathsToTheFirstState) {
  const auto steps = [](const scenes::Scene& scene, double kappa, bool exact) {
    const multigrid::SolveReport report =
        multigrid::solve(scenes::problem(scene, 64, kappa),
                         {.curve_method = multigrid::CurveMethod::averaged, .exact = exact})
            .report;
    return report.levels.front().newton.size();
  };
  EXPECT_GE(steps(scenes::roundabout(101.0), 1.0, false),
            steps(scenes::roundabout(99.0), 1.0, false) + 11);
  // Two values of kappa on the way, 10 and 100.
  EXPECT_GE(steps(scenes::shift(), 101.0, true), steps(scenes::shift(), 10.0, true) + 2);
}

}  // namespace
}  // namespace drumhead
