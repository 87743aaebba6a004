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

constexpr double kHard = std::numeric_limits<double>::infinity();

/// A scene whose first curve has weight `first`, all others `others`.
multigrid::WarpProblem problem_with(const scenes::Scene& scene, int n, double kappa, double first,
                                    double others) {
  multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  for (grid::CurvePair& curve : problem.curves) curve.weight = others;
  problem.curves[0].weight = first;
  return problem;
}

multigrid::Solution solve_to(const multigrid::WarpProblem& problem, double tolerance_cells) {
  multigrid::SolverOptions options;
  options.curve_method = multigrid::CurveMethod::conforming;
  options.tolerance_px = tolerance_cells * problem.lattice.cell_px;
  return multigrid::solve(problem, options);
}

enum class Ask { tolerance, exact, exact_from_there };

/// Positions of a solution's lattice nodes, in cells; what curves hold at its targets.
oracle::Positions positions(const multigrid::Solution& solution,
                            const oracle::ConformingMembrane& m) {
  oracle::Positions x = m.target;
  for (std::size_t k = 0; k < solution.u_px.size(); ++k)
    if (!m.known[k])
      x.row(Eigen::Index(k)) =
          m.rest.row(Eigen::Index(k)) +
          Eigen::RowVector2d(solution.u_px[k], solution.v_px[k]) / solution.lattice.cell_px;
  return x;
}

/// Largest distance from the assembled solution at nodes that rest in their places, in cells. Where
/// minima are many it is the one that the direct method finds from there.
double distance_to_oracle(const scenes::Scene& scene, int n, double kappa, double first = kHard,
                          double others = kHard, Ask ask = Ask::tolerance) {
  const multigrid::WarpProblem problem = problem_with(scene, n, kappa, first, others);
  const oracle::ConformingMembrane m = oracle::conforming_membrane(
      problem.curves, problem.lattice, scenes::kappa_cells(scene, n, kappa));
  const multigrid::Solution solution =
      ask == Ask::tolerance
          ? solve_to(problem, 1e-8)
          : multigrid::solve(problem,
                             {.curve_method = multigrid::CurveMethod::conforming, .exact = true});
  const oracle::Positions start = positions(solution, m);
  const oracle::ConformingResult direct =
      oracle::newton(m, ask == Ask::exact_from_there ? &start : nullptr);
  EXPECT_TRUE(direct.converged);
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
  std::printf("%s %d² kappa %g, weights %g and %g: %.1e cells from the assembled solution\n",
              scene.name.c_str(), n, kappa, first, others, worst);
  const oracle::ConformingEnergy energy = oracle::energy(m, direct.state);
  EXPECT_NEAR(solution.report.energy.elastic, energy.elastic, 1e-7);
  EXPECT_NEAR(solution.report.energy.constraint, energy.constraint, 1e-7);
  return worst;
}

TEST(ConformingSolver, AgreesWithTheAssembledMatrix) {
  const double offset = scenes::kStudyOffset;
  for (const double kappa : {1.0, 10.0, 100.0}) {
    EXPECT_LT(distance_to_oracle(scenes::roundabout(90.0, offset), 32, kappa), 1e-6);
    EXPECT_LT(distance_to_oracle(scenes::shift(offset), 64, kappa), 1e-6);
  }
}

TEST(ConformingSolver, AgreesWithTheAssembledMatrixOnSoftCurves) {
  const double offset = scenes::kStudyOffset;
  for (const double weight : {1.0, 1e2, 1e4, 1e6}) {
    EXPECT_LT(distance_to_oracle(scenes::roundabout(90.0, offset), 32, 10.0, weight, weight), 1e-6);
    EXPECT_LT(distance_to_oracle(scenes::roundabout(90.0, offset), 32, 1.0, weight, kHard), 1e-6);
    EXPECT_LT(distance_to_oracle(scenes::shift(offset), 64, 10.0, weight), 1e-6);
  }
}

// Neither kappa nor weights are capped, and Newton's method goes on until no node moves.
TEST(ConformingSolver, ExactAgreesWithTheAssembledMatrix) {
  const double offset = scenes::kStudyOffset;
  const scenes::Scene tips = scenes::sponge(offset), disc = scenes::shift(offset),
                      turn = scenes::roundabout(90.0, offset);
  const auto distance = [](const scenes::Scene& scene, int n, double kappa, double weight = kHard,
                           Ask ask = Ask::exact) {
    return distance_to_oracle(scene, n, kappa, weight, weight, ask);
  };
  for (const double kappa : {1.0, 10.0, 100.0}) {
    const Ask from = kappa > 10.0 ? Ask::exact_from_there : Ask::exact;
    EXPECT_LT(distance(tips, 64, kappa, kHard, from), 1e-6);
    EXPECT_LT(distance(turn, 64, kappa), 1e-6);
    EXPECT_LT(distance(disc, 64, kappa), 1e-6);
  }
  EXPECT_LT(distance(scenes::pinch(offset), 64, 1.0), 1e-6);
  EXPECT_LT(distance(disc, 32, 10.0, 1e7), 1e-6);
  for (const double kappa : {1e4, kHard})
    for (const scenes::Scene& scene : {tips, turn, disc})
      EXPECT_LT(distance(scene, 32, kappa, kHard, Ask::exact_from_there), 1e-6);
}

