// SPDX-License-Identifier: MIT
#pragma once
// Newton's systems on the lattice by algebraic multigrid, in PETSc. The pressures are eliminated
// (kappa finite), which leaves [A Wᵀ; W −M] with A = K + G + kappa BᵀB for x̂, interleaved by node,
// and the curve rows W with their softness M for q. MINRES solves it, preconditioned by a V-cycle
// of GAMG (PETSc) or BoomerAMG (hypre), told that a node has two unknowns, on A + gamma WᵀW, with
// pressures clamped to ±mu so that it is positive definite, beside 1/gamma + M for q. Were the
// V-cycle exact and M zero, all eigenvalues would be 1 or lie between −1 and −gamma s/(1 + gamma
// s), s the least eigenvalue of W A⁻¹ Wᵀ. Tried and lost: P as unknowns, AMG on K + gamma WᵀW and a
// diagonal for P (1 to 3 times the iterations at kappa/mu 1, hundreds at 10); telling GAMG of
// rotations (a fifth fewer iterations, but coarse levels are singular from 200² on).
#include "nested_newton.h"

namespace drumhead::bench {

enum class Amg { gamg, boomeramg };

struct AmgCost {
  int systems = 0, iterations = 0, last_iterations = 0;  ///< last: of the last system
  double setup_seconds = 0.0, iterate_seconds = 0.0;     ///< all else is assembly
  double bytes = 0.0;  ///< allocated for a system at the most: matrices, hierarchy, vectors
  bool solved = true;  ///< every system, to the tolerance
};

class AmgSolver {
 public:
  /// A system is solved when the preconditioned residual is `reduction` times what it was.
  AmgSolver(Amg amg, double reduction);
  Eigen::VectorXd operator()(const NewtonSystem& system);
  const AmgCost& cost() const { return cost_; }

 private:
  Amg amg_;
  double reduction_;
  AmgCost cost_;
};

}  // namespace drumhead::bench
