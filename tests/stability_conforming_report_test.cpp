// SPDX-License-Identifier: MIT
// What the report says of conforming cells: the discretisation error, and in words what curves and
// lattice could not agree on.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "support/scene_problem.h"

namespace drumhead {
namespace {

using grid::Point;
using multigrid::CurveMethod;
using multigrid::Solution;

const multigrid::SolverOptions kConforming{.curve_method = CurveMethod::conforming};

double rms_difference(const Solution& coarse, const Solution& fine) {
  const int n = coarse.lattice.nx, m = fine.lattice.nx, step = m / n;
  double sum = 0.0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::size_t a = std::size_t(j * (n + 1) + i), b = std::size_t(step * (j * (m + 1) + i));
      sum +=
          std::pow(coarse.u_px[a] - fine.u_px[b], 2) + std::pow(coarse.v_px[a] - fine.v_px[b], 2);
    }
  return std::sqrt(sum) / (n + 1);
}

struct Estimated {
  const char* name;
  scenes::Scene scene;
  double kappa;
};
void PrintTo(const Estimated& c, std::ostream* out) { *out << c.name; }

class ConformingEstimate : public testing::TestWithParam<Estimated> {};

TEST_P(ConformingEstimate, IsWithinTwiceTheTruth) {
  const Estimated& c = GetParam();
  multigrid::SolverOptions accurate = kConforming;
  accurate.tolerance_px = 2e-6;
  const Solution truth = multigrid::solve(scenes::problem(c.scene, 512, c.kappa), accurate);
  ASSERT_EQ(truth.report.status, multigrid::Status::converged);
  for (const int n : {64, 128}) {
    const Solution solution = multigrid::solve(scenes::problem(c.scene, n, c.kappa), kConforming);
    const double error = rms_difference(solution, truth),
                 estimate = solution.report.discretisation_rms_px;
    std::printf("%s, %d²: estimated %.2e, true %.2e, ratio %.2f\n", c.name, n, estimate, error,
                estimate / error);
    EXPECT_LT(estimate, 2.0 * error);
    EXPECT_GT(estimate, 0.5 * error);
    EXPECT_LT(solution.report.algebraic_rms_px, 0.25 * estimate);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, ConformingEstimate,
    testing::Values(Estimated{"S1Kappa1", scenes::sponge(scenes::kStudyOffset), 1.0},
                    Estimated{"S2Kappa1", scenes::roundabout(90.0, scenes::kStudyOffset), 1.0},
                    Estimated{"S2Kappa10", scenes::roundabout(90.0, scenes::kStudyOffset), 10.0},
                    Estimated{"S4Kappa1", scenes::shift(scenes::kStudyOffset), 1.0},
                    Estimated{"S4Kappa10", scenes::shift(scenes::kStudyOffset), 10.0}),
    [](const auto& info) { return info.param.name; });

grid::CurvePair line(const std::string& name, Point a, Point b, Point by) {
  return {
      .name = name, .source = {grid::straight(a, b)}, .target = {grid::straight(a + by, b + by)}};
}

/// On a picture of 640 × 640 px, cells of 10 px, the edge fixed.
Solution solve_lines(const std::vector<grid::CurvePair>& curves) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(640, 640, {.cells = 64, .margin = 0.0});
  problem.material.kappa = 1.0;
  problem.curves = curves;
  return multigrid::solve(problem, kConforming);
}

std::size_t notes_with(const Solution& s, const std::vector<std::string>& words) {
  return std::size_t(std::ranges::count_if(s.report.notes, [&](const std::string& note) {
    return std::ranges::all_of(
        words, [&](const std::string& word) { return note.find(word) != std::string::npos; });
  }));
}

TEST(ConformingNotes, AQuietSceneHasNone) {
  EXPECT_TRUE(solve_lines({line("a", {203, 203}, {403, 403}, {20, 0})}).report.notes.empty());
}

TEST(ConformingNotes, CurvesThatCrossWithDifferentTargetsAreNamedOnceWithTheirPlace) {
  const Solution s = solve_lines({line("up", {203, 303}, {403, 303}, {0, -15}),
                                  line("down", {303, 203}, {303, 403}, {0, 15})});
  EXPECT_EQ(notes_with(s, {"'up'", "'down'", "30.00 px apart", "(303.00, 303.00) px", "1 node,"}),
            1u);
  EXPECT_EQ(notes_with(s, {"meet but"}), 1u);
  // They meet in the middle there: each misses its target by half of that, less beside it.
  for (const multigrid::CurveReport& curve : s.report.curves) {
    EXPECT_GT(curve.gap_max_px, 11.0);
    EXPECT_LE(curve.gap_max_px, 15.0 + 1e-3);
  }
}

TEST(ConformingNotes, CurvesThatCrossAndAgreeAreNotMentioned) {
  const Solution s = solve_lines(
      {line("a", {203, 303}, {403, 303}, {0, 15}), line("b", {303, 203}, {303, 403}, {0, 15})});
  EXPECT_TRUE(s.report.notes.empty());
}

TEST(ConformingNotes, TheFixedEdgeThatCannotFollowIsNamed) {
  const Solution s = solve_lines({line("road", {320, 320}, {640, 320}, {0, 20})});
  EXPECT_EQ(notes_with(s, {"'road'", "fixed edge", "20.00 px", "(640.00, 320.00) px"}), 1u);
}

TEST(ConformingNotes, TipsWithoutANodeAreCounted) {
  std::vector<grid::CurvePair> star;
  for (int k = 0; k < 7; ++k) {
    const double a = 2.0 * 3.14159265358979 * k / 7;
    const Point way{std::cos(a), std::sin(a)}, middle{325, 325};
    star.push_back(
        line("ray " + std::to_string(k), middle + 3.0 * way, middle + 90.0 * way, {5, 0}));
  }
  const Solution s = solve_lines(star);
  EXPECT_EQ(s.report.status, multigrid::Status::converged);
  EXPECT_EQ(notes_with(s, {"tips or corners", "first at (32"}), 1u);
}

}  // namespace
}  // namespace drumhead
