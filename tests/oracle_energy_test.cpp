// SPDX-License-Identifier: MIT
// The oracle reaches the known energies. This calibrates the yardstick itself: cutting, rows, units
// and Newton's schedule, before any kernel is measured with it.
#include <limits>

#include <gtest/gtest.h>

#include "support/oracle_newton.h"
#include "support/reference.h"

namespace drumhead::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ReferenceEnergy : public testing::TestWithParam<scenes::ReferenceCase> {};

TEST_P(ReferenceEnergy, IsReachedToSevenDigits) {
  const scenes::ReferenceCase& c = GetParam();
  const OracleScene scene = make_scene(c.scene, 32, c.kappa);
  const OracleResult result = newton(scene);
  EXPECT_TRUE(result.converged);
  const Energies energy = energies(scene, result.state);
  EXPECT_NEAR(energy.total() / c.energy, 1.0, 1e-7);
  EXPECT_EQ(energy.constraint, 0.0);
  EXPECT_LT(curve_gap(scene, result.state).lpNorm<Eigen::Infinity>(), 1e-9);
  // With hard rows the multipliers' terms vanish at the solution: primal and saddle value agree.
  EXPECT_NEAR(lagrangian(scene, result.state) / (32.0 * 32.0) / energy.total(), 1.0, 1e-9);
  RecordProperty("newton_steps", result.steps);
}

const auto case_name = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Scenes, ReferenceEnergy, testing::ValuesIn(scenes::reference_cases()),
                         case_name);
INSTANTIATE_TEST_SUITE_P(FurtherScenes, ReferenceEnergy,
                         testing::ValuesIn(scenes::further_reference_cases()), case_name);

// 1/kappa = 0: constant pressures and, nearly, checkerboards are null vectors of the matrix.
TEST(IncompressibleMembrane, ReachesTheReferenceEnergy) {
  for (const auto& [scene, energy] :
       {std::pair{scenes::sponge(), 2.8254928}, std::pair{scenes::shift(), 1.9029}}) {
    const OracleScene oracle = make_scene(scene, 32, kInfinity);
    const OracleResult result = newton(oracle);
    EXPECT_TRUE(result.converged) << scene.name;
    EXPECT_NEAR(energies(oracle, result.state).total() / energy, 1.0, 2e-6) << scene.name;
    for (int cell = 0; cell < 32 * 32; ++cell) {
      ASSERT_NEAR(centre_J(oracle, result.state, cell % 32, cell / 32), 1.0, 1e-7) << scene.name;
    }
  }
}

// Half a turn has no preferred side; a load path of ten steps leads to the lowest state known.
TEST(HalfTurn, IsReachedAlongALoadPath) {
  State state;
  OracleScene oracle;
  for (int k = 1; k <= 10; ++k) {
    oracle = make_scene(scenes::roundabout(18.0 * k), 32, 1.0);
    const OracleResult result = k == 1 ? newton(oracle) : newton(oracle, state);
    ASSERT_TRUE(result.converged) << k;
    state = result.state;
  }
  EXPECT_NEAR(energies(oracle, state).total() / 3.5492704, 1.0, 1e-7);
}

// The q-jump opens a small gap, so elastic and volume energy fall below those of the exact rows.
TEST(QJump, LowersTheMembraneEnergyByFewPercent) {
  for (const scenes::ReferenceCase& c : scenes::reference_cases()) {
    const OracleScene scene = make_scene(c.scene, 32, c.kappa, {1e6, 0.005});
    const OracleResult result = newton(scene);
    EXPECT_TRUE(result.converged) << c.name;
    const Energies energy = energies(scene, result.state);
    const double membrane = energy.elastic + energy.volume;
    EXPECT_LT(membrane, c.energy) << c.name;
    EXPECT_GT(membrane, 0.95 * c.energy) << c.name;
    EXPECT_LT(energy.constraint, 1e-3) << c.name;
  }
}

}  // namespace
}  // namespace drumhead::oracle
