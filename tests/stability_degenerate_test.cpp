// SPDX-License-Identifier: MIT
// Degenerate scenes: whatever the curves do to the lattice, the solver ends with finite numbers and
// a status that is true.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <drumhead/multigrid/warp.h>

namespace drumhead {
namespace {

using grid::Point;
using multigrid::Status;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

grid::CurvePair line(const char* name, Point a, Point b, Point to_a, Point to_b) {
  grid::CurvePair pair;
  pair.name = name;
  pair.source = {grid::straight(a, b)};
  pair.target = {grid::straight(to_a, to_b)};
  return pair;
}

struct Case {
  const char* name;
  double width, height;
  grid::LatticeOptions lattice;
  double kappa;
  std::vector<grid::CurvePair> curves;
  Status status;
  double most_gap_px;  ///< of any curve
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Degenerate : public testing::TestWithParam<Case> {};

TEST_P(Degenerate, EndsFiniteWithATrueStatus) {
  const Case& c = GetParam();
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(c.width, c.height, c.lattice);
  problem.material.kappa = c.kappa;
  problem.curves = c.curves;
  const multigrid::Solution solution = multigrid::solve(problem);
  EXPECT_EQ(solution.report.status, c.status) << multigrid::name(solution.report.status);
  for (const double u : solution.u_px) ASSERT_TRUE(std::isfinite(u));
  for (const double v : solution.v_px) ASSERT_TRUE(std::isfinite(v));
  for (const double p : solution.pressure) ASSERT_TRUE(std::isfinite(p));
  EXPECT_TRUE(std::isfinite(solution.report.energy.total));
  for (const multigrid::CurveReport& curve : solution.report.curves)
    EXPECT_LE(curve.gap_max_px, c.most_gap_px) << curve.name;
}

const grid::LatticeOptions kTenPixels{.cells = 64, .margin = 0.0};  // on a picture of 640 × 640

INSTANTIATE_TEST_SUITE_P(
    Scenes, Degenerate,
    testing::Values(Case{"NoCurves", 1000, 1000, {.cells = 64}, 1, {}, Status::converged, 0},
                    Case{"OnePixel", 1, 1, {.cells = 64}, 1, {}, Status::converged, 0},
                    Case{"OneCell",
                         1000,
                         1000,
                         {.cells = 1, .margin = 0},
                         1,
                         {line("a", {100, 100}, {900, 900}, {100, 200}, {900, 900})},
                         Status::converged,
                         110},
                    Case{"ThreeCellsIncompressible",
                         1000,
                         1000,
                         {.cells = 3, .margin = 0},
                         kInfinity,
                         {line("a", {100, 100}, {900, 900}, {100, 200}, {900, 900})},
                         Status::converged,
                         110},
                    Case{"ThreeRows",
                         1000,
                         30,
                         {.cells = 100, .margin = 0},
                         1,
                         {line("a", {100, 10}, {900, 20}, {150, 10}, {900, 20})},
                         Status::converged,
                         10},
                    Case{"OnAGridLine",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {100, 320}, {540, 320}, {100, 360}, {540, 360})},
                         Status::converged,
                         5},
                    Case{"Duplicates",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {100, 320}, {540, 320}, {100, 360}, {540, 360}),
                          line("b", {100, 320}, {540, 320}, {100, 360}, {540, 360})},
                         Status::converged,
                         5},
                    Case{"ConflictingDuplicatesMeetInTheMiddle",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {100, 325}, {540, 325}, {100, 360}, {540, 360}),
                          line("b", {100, 325}, {540, 325}, {100, 290}, {540, 290})},
                         Status::converged,
                         35.1},
                    Case{"ShorterThanACell",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {322, 322}, {325, 325}, {352, 322}, {355, 325})},
                         Status::converged,
                         1},
                    Case{"TooShortToCount",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {322, 322}, {322.001, 322}, {352, 322}, {352.001, 322})},
                         Status::converged,
                         31},
                    Case{"IntoTheBoundary",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {320, 320}, {640, 320}, {320, 360}, {640, 330})},
                         Status::converged,
                         12},
                    Case{"AlongTheBoundary",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {100, 0}, {540, 0}, {100, 30}, {540, 30})},
                         Status::converged,
                         31},
                    Case{"InAdjacentColumns",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {325, 100}, {325, 540}, {305, 100}, {305, 540}),
                          line("b", {335, 100}, {335, 540}, {355, 100}, {355, 540})},
                         Status::converged,
                         20},
                    Case{"ToACornerOfACell",
                         640,
                         640,
                         kTenPixels,
                         10,
                         {line("a", {200, 200}, {320, 320}, {210, 200}, {330, 310})},
                         Status::converged,
                         5},
                    Case{"TargetNearlyAPoint",
                         640,
                         640,
                         {.cells = 64},
                         10,
                         {line("a", {100, 320}, {540, 320}, {300, 320}, {300.1, 320})},
                         Status::converged,
                         20},
                    Case{"OddCounts",
                         990,
                         770,
                         {.cells = 99, .margin = 0},
                         10,
                         {line("a", {300, 300}, {700, 400}, {320, 330}, {700, 440})},
                         Status::converged,
                         5}),
    [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.name); });

// A membrane whose curves want more than it has stays honest, whatever that takes.
TEST(Degenerate, CurvesFarOutsideAreNotCalledConverged) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(640, 640, {.cells = 64});
  problem.material.kappa = 10.0;
  problem.curves = {line("a", {100, 320}, {540, 320}, {100, 3600}, {540, 3600})};
  const multigrid::Solution solution = multigrid::solve(problem);
  for (const double v : solution.v_px) ASSERT_TRUE(std::isfinite(v));
  if (solution.report.curves[0].gap_max_px > 100.0) {
    EXPECT_FALSE(solution.report.notes.empty());
  }
}

TEST(Degenerate, MoreExactRowsThanNodesAreInfeasible) {
  for (const int cells : {2, 3, 4}) {
    multigrid::WarpProblem problem;
    problem.lattice = grid::make_lattice(640, 640, {.cells = cells, .margin = 0.0});
    problem.curves = {line("a", {50, 100}, {600, 120}, {50, 60}, {600, 180}),
                      line("b", {50, 230}, {600, 250}, {50, 270}, {600, 190}),
                      line("c", {50, 360}, {600, 380}, {50, 320}, {600, 440}),
                      line("d", {50, 490}, {600, 510}, {50, 590}, {600, 450})};
    const multigrid::Solution solution = multigrid::solve(problem, {.exact = true});
    EXPECT_EQ(solution.report.status, Status::infeasible) << cells;
  }
}

TEST(Degenerate, ACurveOutsideTheLatticeIsNamed) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(640, 640, kTenPixels);
  problem.curves = {line("rim", {100, 320}, {700, 320}, {100, 360}, {540, 360})};
  try {
    (void)multigrid::solve(problem);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'rim'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("640"), std::string::npos);
  }
}

}  // namespace
}  // namespace drumhead
