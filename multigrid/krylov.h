// SPDX-License-Identifier: MIT
#pragma once
// Solution of one Newton system on a level, by the solver that the options name. The recommended
// one: cycles alone first, which need no memory besides the level's own. Only where they reduce the
// residual too little does flexible GCR take over, which minimises the residual over its last few
// directions (strong stretch, indefinite systems far from a solution, exact curve rows).
#include <limits>

#include <drumhead/multigrid/warp.h>

#include "cycle.h"
#include "newton_system.h"

namespace drumhead::multigrid {

struct LinearOptions {
  Solver solver = Solver::gcr;
  double content = 0.1;    ///< residual, relative, at which plain cycles stop
  double reduction = 0.1;  ///< and all other methods
  int most_cycles = 30;
  int directions = 20;  ///< stored pairs of GCR, 6 values a node each, allocated as they come
  int most_idle = std::numeric_limits<int>::max();  ///< gcr: cycles in a row that gain nothing
  CycleKind kind = CycleKind::f;
  bool band = false;  ///< Cycle::relax_band
  /// gcr on rows with their jump: one cycle, whose residual is not looked at.
  bool unmeasured = false;
  bool lightens = false;  ///< such cycles are V-cycles after the first steps (newton_accuracy.h)
};

struct LinearReport {
  int cycles = 0;         ///< or iterations of MINRES
  double residual = 1.0;  ///< relative to the right-hand side; not a number: not measured
};

/// Solves the system of level `top` at its state (`pressure` false: the harmonic system, kappa = 0)
/// for its right-hand side f, fq of norm `start`, which does not carry curve forces and is lost.
/// The solution is in d, dq.
template <class T>
LinearReport solve_linear(Hierarchy<T>& hierarchy, int top, bool pressure, double start,
                          const LinearOptions& options, grid::MemoryMeter& meter);

}  // namespace drumhead::multigrid
