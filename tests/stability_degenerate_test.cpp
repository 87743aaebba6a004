// SPDX-License-Identifier: MIT
// Degenerate scenes: whatever the curves do to the lattice, the solver ends with finite numbers and
// a status that is true, with averaged rows and with conforming cells.
#include <cmath>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include <drumhead/kernels/model.h>
#include <drumhead/multigrid/warp.h>

#include "support/hard_cases.h"

namespace drumhead {
namespace {

using grid::Point;
using multigrid::CurveMethod;
using multigrid::Status;
using scenes::HardCase;

grid::CurvePair line(const char* name, Point a, Point b, Point to_a, Point to_b) {
  grid::CurvePair pair;
  pair.name = name;
  pair.source = {grid::straight(a, b)};
  pair.target = {grid::straight(to_a, to_b)};
  return pair;
}

class Degenerate : public testing::TestWithParam<std::tuple<HardCase, CurveMethod>> {};

TEST_P(Degenerate, EndsFiniteWithATrueStatus) {
  const auto& [c, method] = GetParam();
  const multigrid::Solution solution = multigrid::solve(c.problem, {.curve_method = method});
  EXPECT_EQ(solution.report.status, c.status) << multigrid::name(solution.report.status);
  EXPECT_LE(int(solution.report.levels.back().newton.size()), c.most_steps);
  for (const double u : solution.u_px) ASSERT_TRUE(std::isfinite(u));
  for (const double v : solution.v_px) ASSERT_TRUE(std::isfinite(v));
  for (const double p : solution.pressure) ASSERT_TRUE(std::isfinite(p));
  EXPECT_TRUE(std::isfinite(solution.report.energy.total));
  const bool one_node = method == CurveMethod::conforming && c.name == "DiscInsideACell";
  for (const multigrid::CurveReport& curve : solution.report.curves)
    EXPECT_LE(curve.gap_max_px, one_node ? 6.2 : c.most_gap_px) << curve.name;
  // Such a disc hangs on one lattice node; the report says how far it is off.
  EXPECT_TRUE(!one_node || !solution.report.notes.empty());
}

// What can be met, conforming cells meet: all but what lies on the fixed edge or in conflict, and
// the disc of three tenths of a cell, which holds one node.
TEST_P(Degenerate, ConformingCellsMeetWhatCanBeMet) {
  const auto& [c, method] = GetParam();
  if (method == CurveMethod::averaged || c.name == "OneCell" || c.name.ends_with("Boundary") ||
      c.name == "DiscInsideACell" || c.name.find("Conflict") != std::string::npos)
    return;
  const multigrid::Solution solution = multigrid::solve(c.problem, {.curve_method = method});
  for (const multigrid::CurveReport& curve : solution.report.curves)
    EXPECT_LT(curve.gap_max_px, 0.01) << curve.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Degenerate,
                         testing::Combine(testing::ValuesIn(scenes::degenerate_cases()),
                                          testing::Values(CurveMethod::averaged,
                                                          CurveMethod::conforming)),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" +
                                  multigrid::name(std::get<1>(info.param));
                         });

// A membrane whose curves want more than it has stays honest, whatever that takes.
TEST(DegenerateScene, CurvesFarOutsideAreNotCalledConverged) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(640, 640, {.cells = 64});
  problem.material.kappa = 10.0;
  problem.curves = {line("a", {100, 320}, {540, 320}, {100, 3600}, {540, 3600})};
  for (const CurveMethod method : {CurveMethod::averaged, CurveMethod::conforming}) {
    const multigrid::Solution solution = multigrid::solve(problem, {.curve_method = method});
    for (const double v : solution.v_px) ASSERT_TRUE(std::isfinite(v));
    if (solution.report.curves[0].gap_max_px > 100.0) {
      EXPECT_FALSE(solution.report.notes.empty());
    }
  }
}

TEST(DegenerateScene, CurvesThatStayEndConvergedAtRest) {
  using kernels::Model;
  for (const Model model : {Model::crpm, Model::harmonic, Model::arap, Model::fold_free,
                            Model::corotated, Model::linear, Model::neohookean, Model::stvk})
    for (const CurveMethod method : {CurveMethod::averaged, CurveMethod::conforming}) {
      multigrid::WarpProblem problem;
      problem.lattice = grid::make_lattice(128, 96, {.cells = 16});
      problem.material.model = model;
      problem.material.kappa = model == Model::harmonic ? 0.0 : 10.0;
      problem.curves = {line("still", {30, 40}, {90, 60}, {30, 40}, {90, 60})};
      const multigrid::Solution solution = multigrid::solve(problem, {.curve_method = method});
      EXPECT_EQ(solution.report.status, Status::converged)
          << kernels::name(model) << ", " << multigrid::name(method);
      for (const double u : solution.u_px) ASSERT_NEAR(u, 0.0, 1e-6);
      for (const double v : solution.v_px) ASSERT_NEAR(v, 0.0, 1e-6);
    }
}

TEST(DegenerateScene, MoreExactRowsThanNodesAreInfeasible) {
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

TEST(DegenerateScene, ACurveOutsideTheLatticeIsNamed) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(640, 640, {.cells = 64, .margin = 0.0});
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
