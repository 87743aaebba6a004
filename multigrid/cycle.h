// SPDX-License-Identifier: MIT
#pragma once
// Multigrid cycles for one Newton system: correction scheme, the relaxation of kernels/relax.h before and
// after, a dense solution on the bottom level. x̂ is restricted by the adjoint of bilinear interpolation,
// pressures by sums, curve forces by arc length (unlike Setaluri et al. 2014, section 3.5, which transfers
// none and relaxes more near the curves instead).
#include "coarse_solver.h"
#include "hierarchy.h"

namespace drumhead::multigrid {

enum class CycleKind { v, f };

template <class T>
class Cycle {
 public:
  /// Prepares the systems of levels `top`…bottom at the state of level `top`; `pressure` false: the harmonic
  /// system, kappa = 0.
  Cycle(Hierarchy<T>& hierarchy, int top, bool pressure);

  /// One cycle from zero: d, dq of the top level := approximate solution for its f, fq. f is changed: it
  /// carries the curve forces of dq afterwards.
  void run(CycleKind kind);

  /// The system of level l as the preconditioner sees it (with the jump term inside).
  kernels::LevelSystem<T> system(int l);

 private:
  void descend(int l, CycleKind kind, bool from_zero);
  void restrict_cuts(int l);
  void prolong_cuts(int l);

  Hierarchy<T>& hierarchy_;
  int top_;
  bool pressure_;
  T clamp_width_ = T(1);
  CoarseSolver<T> bottom_;
  std::vector<T> residual_;
};

}  // namespace drumhead::multigrid
