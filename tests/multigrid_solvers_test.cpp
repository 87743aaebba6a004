// SPDX-License-Identifier: MIT
// Every linear solver by name: whole solves, and what each method promises of a single system.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <drumhead/kernels/reduce.h>

#include "minres.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

using multigrid::Solver;
using multigrid::Status;

constexpr Solver kSolvers[] = {Solver::gcr, Solver::kaczmarz, Solver::coloured_kaczmarz,
                               Solver::minres, Solver::minres_multigrid};
constexpr Solver kMinres[] = {Solver::minres, Solver::minres_multigrid};

multigrid::WarpProblem sponge(int n, double kappa) {
  return scenes::problem(scenes::sponge(scenes::kStudyOffset), n, kappa);
}

double rms_difference(const multigrid::Solution& a, const multigrid::Solution& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.u_px.size(); ++k)
    sum += std::pow(a.u_px[k] - b.u_px[k], 2) + std::pow(a.v_px[k] - b.v_px[k], 2);
  return std::sqrt(sum / double(a.u_px.size()));
}

class Solvers : public testing::TestWithParam<Solver> {};

TEST_P(Solvers, SolveTheSponge) {
  const multigrid::WarpProblem problem = sponge(64, 1.0);
  const multigrid::Solution best = multigrid::solve(
      problem, {.curve_method = multigrid::CurveMethod::averaged, .tolerance_px = 1e-6});
  const multigrid::Solution found = multigrid::solve(
      problem, {.solver = GetParam(), .curve_method = multigrid::CurveMethod::averaged});
  EXPECT_EQ(found.report.solver, GetParam());
  EXPECT_EQ(found.report.status, Status::converged) << name(found.report.status);
  EXPECT_LT(rms_difference(found, best), 0.2 * found.report.discretisation_rms_px);
}

// Near incompressibility with 90° of rotation most of them fail, and must say so.
TEST_P(Solvers, ClaimConvergenceOnlyWhereItIs) {
  const multigrid::WarpProblem problem =
      scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), 32, 1e4);
  const multigrid::Solution best = multigrid::solve(
      problem, {.curve_method = multigrid::CurveMethod::averaged, .tolerance_px = 1e-5});
  const multigrid::Solution found = multigrid::solve(
      problem, {.solver = GetParam(), .curve_method = multigrid::CurveMethod::averaged});
  if (found.report.status == Status::converged) {
    EXPECT_LT(rms_difference(found, best), 0.05 / 32);  // the tolerance is .01 cells
  } else {
    EXPECT_TRUE(found.report.status == Status::stalled || found.report.status == Status::limit)
        << name(found.report.status);
  }
}

TEST_P(Solvers, SolveALinearSystemAsFarAsTheySay) {
  scenes::NewtonLevel<double> level(sponge(32, 1.0), 0.005, 1.0);
  const double start = level.set_force();
  const multigrid::NewtonSystem<double> system = level.system();
  const multigrid::Vector<double> f = system.right_hand_side();
  const multigrid::LinearReport report =
      level.solve({.solver = GetParam(), .content = 1e-6, .reduction = 1e-6, .most_cycles = 200});
  multigrid::Vector<double> x = system.make_vector(), r = system.make_vector();
  kernels::combine<double>(1.0, kernels::Unknowns<const double>(system.correction()), 0.0,
                           x.fields.view());
  x.q = level.level().dq;
  system.residual(f, x, r);
  EXPECT_LT(report.residual, 1e-6);
  EXPECT_NEAR(system.norm(r) / start, report.residual, 1e-9);
}

TEST(Gcr, TakesTheSameCycleWhereItsResidualIsNotLookedAt) {
  const auto solve = [](bool unmeasured) {
    scenes::NewtonLevel<double> level(sponge(32, 1.0), 0.005, 1.0);
    level.set_force();
    const multigrid::LinearReport report = level.solve({.content = 1.0, .unmeasured = unmeasured});
    EXPECT_EQ(report.cycles, 1);
    EXPECT_EQ(std::isnan(report.residual), unmeasured);
    multigrid::Vector<double> x = level.system().make_vector();
    kernels::combine<double>(1.0, kernels::Unknowns<const double>(level.system().correction()), 0.0,
                             x.fields.view());
    return std::pair(level.system().norm(x), level.level().dq);
  };
  EXPECT_EQ(solve(true), solve(false));
}

