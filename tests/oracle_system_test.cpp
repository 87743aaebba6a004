// SPDX-License-Identifier: MIT
// The oracle against finite differences of its own Lagrangian. Along one coordinate L is at most
// quadratic, and so is its gradient, so that central differences of any width are exact: rounding
// is all that is left.
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/oracle_newton.h"
#include "support/oracle_relax.h"

namespace drumhead::oracle {
namespace {

using Eigen::VectorXd;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A scene with everything in it: soft rows with jump, uneven mu, kappa of 0 and infinity among the
// rest.
OracleScene mixed_scene(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> factor(0.5, 2.0);
  OracleScene scene = make_scene(scenes::shift(scenes::kStudyOffset), n, 1.0, {800.0, 0.05});
  for (double& mu : scene.mu) mu = factor(random);
  scenes::Scene masked = scenes::shift(scenes::kStudyOffset);
  masked.kappa_mask = [](double x, double y) {
    return x < 0.3 ? 0.0 : y > 0.7 ? kInfinity : 1.0 + 20.0 * x;
  };
  OracleScene result = make_scene(masked, n, 1.0, {800.0, 0.05});
  result.mu = scene.mu;
  result.jump_mu = 1.3;
  return result;
}

State random_state(const OracleScene& scene, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> amount(-0.4, 0.4);
  VectorXd step(scene.unknowns());
  for (double& value : step) value = amount(random);
  return moved(scene, rest(scene), step, 1.0);
}

VectorXd unit(const OracleScene& scene, int u) { return VectorXd::Unit(scene.unknowns(), u); }

TEST(OracleSystem, GradientIsTheDerivativeOfTheLagrangian) {
  const OracleScene scene = mixed_scene(8);
  const State state = random_state(scene, 1);
  const VectorXd exact = gradient(scene, state);
  for (int u = 0; u < scene.unknowns(); ++u) {
    const double difference = lagrangian(scene, moved(scene, state, unit(scene, u), 0.5)) -
                              lagrangian(scene, moved(scene, state, unit(scene, u), -0.5));
    ASSERT_NEAR(exact[u], difference, 1e-11) << u;
  }
}

TEST(OracleSystem, MatrixIsTheDerivativeOfTheGradient) {
  const OracleScene scene = mixed_scene(8);
  const State state = random_state(scene, 2);
  const OracleSystem system = assemble(scene, state, state.P);
  for (int u = 0; u < scene.unknowns(); ++u) {
    const VectorXd difference = gradient(scene, moved(scene, state, unit(scene, u), 0.5)) -
                                gradient(scene, moved(scene, state, unit(scene, u), -0.5));
    ASSERT_LT((VectorXd(system.matrix.col(u)) - difference).lpNorm<Eigen::Infinity>(), 1e-11) << u;
  }
}

TEST(OracleSystem, MatrixIsSymmetric) {
  const OracleScene scene = mixed_scene(8);
  const State state = random_state(scene, 3);
  const OracleSystem system = assemble(scene, state, state.P);
  const Eigen::SparseMatrix<double> transposed = system.matrix.transpose();
  EXPECT_LT((system.matrix - transposed).norm(), 1e-14);
}

TEST(OracleSystem, ConstantPressureIsANullLagrangian) {
  const OracleScene scene = mixed_scene(8);
  const State state = random_state(scene, 4);
  const VectorXd constant = VectorXd::Constant(state.P.size(), 3.0);
  const OracleSystem shifted = assemble(scene, state, state.P + constant);
  EXPECT_LT((shifted.matrix - assemble(scene, state, state.P).matrix).norm(), 1e-12);
}

TEST(OracleSystem, RestHasElasticEnergyOneAndNoOther) {
  const OracleScene scene = make_scene(scenes::sponge(), 16, 5.0);
  const Energies energy = energies(scene, rest(scene));
  EXPECT_NEAR(energy.elastic, 1.0, 1e-14);
  EXPECT_NEAR(energy.volume, 0.0, 1e-14);
  EXPECT_EQ(energy.constraint, 0.0);
}

TEST(OracleSystem, DiagonalOfKIsFourMu) {
  const OracleScene scene = make_scene(scenes::shift(), 8, 1.0);
  const State state = random_state(scene, 5);
  const OracleSystem system = assemble(scene, state, state.P);
  for (int u = 0; u < 2 * scene.free_nodes; ++u) {
    EXPECT_NEAR(system.matrix.coeff(u, u), 4.0, 1e-14);
  }
}

TEST(OracleSolve, RefinesAwayTheShiftOfConsistentlySingularRows) {
  const OracleScene scene = make_scene(scenes::sponge(scenes::kStudyOffset), 16, kInfinity);
  const State state = harmonic(scene);
  const OracleSystem system = assemble(scene, state, VectorXd::Zero(state.P.size()));
  VectorXd step;
  EXPECT_LT(solve(system.matrix, -system.gradient, 2 * scene.free_nodes, step), 1e-7);
}

TEST(OracleRelaxation, EachStepSatisfiesItsOwnRow) {
  const OracleScene scene = mixed_scene(8);
  const State state = random_state(scene, 6);
  const OracleSystem system = assemble(scene, state, VectorXd::Zero(state.P.size()));
  const int first_multiplier = 2 * scene.free_nodes;
  VectorXd z = VectorXd::Zero(scene.unknowns());
  for (const int u : {0, 17, scene.free_nodes + 3}) {
    gauss_seidel(system.matrix, -system.gradient, {u}, z);
    EXPECT_NEAR((system.gradient + system.matrix * z)[u], 0.0, 1e-13) << u;
  }
  for (const int l : {first_multiplier + 1, scene.q_unknown(0, 0), scene.q_unknown(2, 1)}) {
    weighted_kaczmarz(system.matrix, -system.gradient, first_multiplier, {l}, z);
    EXPECT_NEAR((system.gradient + system.matrix * z)[l], 0.0, 1e-13) << l;
  }
}

TEST(OracleRelaxation, ColoursCoverEveryUnknownOnce) {
  const OracleScene scene = mixed_scene(8);
  std::vector<int> count(std::size_t(scene.unknowns()), 0);
  const auto tally = [&](const std::vector<int>& rows) {
    for (const int u : rows) ++count[std::size_t(u)];
  };
  for (int axis = 0; axis < 2; ++axis) {
    for (int colour = 0; colour < 2; ++colour) tally(node_colour(scene, axis, colour));
  }
  for (int colour = 0; colour < 4; ++colour) {
    tally(cell_colour(scene, colour));
    tally(cut_colour(scene, colour));
  }
  for (const int visits : count) EXPECT_EQ(visits, 1);
}

}  // namespace
}  // namespace drumhead::oracle
