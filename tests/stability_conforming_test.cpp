// SPDX-License-Identifier: MIT
// Curves that the lattice conforms to: the whole solver against Newton's method on the assembled
// matrix, and its order on the roundabout's exact solution.
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "support/oracle_conforming.h"
#include "support/radial_reference.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

constexpr grid::ConformOptions kOwnPressures{.least_area = 0.0};

multigrid::Solution solve_to(const scenes::Scene& scene, int n, double kappa,
                             double tolerance_cells) {
  multigrid::SolverOptions options;
  options.curve_method = multigrid::CurveMethod::conforming;
  options.tolerance_px = tolerance_cells / n;
  return multigrid::solve(scenes::problem(scene, n, kappa), options);
}

/// Largest distance from the assembled solution at nodes that rest in their places, in cells.
double distance_to_oracle(const scenes::Scene& scene, int n, double kappa) {
  const multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  const oracle::ConformingMembrane m = oracle::conforming_membrane(
      problem.curves, problem.lattice, scenes::kappa_cells(scene, n, kappa), kOwnPressures);
  const oracle::ConformingResult direct = oracle::newton(m);
  EXPECT_TRUE(direct.converged);
  const multigrid::Solution solution = solve_to(scene, n, kappa, 1e-8);
  EXPECT_EQ(solution.report.status, multigrid::Status::converged)
      << multigrid::name(solution.report.status);
  double worst = 0.0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      if (m.cells.find_node(i, j) >= 0) continue;
      const Eigen::Index k = j * (n + 1) + i;
      worst = std::max(worst,
                       std::hypot(solution.u_px[std::size_t(k)] * n - (direct.state.x(k, 0) - i),
                                  solution.v_px[std::size_t(k)] * n - (direct.state.x(k, 1) - j)));
    }
  std::printf("%s %d² kappa %g: %.1e cells from the assembled solution\n", scene.name.c_str(), n,
              kappa, worst);
  return worst;
}

TEST(ConformingSolver, AgreesWithTheAssembledMatrix) {
  const double offset = scenes::kStudyOffset;
  for (const double kappa : {1.0, 10.0, 100.0}) {
    EXPECT_LT(distance_to_oracle(scenes::roundabout(90.0, offset), 32, kappa), 1e-6);
    EXPECT_LT(distance_to_oracle(scenes::shift(offset), 64, kappa), 1e-6);
  }
}

/// RMS error of the roundabout in units of the square's side.
double roundabout_error(int n, double kappa) {
  const double offset = scenes::kStudyOffset;
  const multigrid::Solution solution = solve_to(scenes::roundabout(90.0, offset), n, kappa, 1e-3);
  EXPECT_EQ(solution.report.status, multigrid::Status::converged);
  const oracle::RadialReference exact(.22, .40, std::acos(0.0), kappa);
  const std::complex<double> centre(.5 + offset, .5 + .7 * offset);
  double sum = 0.0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = std::size_t(j) * std::size_t(n + 1) + std::size_t(i);
      const std::complex<double> rest(double(i) / n, double(j) / n),
          moved(solution.u_px[k], solution.v_px[k]);
      sum += std::norm(rest + moved - centre - exact.at(rest - centre));
    }
  return std::sqrt(sum) / (n + 1);
}

TEST(ConformingSolver, IsOfSecondOrder) {
  for (const double kappa : {1.0, 10.0, 100.0}) {
    const double e64 = roundabout_error(64, kappa), e128 = roundabout_error(128, kappa),
                 e256 = roundabout_error(256, kappa);
    std::printf("kappa %g: RMS error %.2e %.2e %.2e of the side\n", kappa, e64, e128, e256);
    EXPECT_GT(std::log2(e64 / e128), 1.8);
    EXPECT_GT(std::log2(e128 / e256), 1.8);
  }
}

TEST(ConformingSolver, ConvergesForEveryKappa) {
  const double offset = scenes::kStudyOffset, infinite = std::numeric_limits<double>::infinity();
  for (const scenes::Scene& scene :
       {scenes::sponge(offset), scenes::roundabout(90.0, offset), scenes::shift(offset)})
    for (const double kappa : {0.0, 1.0, 10.0, 100.0, 1e4, infinite}) {
      multigrid::SolverOptions options;
      options.curve_method = multigrid::CurveMethod::conforming;
      options.threads = 1;
      const multigrid::SolveReport report =
          multigrid::solve(scenes::problem(scene, 128, kappa), options).report;
      EXPECT_EQ(report.status, multigrid::Status::converged)
          << scene.name << " kappa " << kappa << ": " << multigrid::name(report.status);
      EXPECT_LE(report.levels.back().newton.size(), scene.name == "S1" ? 20u : 12u);
    }
}

// A tenth of the discretisation error is less than single precision resolves: without the rule the
// turned circle took 40 steps of rounding and ended with `limit`.
TEST(ConformingSolver, EndsWhereRoundingLetsNodesComeNoCloser) {
  const double offset = scenes::kStudyOffset;
  auto solve = [](const scenes::Scene& scene, double kappa) {
    return multigrid::solve(scenes::problem(scene, 800, kappa),
                            {.curve_method = multigrid::CurveMethod::conforming})
        .report;
  };
  const multigrid::SolveReport moved = solve(scenes::shift(offset), 1.0),
                               turned = solve(scenes::roundabout(90.0, offset), 10.0);
  for (const multigrid::SolveReport& report : {moved, turned}) {
    EXPECT_EQ(report.status, multigrid::Status::converged);
    EXPECT_LE(report.levels.back().newton.size(), 8u);
    // Rounded displacements of 300 cells: 2e-5 of a cell, which is a share of 2.5e-8 of the side.
    EXPECT_GT(report.algebraic_rms_px, 2.5e-8);
    EXPECT_LT(report.algebraic_rms_px, 1e-6);
  }
  ASSERT_FALSE(moved.notes.empty());
  EXPECT_NE(moved.notes.back().find("single precision"), std::string::npos);
  EXPECT_TRUE(turned.notes.empty());
}

TEST(ConformingSolver, RefusesSoftCurvesAndExactRows) {
  multigrid::WarpProblem problem = scenes::problem(scenes::shift(), 32, 1.0);
  multigrid::SolverOptions options;
  options.curve_method = multigrid::CurveMethod::conforming;
  options.exact = true;
  EXPECT_THROW(static_cast<void>(multigrid::solve(problem, options)), std::invalid_argument);
  options.exact = false;
  problem.curves[0].weight = 5.0;
  EXPECT_THROW(static_cast<void>(multigrid::solve(problem, options)), std::invalid_argument);
}

}  // namespace
}  // namespace drumhead
