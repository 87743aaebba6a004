// SPDX-License-Identifier: MIT
// What a solve keeps for the next one (KeptLevels) never changes a solution, to the last bit, and
// where only targets have moved nothing is built anew.
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <tuple>
#include <vector>

#include <drumhead/kernels/threads.h>
#include <drumhead/multigrid/warp.h>
#include <gtest/gtest.h>

#include "scene_levels.h"

namespace drumhead::multigrid {
namespace {

using grid::Point;

constexpr double kSide = 1000.0;
constexpr int kCells = 48;

/// A circle of four Béziers.
std::vector<grid::CubicBezier> circle(Point centre, double radius, double turn = 0.0) {
  constexpr double kQuarter = 1.57079632679489662;
  const double reach = 4.0 / 3.0 * std::tan(kQuarter / 4.0);
  std::vector<grid::CubicBezier> chain;
  for (int n = 0; n < 4; ++n) {
    const double a = turn + n * kQuarter, b = a + kQuarter;
    const Point from{std::cos(a), std::sin(a)}, to{std::cos(b), std::sin(b)};
    chain.push_back(
        {{centre + radius * from, centre + radius * (from + reach * Point{-from.y, from.x}),
          centre + radius * (to - reach * Point{-to.y, to.x}), centre + radius * to}});
  }
  return chain;
}

/// A ring with a line through it, both held, and two discs that move.
WarpProblem scene(double weight) {
  WarpProblem problem;
  problem.lattice = {kCells, kCells, kSide / kCells, {0.0, 0.0}, kSide};
  problem.material.kappa = 10.0;
  const auto ring = circle({503.0, 498.0}, 401.0);
  const std::vector<grid::CubicBezier> line{grid::straight({31.0, 703.0}, {953.0, 757.0})};
  problem.curves = {{"ring", ring, ring},
                    {"line", line, line},
                    {"left", circle({351.0, 402.0}, 90.0), circle({371.0, 392.0}, 90.0, 0.3)},
                    {"right", circle({652.0, 399.0}, 83.0), circle({652.0, 429.0}, 83.0)}};
  for (grid::CurvePair& curve : problem.curves) curve.weight = weight;
  return problem;
}

void move(grid::CubicBezier& segment, std::size_t control, Point by) {
  segment.control[control] = segment.control[control] + by;
}

/// Bit for bit, but for the time it took.
void expect_same(const Solution& a, const Solution& b) {
  EXPECT_EQ(a.u_px, b.u_px);
  EXPECT_EQ(a.v_px, b.v_px);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.split.pressure, b.split.pressure);
  EXPECT_EQ(a.split.column, b.split.column);
  ASSERT_EQ(a.split.triangle.size(), b.split.triangle.size());
  for (std::size_t t = 0; t < a.split.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const kernels::MapTriangle &p = a.split.triangle[t], &q = b.split.triangle[t];
      EXPECT_EQ(std::tuple(p.rest[k].x, p.rest[k].y, p.displacement[k].x, p.displacement[k].y),
                std::tuple(q.rest[k].x, q.rest[k].y, q.displacement[k].x, q.displacement[k].y));
    }
  ASSERT_EQ(a.forces.size(), b.forces.size());
  for (std::size_t k = 0; k < a.forces.size(); ++k) EXPECT_EQ(a.forces[k].q, b.forces[k].q);
  EXPECT_EQ(a.report.status, b.report.status);
  EXPECT_EQ(a.report.levels.size(), b.report.levels.size());
  EXPECT_EQ(a.report.energy.total, b.report.energy.total);
  EXPECT_EQ(a.report.notes, b.report.notes);
  // But for room for a row or two that an earlier solve needed.
  EXPECT_NEAR(double(a.report.solver_bytes), double(b.report.solver_bytes),
              0.01 * double(a.report.solver_bytes));
}

/// Solves with what is kept and without; returns the solution.
Solution solve_both_ways(const WarpProblem& problem, SolverOptions options, KeptLevels& kept) {
  const Solution anew = solve(problem, options);
  options.kept = &kept;
  Solution again = solve(problem, options);
  expect_same(anew, again);
  return again;
}

struct Edit {
  const char* name;
  std::function<void(WarpProblem&)> make;
};
void PrintTo(const Edit& edit, std::ostream* out) { *out << edit.name; }

std::vector<Edit> edits() {
  return {
      {"nothing", [](WarpProblem&) {}},
      {"a target point",
       [](WarpProblem& p) {
         move(p.curves[2].target[1], 1, {5.0, 3.0});
       }},
      {"the target of a curve that another crosses",
       [](WarpProblem& p) {
         move(p.curves[1].target[0], 2, {0.0, -6.0});
       }},
      {"a source point",
       [](WarpProblem& p) {
         move(p.curves[3].source[0], 2, {-4.0, 2.0});
       }},
      {"a source point of a curve that another crosses",
       [](WarpProblem& p) {
         move(p.curves[1].source[0], 1, {0.0, 15.0});
       }},
      {"a curve more",
       [](WarpProblem& p) {
         const auto pin = circle({502.0, 611.0}, 37.0);
         p.curves.push_back({"pin", pin, pin, p.curves[0].weight});
       }},
      {"a curve less", [](WarpProblem& p) { p.curves.erase(p.curves.begin() + 1); }},
      {"no curves", [](WarpProblem& p) { p.curves.clear(); }},
      {"the order of curves", [](WarpProblem& p) { std::swap(p.curves[1], p.curves[3]); }},
      {"a weight", [](WarpProblem& p) { p.curves[2].weight = 40.0; }},
      {"kappa", [](WarpProblem& p) { p.material.kappa = 3.0; }},
      {"a mask of kappa",
       [](WarpProblem& p) {
         p.material.kappa_cells.assign(p.lattice.cells(), 10.0F);
         p.material.kappa_cells[1000] = 50.0F;
       }},
      {"a mask of mu",
       [](WarpProblem& p) {
         p.material.mu_cells.assign(p.lattice.cells(), 1.0F);
         p.material.mu_cells[1000] = 3.0F;
       }},
  };
}

class Kept : public ::testing::TestWithParam<std::tuple<Edit, CurveMethod, double>> {};

TEST_P(Kept, ChangesNoSolution) {
  const auto& [edit, method, weight] = GetParam();
  const WarpProblem problem = scene(weight);
  WarpProblem edited = problem;
  edit.make(edited);
  KeptLevels kept;
  SolverOptions options{.curve_method = method};
  const Solution first = solve_both_ways(problem, options, kept);
  options.start = &first;
  options.tolerance_px = 0.1;
  const Solution second = solve_both_ways(edited, options, kept);
  options.start = &second;
  (void)solve_both_ways(problem, options, kept);
  options.start = nullptr;
  (void)solve_both_ways(edited, options, kept);
}

INSTANTIATE_TEST_SUITE_P(
    Edits, Kept,
    ::testing::Combine(::testing::ValuesIn(edits()),
                       ::testing::Values(CurveMethod::averaged, CurveMethod::conforming),
                       ::testing::Values(std::numeric_limits<double>::infinity(), 200.0)));

class KeptOf : public ::testing::TestWithParam<kernels::Model> {};

TEST_P(KeptOf, AMembraneChangesNoSolution) {
  WarpProblem problem = scene(std::numeric_limits<double>::infinity());
  problem.material.model = GetParam();
  KeptLevels kept;
  const Solution first = solve_both_ways(problem, {}, kept);
  move(problem.curves[2].target[1], 1, {5.0, 3.0});
  (void)solve_both_ways(problem, {.tolerance_px = 0.1, .start = &first}, kept);
  (void)solve_both_ways(problem, {}, kept);
}

INSTANTIATE_TEST_SUITE_P(Models, KeptOf,
                         ::testing::Values(kernels::Model::harmonic, kernels::Model::arap,
                                           kernels::Model::fold_free, kernels::Model::corotated,
                                           kernels::Model::neohookean));

// The load path gives the levels other targets on its way.
TEST(KeptLevelsTest, ALoadPathLeavesNoTrace) {
  for (const CurveMethod method : {CurveMethod::averaged, CurveMethod::conforming}) {
    WarpProblem problem = scene(std::numeric_limits<double>::infinity());
    problem.curves[2].target = circle({351.0, 402.0}, 90.0, 2.3);
    problem.curves[2].turn_degrees = 2.3 * 180.0 / 3.14159265358979;
    // One segment in two: sources and targets correspond by arc length.
    const grid::CubicBezier whole = problem.curves[2].target[1];
    problem.curves[2].target[1] = whole.piece(0.0, 0.5);
    problem.curves[2].target.insert(problem.curves[2].target.begin() + 2, whole.piece(0.5, 1.0));
    KeptLevels kept;
    const Solution first = solve_both_ways(problem, {.curve_method = method}, kept);
    int steps = 0;
    const Solution cancelled =
        solve(problem, {.curve_method = method, .kept = &kept, .progress = [&](const Progress&) {
                          return ++steps < 5;
                        }});
    EXPECT_EQ(cancelled.report.status, Status::cancelled);
    (void)solve_both_ways(problem, {.curve_method = method, .tolerance_px = 0.1, .start = &first},
                          kept);
  }
}

TEST(KeptLevelsTest, OtherOptionsAndLatticesAreNotMistakenForTheSame) {
  WarpProblem problem = scene(std::numeric_limits<double>::infinity());
  KeptLevels kept;
  for (const CurveMethod method :
       {CurveMethod::averaged, CurveMethod::conforming, CurveMethod::automatic}) {
    (void)solve_both_ways(problem, {.curve_method = method}, kept);
    (void)solve_both_ways(problem, {.curve_method = method, .threads = 2}, kept);
    (void)solve_both_ways(problem, {.curve_method = method, .tolerance_px = 0.01}, kept);
  }
  (void)solve_both_ways(problem, {.exact = true}, kept);
  KeptLevels moved = std::move(kept);
  (void)solve_both_ways(problem, {}, moved);
  problem.lattice.origin_px = {-3.0, 2.0};
  (void)solve_both_ways(problem, {}, moved);
}

TEST(KeptLevelsTest, ARefusedSceneLeavesNoTrace) {
  for (const CurveMethod method : {CurveMethod::averaged, CurveMethod::conforming}) {
    const WarpProblem problem = scene(std::numeric_limits<double>::infinity());
    WarpProblem outside = problem;
    move(outside.curves[3].source[0], 1, {3000.0, 0.0});
    move(outside.curves[1].target[0], 1, {0.0, 4.0});
    KeptLevels kept;
    const Solution first = solve_both_ways(problem, {.curve_method = method}, kept);
    EXPECT_THROW((void)solve(outside, {.curve_method = method, .kept = &kept}),
                 std::invalid_argument);
    (void)solve_both_ways(problem, {.curve_method = method, .tolerance_px = 0.1, .start = &first},
                          kept);
  }
}

TEST(SceneLevelsTest, NothingIsBuiltAnewWhereOnlyTargetsMove) {
  for (const bool conforming : {false, true}) {
    WarpProblem problem = scene(std::numeric_limits<double>::infinity());
    SceneLevels<float> levels({.lattice = problem.lattice,
                               .material = problem.material,
                               .traits = {.stiffness = 10.0, .jump = 0.005},
                               .most_weight = 1e6,
                               .conforming = conforming,
                               .threads = kernels::thread_limit()});
    levels.lay_out_again(problem.curves);
    const Hierarchy<float>* built = &levels.hierarchy();
    const auto* cells = built->conforming() ? (*built)[0].conforming.get() : nullptr;
    const auto wanted = [&] {
      if (!conforming) return levels.cuts().wanted;
      std::vector<Point> out;
      for (const grid::HeldNode& node : levels.hierarchy()[0].conforming->geometry.curve_node)
        out.push_back(node.wanted);
      return out;
    };
    const std::vector<Point> before = wanted();
    move(problem.curves[2].target[1], 1, {5.0, 3.0});
    levels.lay_out_again(problem.curves);
    EXPECT_EQ(&levels.hierarchy(), built);
    EXPECT_EQ(levels.hierarchy()[0].conforming.get(), cells);
    EXPECT_NE(wanted(), before);
  }
}

}  // namespace
}  // namespace drumhead::multigrid
