// SPDX-License-Identifier: MIT
#pragma once
// Newton's method on the oracle's assembled system, with a direct sparse factorisation: the same
// schedule of clamped pressures as the solver, so that both find the same minimum, and nothing else
// in common.
#include <optional>

#include "oracle_system.h"

namespace drumhead::oracle {

struct OracleResult {
  State state;
  bool converged = false;
  int steps = 0;
};

/// The minimum without pressures (kappa = 0 everywhere), which is a linear problem; P = 0.
State harmonic(const OracleScene& scene);

/// Newton from `start`, or from the harmonic solution, until no node moves by 1e-10 cells.
OracleResult newton(const OracleScene& scene, const std::optional<State>& start = {});

/// The largest t of 1, 1/2, 1/4 … at which the merit of state + t · step has fallen; 0 when it
/// never does.
double line_search(const OracleScene& scene, const State& state, const Eigen::VectorXd& step);

/// Solves matrix · step = right side for a symmetric indefinite matrix that may be (consistently)
/// singular in its P and q blocks: those are shifted by −1e-9 for the factorisation and the shift
/// is refined away. `first_multiplier`: index of the first P. Returns the relative residual left.
double solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& right,
             int first_multiplier, Eigen::VectorXd& step);

}  // namespace drumhead::oracle
