// SPDX-License-Identifier: MIT
#pragma once
// Newton's method on one level, globalised by the clamp schedule: the pressure in the Hessian is
// P_H = clamp(P − median P, ±theta mu). With theta = 1 the elastic block is positive definite;
// theta grows eightfold where full steps are limited by the clamp rather than by the linear solver,
// and shrinks with every shortened step. Plain Newton diverges on two thirds of the hard scenes. A
// full step that brings all equations closer to zero is taken as it is; otherwise the step length
// is halved on a merit function in which the multipliers are those of the full step. With averaged
// rows a step that points where the one before did goes up to half as far again.
#include <drumhead/multigrid/warp.h>

#include "krylov.h"
#include "progress_line.h"

namespace drumhead::multigrid {

/// Discretisation error of a level as a share of what Newton changed on it after the coarser one.
/// 1 if a first-order error simply halved from level to level; found at 64², against 256²: 1.3 (S1,
/// whose tips converge more slowly), .75 to .9 (S2), .65 to .85 (S4).
inline constexpr double kErrorOfChange = 0.8;
/// What is taken for it with conforming cells, whose curves have no tips or some (found on 64² to
/// 256²: 1/7 to 1/4, and 1/2 to 1). It sets how much coarse levels are solved; the finest and the
/// report's error go by level_change.h.
inline constexpr double kErrorOfSecondOrder = 1.0 / 3.0, kErrorWithTips = 1.0 / 2.0;

/// Of the n-th step of a level.
struct Contraction {
  double rate = 0.0;      ///< the move of the next step by its own: dx2/dx1, dx3/dx2, …
  double residual = 0.0;  ///< of its linear system; 0: not known, and never counted on below rate
};

struct NewtonOptions {
  double tolerance_rms = 0.0;  ///< stop when the error left is estimated below this, finest cells
  double tolerance_max =
      0.0;  ///< and, if > 0, when no node moved further than this in the last step
  /// Besides: stop when the error left is under this share of the RMS of all that Newton changed on
  /// the level, of which the discretisation error is a fixed share in turn. 0: not a criterion.
  double share_of_change = 0.0;
  /// This share suffices where it is below what moves by rounding leave.
  double share_in_noise = 0.0;
  double most_volume_gap = 0.0;  ///< and, if > 0, not before NewtonReport::volume_gap is below
  int least_steps = 1;
  int most_steps = 8;
  bool gives_up = false;  ///< stalls with the first step that has to be shortened
  /// So many steps in a row none of which moves nodes by less than half the least before stall; 0:
  /// they do not.
  int most_idle = 0;
  /// Of the steps on the level before: what a step's successor is expected to do before it is
  /// taken.
  std::vector<Contraction> expected;
  double onset = 0.0;  ///< of corners' one-sided term at the end (corners.h)
  /// No step is expected to contract by more than this, nor, without such a model, than that.
  double least_rate = 0.0, least_unknown_rate = 0.0;
  /// A mask of kappa: steps may converge unevenly (newton_judge.h). Without one the same rules
  /// end S5, kappa/mu 1e4, 128², conforming, with 2 ‰ more energy than it may have.
  bool contrast = false;
  /// Steps that point where the one before did go on to where that leads (newton_judge.h).
  bool lengthens = false;
  LinearOptions linear;
  /// Exact rows: linear.reduction is the residual wanted at first, less where Newton's method
  /// converges fast or where steps are shortened.
  bool adaptive = false;
};

struct NewtonReport {
  Status status = Status::converged;
  std::vector<NewtonStep> steps;              ///< dx in finest cells here
  double error_rms = 0.0, error_max = 0.0;    ///< estimated algebraic error left, finest cells
  double change_rms = 0.0, change_max = 0.0;  ///< all that Newton changed, finest cells
  /// Σ A kappa/2 (J* − 1 − P/kappa)², by how much the energy exceeds Eq. 5 at the same state: as a
  /// share of the energy at rest, Σ A mu, where that is below most_volume_gap or none is asked for,
  /// else of the energy. Cells where 1/kappa is 0 do not count.
  double volume_gap = 0.0;
  bool rounded =
      false;  ///< ended where the precision of T lets nodes come no closer, with error_rms
  std::vector<Contraction> contractions;  ///< as observed, for the next level
};

/// What the clamp schedule remembers from level to level.
struct ClampSchedule {
  double theta = 1.0;
  double most = 1e6;  ///< lowered where the linear solver stagnated; above 1e6 the Hessian is exact
  /// Full steps after which a lowered bound rises again, twice as many each time that the linear
  /// solver then fails; 0: it never rises.
  int patience = 0;
  int full_steps = 0;  ///< since the bound was lowered or rose
};

template <class T>
class Newton {
 public:
  Newton(Hierarchy<T>& hierarchy, int top, grid::MemoryMeter& meter);

  /// Sets the state to the harmonic one (kappa = 0; linear): x̂ and q.
  LinearReport harmonic(const LinearOptions& options);

  /// Largest |b − W u − M q| of a curve row at the current state, in finest cells.
  double largest_row_gap();

  /// Steps from the current state of the level, until it is solved or `progress` stops it.
  NewtonReport run(const NewtonOptions& options, ClampSchedule& clamp,
                   const LevelProgress& progress);

 private:
  void set_force(bool pressure);
  void set_clamp(double theta);
  double median_pressure() const;
  double curve_merit(double step) const;
  double curve_work(double step) const;
  void prepare_curve_merit();
  double force_norm(bool pressure);
  double line_search(double longest);
  double take_step(double norm_before, double longest, double lengthened);
  double drop_momentum();
  double take_area_step(double gap, double enough);
  int inverted_cells() const;
  void update(double step, bool pressure);
  void raise_floor();
  bool lower_floor();
  void adapt(ClampSchedule& clamp, const NewtonStep& step, bool shortened, bool corners,
             double norm_before) const;
  LinearReport solve_step(double norm, const LinearOptions& options, ClampSchedule& clamp);
  bool finite(const LinearReport& linear, bool unmeasured) const;
  double precision() const;
  bool lost_in_rounding() const;

  Hierarchy<T>& hierarchy_;
  Level<T>& level_;
  grid::MemoryMeter& meter_;
  const double stiffness_;  ///< Σ mu
  /// Of d, whatever share of it was taken, and of the state after the last update.
  struct Moves {
    double rms = 0.0;
    double longest = 0.0;  ///< at most, of a node: from the largest dx and dy
    double largest = 0.0;  ///< component
    double reach = 0.0;    ///< largest component of a displacement
    bool finite = true;
  };

  std::vector<double> gap_, slope_;  ///< per curve row: b − W u − M q⁺ and −W du
  double penalty_ = 0.0;             ///< nu
  double norm_ = 0.0;                ///< of the force that was set last
  double volume_squares_ = 0.0;      ///< Σ g² over the cells' rows of that force
  Moves moves_;
  int inverted_cells_ = 0;  ///< at the state of that force
};

}  // namespace drumhead::multigrid
