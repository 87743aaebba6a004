// SPDX-License-Identifier: MIT
#pragma once
// The nested Newton iteration that drumhead's rivals run, so that they differ in nothing but what
// is asked: from the coarsest level to the finest, full steps with the pressure in the Hessian
// clamped to ±theta about its median, theta eight times larger after each, until what is left is a
// tenth of the estimated discretisation error. drumhead stops by the same rule
// (multigrid/newton_judge.h).
#include <functional>
#include <vector>

#include "support/oracle_system.h"

namespace drumhead::bench {

/// Seconds of a clock that only goes forward.
double now();

/// Pressures as they enter the Hessian: less their median, at most theta in size.
Eigen::VectorXd clamped(const Eigen::VectorXd& P, double theta);

struct NewtonStep {
  double dx = 0.0;  ///< RMS over the nodes of the full step, in cells
  double t = 1.0;   ///< share of it that was gone
};
/// Newton steps on one level, of which `step(theta)` takes one. Returns their number, and with
/// theta what the next level begins with.
int newton_steps(bool coarsest, double& theta, const std::function<NewtonStep(double)>& step);

/// Cells along a side of the lattices on the way to n, coarsest first.
std::vector<int> nested_lattices(int n);

/// The linear system of one step on the lattice, by the tests' oracle.
struct NewtonSystem {
  const oracle::OracleScene& scene;
  const oracle::State& state;
  const oracle::OracleSystem& linear;  ///< pressures clamped to ±theta
  double theta;
};
/// The step: the solution of linear.matrix · step = −linear.gradient.
using LinearSolver = std::function<Eigen::VectorXd(const NewtonSystem& system)>;

struct NestedNewton {
  oracle::OracleScene scene;  ///< of the finest lattice
  oracle::State state;
  int newton = 0, newton_finest = 0;
  double assemble_seconds = 0.0, solve_seconds = 0.0;
};
/// drumhead's default path: hard curves at d = 1e6 with the q-jump. n even and at least 32.
NestedNewton nested_newton(const scenes::Scene& scene, int n, double kappa,
                           const LinearSolver& solve);

/// Displacements of all nodes of the finest lattice, i fastest, as shares of the picture.
void displacements(const NestedNewton& newton, std::vector<double>& u, std::vector<double>& v);

}  // namespace drumhead::bench
