// SPDX-License-Identifier: MIT
#pragma once
// Multigrid cycles for one Newton system: correction scheme, the relaxation of kernels/relax.h
// before and after, a dense solution on the bottom level. x̂ is restricted by the adjoint of
// bilinear interpolation, pressures by sums, curve forces by arc length (unlike Setaluri et al.
// 2014, section 3.5, which transfers none and relaxes more near the curves instead).
#include <limits>
#include <optional>

#include "coarse_solver.h"
#include "curve_patch.h"
#include "hierarchy.h"
#include "kaczmarz_smoother.h"

namespace drumhead::multigrid {

enum class CycleKind { v, f };

template <class T>
class Cycle {
 public:
  /// Clamp of the pressure in the cycle's systems: that of the equations, or 1, positive definite,
  /// for a preconditioner (GCR needs .69 per cycle instead of .91: S4, kappa 100, 32², exact
  /// Hessian).
  static constexpr T kAsEquations = std::numeric_limits<T>::infinity();
  static constexpr T kDefinite = T(1);

  /// Prepares the systems of levels `top`…bottom at the state of level `top`; `pressure` false: the
  /// harmonic system, kappa = 0. `most_clamp`: upper bound of the clamp.
  Cycle(Hierarchy<T>& hierarchy, int top, bool pressure, T most_clamp);

  /// Relaxes by Kaczmarz's method on all rows instead, and as the paper has no jump term in the
  /// volume rows of coarse levels; `solver`: kaczmarz or coloured_kaczmarz.
  void relax_by(Solver solver, grid::MemoryMeter& meter);

  /// Relaxes all rows along the curves at once, too, as exact rows need (curve_patch.h).
  void relax_patches(grid::MemoryMeter& meter);

  /// Relaxes the band beside the curves once more before the first restriction, for a state that
  /// was interpolated from a coarser level.
  void relax_band();

  /// One cycle for the top level's d, dq, from zero or from what they are. f is changed: it carries
  /// the curve forces of dq afterwards (and must do so before, if not from zero).
  void run(CycleKind kind, bool from_zero);

  bool pressure() const { return pressure_; }
  /// The system of level l as the preconditioner sees it (with the jump term inside).
  kernels::LevelSystem<T> system(int l);

 private:
  void descend(int l, CycleKind kind, bool from_zero);
  void relax_down(int l, bool from_zero);
  void relax_up(int l);
  void prepare_relaxation();
  void linearise_special(int l);
  bool has_regions(const Level<T>& level) const {
    return pressure_ && level.pressure && level.conforming;
  }
  bool sweeps_once(int l) const { return l <= last_once_; }
  void restrict_cuts(int l);
  void prolong_cuts(int l);

  Hierarchy<T>& hierarchy_;
  int top_;
  bool pressure_;
  T clamp_width_ = T(1);
  CoarseSolver<T> bottom_;
  std::optional<KaczmarzSmoother<T>> smoother_;
  std::vector<CurvePatch<T>> patches_;  ///< of all levels but the bottom, from the top
  std::vector<T> residual_;
  int band_down_ = 0, band_up_ = 0;  ///< RelaxStages::band of the top level, and of all
  int last_once_ = -1;  ///< the last level whose volume rows are swept once a relaxation
};

}  // namespace drumhead::multigrid