/// RMS error of the roundabout in units of the square's side.
double roundabout_error(int n, double kappa) {
  const double offset = scenes::kStudyOffset;
  const multigrid::Solution solution =
      solve_to(scenes::problem(scenes::roundabout(90.0, offset), n, kappa), 1e-3);
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
    EXPECT_LT(e64, 7e-4);
    EXPECT_GT(std::log2(e64 / e128), 1.75);
    EXPECT_GT(std::log2(e128 / e256), 1.8);
  }
}

/// RMS distance at the nodes that both have from the solution on a lattice of 512², in units of the
/// side; nodes that curves hold, which have moved, left out.
double distance_to_fine(const multigrid::Solution& coarse, const multigrid::Solution& fine) {
  const int n = coarse.lattice.nx, ratio = fine.lattice.nx / n;
  double sum = 0.0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = std::size_t(j) * std::size_t(n + 1) + std::size_t(i),
                        m = std::size_t(ratio * j) * std::size_t(ratio * n + 1) +
                            std::size_t(ratio * i);
      sum +=
          std::pow(coarse.u_px[k] - fine.u_px[m], 2) + std::pow(coarse.v_px[k] - fine.v_px[m], 2);
    }
  return std::sqrt(sum) / (n + 1);
}

TEST(ConformingSolver, IsOfSecondOrderOnSoftCurves) {
  const double offset = scenes::kStudyOffset;
  auto solved = [&](int n) {
    return solve_to(problem_with(scenes::roundabout(90.0, offset), n, 10.0, 100.0, 100.0), 1e-3);
  };
  const multigrid::Solution fine = solved(512);
  const double e64 = distance_to_fine(solved(64), fine), e128 = distance_to_fine(solved(128), fine);
  std::printf("weight 100: RMS error %.2e %.2e of the side\n", e64, e128);
  EXPECT_GT(std::log2(e64 / e128), 1.8);
}

/// How far the nodes of curves of one weight are off their targets, RMS in units of the side: from
/// the energy of their springs, which is weight/2 ∫ off² along the curves.
double off_target(const multigrid::Solution& solution, double weight) {
  double length = 0.0;
  for (const multigrid::CurveReport& curve : solution.report.curves) length += curve.length_px;
  return std::sqrt(2.0 * solution.report.energy.constraint / (weight * length));
}

TEST(ConformingSolver, SoftCurvesAreAsFarOffOnEveryLatticeAndLessTheStifferTheyAre) {
  const scenes::Scene scene = scenes::roundabout(90.0, scenes::kStudyOffset);
  double stiff = 0.0;
  for (const double weight : {1.0, 1e2, 1e4, 1e6}) {
    std::vector<double> off;
    for (const int n : {64, 128, 256}) {
      const multigrid::Solution solution =
          solve_to(problem_with(scene, n, 10.0, weight, weight), 1e-3);
      EXPECT_EQ(solution.report.status, multigrid::Status::converged);
      off.push_back(off_target(solution, weight));
    }
    std::printf("weight %g: off by %.3e %.3e %.3e of the side\n", weight, off[0], off[1], off[2]);
    EXPECT_NEAR(off[0], off[2], 0.05 * off[2]);
    EXPECT_NEAR(off[1], off[2], 0.05 * off[2]);
    if (weight == 1e6) {  // the traction is that of hard curves then
      EXPECT_NEAR(off[2], 0.01 * stiff, 0.05 * off[2]);
    }
    stiff = off[2];
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
      int cycles = 0;  // mostly one a step
      for (const multigrid::NewtonStep& step : report.levels.back().newton) cycles += step.krylov;
      EXPECT_LE(cycles, scene.name == "S1" ? 20 : 15) << scene.name << " kappa " << kappa;
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

// On 3200² cells what rounding leaves are long waves, the merit sees but noise, and linear systems
// solved ever better gain nothing: the moved disc took 40 steps of them, the roundabout ten
// minutes.
TEST(ConformingSolver, EndsWhereWavesOfRoundingAreLeft) {
  const double offset = scenes::kStudyOffset;
  for (const scenes::Scene& scene : {scenes::shift(offset), scenes::roundabout(90.0, offset)}) {
    SCOPED_TRACE(scene.name);
    const multigrid::SolveReport report =
        multigrid::solve(scenes::problem(scene, 3200, 10.0),
                         {.curve_method = multigrid::CurveMethod::conforming})
            .report;
    EXPECT_EQ(report.status, multigrid::Status::converged);
    EXPECT_LE(report.levels.back().newton.size(), 8u);
    EXPECT_LT(report.algebraic_rms_px, 3e-6);
  }
}

}  // namespace
}  // namespace drumhead
