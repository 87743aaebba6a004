// SPDX-License-Identifier: MIT
// The façade: what solve() refuses, and with which words; how far it says it is, and how it stops.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <drumhead/multigrid/warp.h>
#include <gtest/gtest.h>

#include "support/cut_checks.h"
#include "support/refusal.h"
#include "support/scene_problem.h"

namespace drumhead::multigrid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

WarpProblem shifted_disc(int cells) {
  return scenes::problem(scenes::shift(scenes::kStudyOffset), cells, 1.0);
}

std::string refused(const WarpProblem& problem, const SolverOptions& options = {}) {
  return tests::refusal([&] { (void)solve(problem, options); });
}

TEST(WarpRefusal, NamesTheLatticesValueAndItsBound) {
  WarpProblem problem = shifted_disc(32);
  problem.lattice.cell_px = -2.0;
  EXPECT_EQ(refused(problem), "cell_px of the lattice = -2: must be positive and finite");
  problem = shifted_disc(32);
  problem.lattice.side_px = 0.0;
  EXPECT_EQ(refused(problem), "side_px of the lattice = 0: must be positive and finite");
  problem = shifted_disc(32);
  problem.lattice.origin_px.y = kNan;
  EXPECT_EQ(refused(problem), "origin_px of the lattice = (0.000000, nan): must be finite");
}

class StartRefusal : public testing::TestWithParam<CurveMethod> {};

