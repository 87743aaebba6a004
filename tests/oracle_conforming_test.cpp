// SPDX-License-Identifier: MIT
// The conforming cells' assembled oracle: its derivatives, and the order of the method.
#include <cmath>

#include <gtest/gtest.h>

#include "support/oracle_conforming.h"
#include "support/radial_reference.h"
#include "support/scene_problem.h"

namespace drumhead::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ConformingMembrane membrane(const scenes::Scene& scene, int n, double kappa, double weight) {
  multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  for (grid::CurvePair& curve : problem.curves) curve.weight = weight;
  return conforming_membrane(problem.curves, problem.lattice, scenes::kappa_cells(scene, n, kappa));
}

double lagrangian(const ConformingMembrane& m, const ConformingState& state) {
  const ConformingEnergy e = energy(m, state);
  double sum = (e.elastic + e.constraint) * m.cells.nx * m.cells.ny;
  // What the P entries of the gradient say is linear in P but for A P²/(2 kappa).
  const Eigen::VectorXd g = gradient(m, state).tail(state.P.size());
  for (Eigen::Index r = 0; r < state.P.size(); ++r) {
    const ConformingRow& row = m.rows[std::size_t(r)];
    sum += state.P[r] * (g[r] + 0.5 * row.area * state.P[r] / row.kappa);
  }
  return sum;
}

TEST(OracleConforming, TheGradientIsTheSlopeOfTheLagrangian) {
  const ConformingMembrane m = membrane(scenes::roundabout(90.0, .00317), 10, 4.0, 30.0);
  ConformingState state{m.rest, Eigen::VectorXd::LinSpaced(Eigen::Index(m.rows.size()), -1, 2)};
  for (Eigen::Index n = 0; n < state.x.rows(); ++n)
    if (m.unknown[std::size_t(n)] >= 0)
      state.x.row(n) +=
          Eigen::RowVector2d(.2 * std::sin(double(n)), .2 * std::cos(3.0 * double(n)));
  const Eigen::VectorXd g = gradient(m, state);
  for (std::size_t n = 0; n < m.unknown.size(); n += 3) {
    if (m.unknown[n] < 0) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const double step = 1e-5;
      ConformingState up = state, down = state;
      up.x(Eigen::Index(n), axis) += step;
      down.x(Eigen::Index(n), axis) -= step;
      EXPECT_NEAR((lagrangian(m, up) - lagrangian(m, down)) / (2.0 * step),
                  g[m.unknown[n] + axis * m.unknowns], 1e-6);
    }
  }
}

/// RMS error of the roundabout against its exact solution, in units of the square's side.
double roundabout_error(int n, double kappa, double weight) {
  const double off = scenes::kStudyOffset;
  const ConformingMembrane m = membrane(scenes::roundabout(90.0, off), n, kappa, weight);
  const ConformingResult result = newton(m);
  EXPECT_TRUE(result.converged);
  const RadialReference exact(.22, .40, std::acos(0.0), kappa);
  const std::complex<double> centre(.5 + off, .5 + .7 * off);
  double sum = 0.0;
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    const std::complex<double> rest(m.rest(k, 0) / n, m.rest(k, 1) / n),
        at(result.state.x(k, 0) / n, result.state.x(k, 1) / n);
    sum += std::norm(at - centre - exact.at(rest - centre));
  }
  return std::sqrt(sum) / (n + 1);
}

TEST(OracleConforming, TheRoundaboutIsOfSecondOrder) {
  for (const double kappa : {10.0, kInfinity}) {
    const double e32 = roundabout_error(32, kappa, kInfinity),
                 e64 = roundabout_error(64, kappa, kInfinity);
    EXPECT_LT(e32, kappa == 10.0 ? 1.5e-3 : 2.0e-3);
    // 32² is already better than the order that follows says; finer ones see
    // stability_conforming_test.
    EXPECT_GT(std::log2(e32 / e64), kappa == 10.0 ? 1.55 : 1.35) << kappa;
  }
}

TEST(OracleConforming, StiffSpringsDoAsHardCurvesDo) {
  const double hard = roundabout_error(32, 10.0, kInfinity);
  EXPECT_NEAR(roundabout_error(32, 10.0, 1e7), hard, 1e-3 * hard);
}

}  // namespace
}  // namespace drumhead::oracle
