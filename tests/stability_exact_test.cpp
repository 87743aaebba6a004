// SPDX-License-Identifier: MIT
// The whole solver with exact curve rows: the known energies at 32², and at 64² the same lattice,
// node by node, as Newton's method with a direct factorisation of the assembled matrix.

#include <gtest/gtest.h>

#include "support/field_difference.h"
#include "support/oracle_newton.h"
#include "support/reference.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

multigrid::Solution solve_exactly(const scenes::ReferenceCase& c, int n) {
  multigrid::SolverOptions options;
  options.curve_method = multigrid::CurveMethod::averaged;
  options.exact = true;
  options.tolerance_px = 1e-8 / n;  // 1e-8 of a cell, RMS
  return multigrid::solve(scenes::problem(c.scene, n, c.kappa), options);
}

class ExactRows : public testing::TestWithParam<scenes::ReferenceCase> {};

TEST_P(ExactRows, ReachTheReferenceEnergyToSixDigits) {
  const scenes::ReferenceCase& c = GetParam();
  const multigrid::Solution solution = solve_exactly(c, 32);
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
  EXPECT_TRUE(solution.report.exact);
  const multigrid::EnergyReport& energy = solution.report.energy;
  EXPECT_NEAR(energy.total / c.energy, 1.0, 1e-6);
  EXPECT_EQ(energy.constraint, 0.0);
  EXPECT_NEAR(energy.elastic + energy.volume + energy.constraint, energy.total, 1e-12);
}

const auto case_name = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Scenes, ExactRows, testing::ValuesIn(scenes::reference_cases()),
                         case_name);
INSTANTIATE_TEST_SUITE_P(Further, ExactRows, testing::ValuesIn(scenes::further_reference_cases()),
                         case_name);

class ExactField : public testing::TestWithParam<scenes::ReferenceCase> {};

TEST_P(ExactField, EqualsDirectNewtonInEveryNode) {
  const scenes::ReferenceCase& c = GetParam();
  const int n = 64;
  const multigrid::Solution solution = solve_exactly(c, n);
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
  const oracle::OracleScene scene = oracle::make_scene(c.scene, n, c.kappa);
  const oracle::OracleResult direct = oracle::newton(scene);
  ASSERT_TRUE(direct.converged);
  const oracle::FieldDifference field = oracle::difference(solution, direct.state);
  EXPECT_LT(field.max, 1e-6) << "cells; RMS " << field.rms;
  const oracle::Energies energy = oracle::energies(scene, direct.state);
  EXPECT_NEAR(solution.report.energy.elastic / energy.elastic, 1.0, 1e-7);
  EXPECT_NEAR(solution.report.energy.total / energy.total(), 1.0, 1e-7);
  RecordProperty("field_max_cells", std::to_string(field.max));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactField, testing::ValuesIn(scenes::reference_cases()),
                         case_name);

}  // namespace
}  // namespace drumhead
