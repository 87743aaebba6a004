// SPDX-License-Identifier: MIT
// Going on from an earlier solution: a dragged curve, released curves, a start that is of no use.
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <drumhead/multigrid/warp.h>
#include <gtest/gtest.h>

#include "support/scene_problem.h"

namespace drumhead::multigrid {
namespace {

constexpr double kPicture = 1000.0;  // px of the unit square

double rms_difference_px(const Solution& a, const Solution& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.u_px.size(); ++k)
    sum += std::pow(a.u_px[k] - b.u_px[k], 2) + std::pow(a.v_px[k] - b.v_px[k], 2);
  return kPicture * std::sqrt(sum / double(a.u_px.size()));
}

/// Moves the points of a target near one of its points by up to `px`, as a dragged control point
/// does.
void drag(grid::CurvePair& curve, double px) {
  const double length = px / kPicture;
  const std::size_t count = curve.target.size(), reach = count / 8;
  for (std::size_t n = 0; n < 2 * reach; ++n) {
    auto moved = [&](double t) {
      const double s = (double(n) + t) / double(2 * reach);
      return grid::Point{length * std::pow(std::sin(3.14159265358979 * s), 2), 0.0};
    };
    for (std::size_t c = 0; c < 4; ++c) {
      grid::Point& p = curve.target[n].control[c];
      p = p + moved(double(c) / 3.0);
    }
  }
}

int cycles(const Solution& s) {
  int sum = 0;
  for (const NewtonStep& step : s.report.levels.back().newton) sum += step.krylov;
  return sum;
}

class Restart : public ::testing::TestWithParam<std::tuple<double, CurveMethod>> {};

TEST_P(Restart, FollowsADraggedCurveToTheToleranceOnTheFinestLatticeAlone) {
  const auto [kappa, method] = GetParam();
  WarpProblem problem = scenes::problem(scenes::roundabout(45.0, scenes::kStudyOffset), 256, kappa);
  const Solution first = solve(problem, {.curve_method = method});
  ASSERT_EQ(first.report.status, Status::converged);
  drag(problem.curves[0], 5.0);
  const Solution truth = solve(problem, {.curve_method = method, .tolerance_px = 1e-3 / kPicture});
  const Solution moved =
      solve(problem, {.curve_method = method, .tolerance_px = 0.5 / kPicture, .start = &first});
  EXPECT_EQ(moved.report.status, Status::converged);
  EXPECT_EQ(moved.report.levels.size(), 1u);
  EXPECT_GT(rms_difference_px(truth, first), 0.3);  // the drag is seen at all
  EXPECT_LT(rms_difference_px(truth, moved), 0.5);
  EXPECT_LE(moved.report.levels.back().newton.size(), 2u);
  EXPECT_LE(cycles(moved), 6);
}
INSTANTIATE_TEST_SUITE_P(Kappa, Restart,
                         ::testing::Combine(::testing::Values(0.0, 1.0, 10.0),
                                            ::testing::Values(CurveMethod::averaged,
                                                              CurveMethod::conforming)));

// Nothing has changed: the pressures of divided cells come back, too, and one step sees it.
TEST(RestartConforming, FromItsOwnSolutionTakesOneStep) {
  const WarpProblem problem =
      scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), 64, 10.0);
  const Solution first =
      solve(problem, {.curve_method = CurveMethod::conforming, .tolerance_px = 1e-3 / kPicture});
  const Solution again = solve(
      problem,
      {.curve_method = CurveMethod::conforming, .tolerance_px = 0.01 / kPicture, .start = &first});
  EXPECT_EQ(again.report.status, Status::converged);
  ASSERT_EQ(again.report.levels.size(), 1u);
  EXPECT_EQ(again.report.levels[0].newton.size(), 1u);
  EXPECT_LT(rms_difference_px(first, again), 0.01);
}

TEST(RestartConforming, GoesOnAsTheStartDidUnlessToldOtherwise) {
  const WarpProblem problem = scenes::problem(scenes::shift(scenes::kStudyOffset), 64, 1.0);
  for (const CurveMethod method : {CurveMethod::averaged, CurveMethod::conforming}) {
    const Solution first = solve(problem, {.curve_method = method});
    const Solution again =
        solve(problem, {.curve_method = CurveMethod::automatic, .start = &first});
    EXPECT_EQ(again.report.curve_method, method);
    EXPECT_EQ(again.report.levels.size(), 1u);
    const CurveMethod other =
        method == CurveMethod::averaged ? CurveMethod::conforming : CurveMethod::averaged;
    const Solution changed = solve(problem, {.curve_method = other, .start = &first});
    EXPECT_EQ(changed.report.curve_method, other);
    EXPECT_GT(changed.report.levels.size(), 1u);
  }
}

class RestartRelease : public ::testing::TestWithParam<CurveMethod> {};

TEST_P(RestartRelease, AFoldedSceneReturnsToRest) {
  WarpProblem problem = scenes::problem(scenes::fold(scenes::kStudyOffset), 64, 1.0);
  const Solution folded = solve(problem, {.curve_method = GetParam()});
  ASSERT_GT(folded.report.folds.folded_cells, 0);
  problem.curves.clear();
  const Solution released = solve(
      problem, {.curve_method = GetParam(), .tolerance_px = 0.01 / kPicture, .start = &folded});
  EXPECT_EQ(released.report.status, Status::converged);
  EXPECT_EQ(released.report.folds.folded_cells, 0);
  const Solution rest = solve(problem);
  EXPECT_LT(rms_difference_px(released, rest), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Methods, RestartRelease,
                         ::testing::Values(CurveMethod::averaged, CurveMethod::conforming));

/// What the attempt left on coarser levels changed the solution, and crashed isotropic membranes.
class RestartInVain : public ::testing::TestWithParam<std::tuple<kernels::Model, CurveMethod>> {};

TEST_P(RestartInVain, IsSolvedFromTheBeginningAsWithoutAStart) {
  const auto [model, method] = GetParam();
  WarpProblem problem = scenes::problem(scenes::roundabout(45.0, scenes::kStudyOffset), 128, 10.0);
  problem.material.model = model;
  const Solution fresh = solve(problem, {.curve_method = method});
  Solution far = fresh;
  for (double& u : far.u_px) u *= -1.0;
  far.report.discretisation_rms_px = 1e-9;
  const Solution again = solve(problem, {.curve_method = method, .start = &far});
  EXPECT_GT(again.report.levels.size(), 1u);
  EXPECT_EQ(again.u_px, fresh.u_px);
  EXPECT_EQ(again.v_px, fresh.v_px);
}

INSTANTIATE_TEST_SUITE_P(
    Membranes, RestartInVain,
    ::testing::Combine(::testing::Values(kernels::Model::crpm, kernels::Model::arap,
                                         kernels::Model::neohookean, kernels::Model::stvk),
                       ::testing::Values(CurveMethod::averaged, CurveMethod::conforming)));

TEST(RestartRefusal, AStartOnAnotherLatticeIsNamed) {
  const scenes::Scene scene = scenes::shift(scenes::kStudyOffset);
  const Solution other = solve(scenes::problem(scene, 32, 1.0));
  const WarpProblem problem = scenes::problem(scene, 64, 1.0);
  try {
    (void)solve(problem, {.start = &other});
    FAIL() << "a start on 32 × 32 cells was taken for 64 × 64";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("32 × 32"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace drumhead::multigrid