TEST_P(StartRefusal, NamesWhatIsMissingOrNotFinite) {
  const WarpProblem problem = shifted_disc(32);
  const Solution good = solve(problem, {.curve_method = GetParam()});
  const auto started = [&](auto change) {
    Solution start = good;
    change(start);
    return refused(problem, {.curve_method = GetParam(), .start = &start});
  };
  const std::string begin = "the solution to start from: ";
  EXPECT_EQ(started([](Solution&) {}), "");
  EXPECT_EQ(started([](Solution& s) { s.pressure.clear(); }), "");
  EXPECT_EQ(started([](Solution& s) { s.u_px.pop_back(); }),
            begin + "1088 values of u_px: must be 1089");
  EXPECT_EQ(started([](Solution& s) { s.v_px.clear(); }), begin + "0 values of v_px: must be 1089");
  EXPECT_EQ(started([](Solution& s) { s.v_px[7] = kNan; }),
            begin + "v_px[7] = nan: must be finite");
  EXPECT_EQ(started([](Solution& s) { s.pressure.resize(5); }),
            begin + "5 values of pressure: must be 1024");
  EXPECT_EQ(started([](Solution& s) { s.pressure[3] = 1.0 / 0.0; }),
            begin + "pressure[3] = inf: must be finite");
  if (GetParam() == CurveMethod::averaged) {
    EXPECT_NE(started([](Solution& s) { s.forces[0].q.x = kNan; }).find("(nan, "),
              std::string::npos);
    return;
  }
  EXPECT_NE(started([](Solution& s) {
              s.split.row_begin.pop_back();
            }).find("split.row_begin of 32 indices: must be 33"),
            std::string::npos);
  EXPECT_NE(started([](Solution& s) {
              s.split.triangle_begin[1] = 1 << 20;
            }).find("split.triangle_begin"),
            std::string::npos);
  EXPECT_NE(started([](Solution& s) { s.split.pressure.pop_back(); }).find("split.pressure"),
            std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(Methods, StartRefusal,
                         testing::Values(CurveMethod::averaged, CurveMethod::conforming));

/// Every fraction that a solve tells.
std::vector<double> fractions(const WarpProblem& problem, SolverOptions options, Solution& result) {
  std::vector<double> told;
  options.progress = [&](const Progress& at) {
    told.push_back(at.fraction);
    return true;
  };
  result = solve(problem, options);
  return told;
}

void expect_rising(const std::vector<double>& told) {
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.front(), 0.0);
  for (std::size_t n = 1; n < told.size(); ++n) EXPECT_GE(told[n], told[n - 1]) << n;
  EXPECT_LT(told.back(), 1.0);
}

struct ProgressCase {
  const char* name;
  WarpProblem problem;
  SolverOptions options;
};

WarpProblem turned_ring(double degrees, int cells, double kappa, kernels::Model model) {
  WarpProblem problem =
      scenes::problem(scenes::roundabout(degrees, scenes::kStudyOffset), cells, kappa);
  problem.material.model = model;
  return problem;
}

// Many steps on a level, a load path with exact rows, and the two ways to meet curves.
TEST(Progress, RisesAndStaysBelowOneUntilTheSolveEnds) {
  using kernels::Model;
  const ProgressCase cases[] = {
      {"averaged",
       turned_ring(90.0, 128, 10.0, Model::crpm),
       {.curve_method = CurveMethod::averaged}},
      {"conforming", turned_ring(90.0, 128, 10.0, Model::crpm), {.tolerance_px = 1e-6}},
      {"path", turned_ring(135.0, 64, 1.0, Model::crpm), {.exact = true}},
      {"arap", turned_ring(60.0, 64, 1e3, Model::arap), {}},
  };
  for (const ProgressCase& c : cases) {
    SCOPED_TRACE(c.name);
    Solution solution;
    const std::vector<double> told = fractions(c.problem, c.options, solution);
    expect_rising(told);
    std::size_t steps = 0;
    for (const LevelReport& level : solution.report.levels) steps += level.newton.size();
    EXPECT_GE(told.size(), steps);
    // Where the finest lattice takes several steps, none but the last ones are told as nearly done.
    const std::size_t last = solution.report.levels.back().newton.size();
    if (last >= 4) {
      EXPECT_LT(told[told.size() - last], 0.5);
    }
  }
}

// A start of no use, and then the whole nested iteration.
TEST(Progress, GoesOnWhereASolveBeginsAnew) {
  const WarpProblem problem = shifted_disc(64);
  Solution far = solve(problem), again;
  for (double& u : far.u_px) u *= -1.0;
  far.report.discretisation_rms_px = 1e-9;
  const std::vector<double> told = fractions(problem, {.start = &far}, again);
  EXPECT_GT(again.report.levels.size(), 1u);
  expect_rising(told);
}

class Cancelled : public testing::TestWithParam<CurveMethod> {};

TEST_P(Cancelled, KeepsTheIterateThatItCameTo) {
  const WarpProblem problem = shifted_disc(128);
  for (const int nx : {32, 64, 128}) {
    int calls = 0;
    SolverOptions options{.curve_method = GetParam()};
    options.progress = [&](const Progress& at) {
      ++calls;
      EXPECT_LE(at.nx, nx);
      return at.nx < nx;
    };
    const Solution solution = solve(problem, options);
    EXPECT_EQ(solution.report.status, Status::cancelled) << nx;
    EXPECT_GT(calls, 0);
    ASSERT_EQ(solution.u_px.size(), problem.lattice.nodes());
    // What came from the coarser lattice carries the curve already, to a cell or two of that.
    ASSERT_EQ(solution.report.curves.size(), 1u);
    EXPECT_LT(solution.report.curves[0].gap_max_px, 2.0 / 32);
    EXPECT_TRUE(std::isnan(solution.report.algebraic_rms_px));
    EXPECT_TRUE(std::isnan(solution.report.discretisation_rms_px));
    EXPECT_STREQ(name(solution.report.status), "cancelled");
  }
}

TEST_P(Cancelled, IsNotAskedAgainAndDoesNotBeginAnew) {
  const WarpProblem problem = shifted_disc(64);
  const Solution start = solve(problem, {.curve_method = GetParam()});
  for (const Solution* from : {static_cast<const Solution*>(nullptr), &start}) {
    int calls = 0;
    SolverOptions options{.curve_method = GetParam(), .start = from};
    options.progress = [&](const Progress&) { return ++calls < 1; };
    EXPECT_EQ(solve(problem, options).report.status, Status::cancelled);
    EXPECT_EQ(calls, 1);
  }
}
INSTANTIATE_TEST_SUITE_P(Methods, Cancelled,
                         testing::Values(CurveMethod::averaged, CurveMethod::conforming,
                                         CurveMethod::automatic));

TEST(CancelledPath, EndsAtOnceWithExactRows) {
  WarpProblem problem = turned_ring(135.0, 64, 1.0, kernels::Model::crpm);
  int calls = 0;
  SolverOptions options{.exact = true};
  options.progress = [&](const Progress&) { return ++calls < 3; };
  EXPECT_EQ(solve(problem, options).report.status, Status::cancelled);
  EXPECT_EQ(calls, 3);
}

/// A disc that grows by a fifth, 44 % of its area: kappa 1e4 has something to say, 1 has not, nor
/// if the curve is soft.
TEST(WarpNotes, NameTheClosedCurveWhoseAreaKappaResists) {
  WarpProblem problem{.lattice = grid::unit_lattice(48, 48), .material = {}, .curves = {}};
  problem.curves = {
      {.name = "still", .source = grid::round({10, 10}, 4.0), .target = grid::round({10, 10}, 4.0)},
      {.name = "disc",
       .source = grid::round({28, 28}, 10.0),
       .target = grid::round({28, 28}, 12.0)}};
  auto notes = [&](double kappa) {
    problem.material.kappa = kappa;
    return solve(problem).report.notes;
  };
  const std::string wanted = "curve 'disc' encloses 44 % more area at its target, which kappa ";
  const auto about_areas = [&](const std::string& note) { return note.starts_with(wanted); };
  EXPECT_TRUE(std::ranges::none_of(notes(1.0), about_areas));
  EXPECT_TRUE(std::ranges::any_of(notes(1e4), about_areas));
  problem.curves[1].weight = 1e3;
  EXPECT_TRUE(std::ranges::none_of(notes(1e4), about_areas));
}

/// Two squares that touch, one walked round against the other: their areas cancel.
TEST(WarpNotes, DoNotCompareAreasThatCancel) {
  const auto squares = [](double side) {
    const grid::Point middle{24.3, 24.3};
    const std::array<grid::Point, 8> way{
        {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {0, -side}, {-side, -side}, {-side, 0}}};
    std::vector<grid::CubicBezier> chain;
    for (std::size_t n = 0; n < way.size(); ++n)
      chain.push_back(grid::straight(middle + way[n], middle + way[(n + 1) % way.size()]));
    return chain;
  };
  WarpProblem problem{.lattice = grid::unit_lattice(48, 48), .material = {}, .curves = {}};
  problem.curves = {{.name = "eight", .source = squares(10.0), .target = squares(12.0)}};
  problem.material.kappa = 1e4;
  const Solution solution = solve(problem);
  EXPECT_GT(solution.report.energy.volume, solution.report.energy.elastic);
  EXPECT_TRUE(std::ranges::none_of(solution.report.notes, [](const std::string& note) {
    return note.find(" encloses ") != std::string::npos;
  }));
}

}  // namespace
}  // namespace drumhead::multigrid