// The others look at theirs: a step of minres ends with what was asked for.
TEST(Minres, ReportsItsOwnResidual) {
  const multigrid::Solution found = multigrid::solve(
      sponge(64, 1.0),
      {.solver = Solver::minres, .curve_method = multigrid::CurveMethod::averaged});
  for (const multigrid::NewtonStep& step : found.report.levels.back().newton)
    EXPECT_LE(step.residual, 0.3);
}

// Gentle scenes: what Newton's method is told of a cycle is what its step left of the equations.
TEST(Gcr, LeavesTheEquationsAsMuchAsReported) {
  for (const auto method : {multigrid::CurveMethod::averaged, multigrid::CurveMethod::conforming}) {
    const multigrid::Solution found = multigrid::solve(sponge(128, 1.0), {.curve_method = method});
    EXPECT_EQ(found.report.status, Status::converged);
    for (const multigrid::LevelReport& level : found.report.levels)
      for (const multigrid::NewtonStep& step : level.newton) {
        EXPECT_GT(step.residual, 0.0) << level.nx;
        EXPECT_LT(step.residual, 0.9) << level.nx;
      }
  }
}

TEST_P(Solvers, AreFoundByTheirNames) {
  EXPECT_EQ(multigrid::solver_named(name(GetParam())), GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, Solvers, testing::ValuesIn(kSolvers), [](const auto& info) {
  std::string word = name(info.param);
  std::erase(word, '-');
  return word;
});

TEST(SolverNames, OthersAreNone) {
  EXPECT_FALSE(multigrid::solver_named("GCR"));
  EXPECT_FALSE(multigrid::solver_named(""));
}

multigrid::Vector<double> random_vector(const multigrid::NewtonSystem<double>& system,
                                        unsigned seed) {
  multigrid::Vector<double> v = system.make_vector();
  std::mt19937 bits(seed);
  const auto number = [&] { return double(bits()) / double(1u << 31) - 1.0; };
  const auto view = v.fields.view();
  for (const kernels::Plane<double>& plane : {view.x, view.y})
    for (int j = 1; j + 1 < plane.rows; ++j)
      for (int i = 1; i + 1 < plane.columns; ++i) plane.at(i, j) = number();
  for (int j = 0; view.p && j < view.p.rows; ++j)
    for (int i = 0; i < view.p.columns; ++i) view.p.at(i, j) = number();
  for (double& q : v.q) q = number();
  return v;
}

TEST(BlockPreconditioner, IsSymmetricAndPositiveDefinite) {
  for (const double kappa : {0.0, 10.0, 1e4}) {
    scenes::NewtonLevel<double> level(sponge(40, kappa), 0.005, 1e30);
    const multigrid::NewtonSystem<double> system = level.system();
    for (const Solver solver : kMinres) {
      multigrid::BlockPreconditioner<double> preconditioner(system, solver);
      for (unsigned seed = 1; seed <= 8; seed += 2) {
        const auto a = random_vector(system, seed), b = random_vector(system, seed + 1);
        auto za = system.make_vector(), zb = system.make_vector();
        preconditioner.apply(a, za);
        preconditioner.apply(b, zb);
        const double size = std::sqrt(system.dot(a, za) * system.dot(b, zb));
        EXPECT_GT(system.dot(a, za), 0.0);
        EXPECT_GT(system.dot(b, zb), 0.0);
        EXPECT_NEAR(system.dot(a, zb), system.dot(za, b), 1e-12 * size);
      }
    }
  }
}

// The recurrence of the residual norm against the residual itself.
TEST(Minres, ResidualNeverGrowsAndIsTheTrueOne) {
  for (const double kappa : {0.0, 10.0}) {
    scenes::NewtonLevel<double> level(sponge(32, kappa), 0.005, 1.0);
    level.set_force();
    const multigrid::NewtonSystem<double> system = level.system();
    const multigrid::Vector<double> f = system.right_hand_side();
    for (const Solver solver : kMinres) {
      multigrid::BlockPreconditioner<double> preconditioner(system, solver);
      multigrid::Minres<double> minres(system, preconditioner, f);
      const double start = minres.residual();
      auto r = system.make_vector(), z = system.make_vector();
      for (int n = 0; n < 60; ++n) {
        const double before = minres.residual();
        ASSERT_TRUE(minres.step());
        EXPECT_LE(minres.residual(), before * (1.0 + 1e-12));
        system.residual(f, minres.solution(), r);
        preconditioner.apply(r, z);
        EXPECT_NEAR(std::sqrt(system.dot(r, z)), minres.residual(), 1e-8 * start);
      }
      EXPECT_LT(minres.residual(), 0.5 * start);
    }
  }
}

}  // namespace
}  // namespace drumhead
