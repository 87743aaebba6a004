// SPDX-License-Identifier: MIT
#pragma once
// Nested iteration: the harmonic state and Newton to the end on a small lattice, then a few Newton
// steps on each finer one, from the interpolated solution of the coarser. What a level changes in
// that start estimates its discretisation error for free: kErrorOfChange RMS(u_h − P u_2h).
#include <drumhead/multigrid/warp.h>

#include "newton.h"

namespace drumhead::multigrid {

/// Exact rows: kappa of the first state, from which it grows (exact_rows.h).
inline constexpr double kFirstKappa = 10.0;
// Steps (cycles) and ms without and with it, kappa 1e4: S2 100² 13 (59) 155, 6 (13) 47; 400² 14
// (38) 905, 5 (10) 271; S4 200² 19 (93) 389, 7 (14) 75. At kappa 100 S2 takes 9 % less, S4 7 %
// more. After the sweeps instead of before them S5 ends with 3 % more energy, and with a second one
// before the restriction S2 turned by 180° stalls.
/// From this kappa/mu on cycles of conforming cells relax all parts at once, too (part_patch.h),
/// but on the start level, where S5 then takes 60 steps and more (32²).
inline constexpr double kStiffParts = 300.0;

struct NestedOptions {
  Solver solver = Solver::gcr;
  bool exact = false;
  double tolerance_cells = 0.0;   ///< 0: a tenth of the estimated discretisation error
  double smallest_feature = 0.0;  ///< extent of the smallest curve in finest cells
  /// Discretisation error of a level, as a share of what it changes in the interpolated solution of
  /// the coarser one.
  double discretisation_share = kErrorOfChange;
  bool tips = false;  ///< of conforming cells: curves end within the lattice
  /// Gives level `start` and, where they need them, coarser ones the targets at share t of a load
  /// path; 1: the targets themselves. Empty: no path is needed.
  std::function<void(int start, double t)> set_targets;
  /// Exact rows: sets 1/kappa of all levels as if no cell had more than `most`, and the largest
  /// kappa that there is.
  std::function<void(double most)> limit_kappa;
  double largest_kappa = 0.0;
  std::function<bool(const Progress&)> progress;
};

/// The steps of one level, their moves in pixels.
LevelReport in_pixels(int nx, int ny, std::vector<NewtonStep> steps, double cell_px);

/// Errors and volume_gap as unknown, not a number.
void forget_errors(SolveReport& report);

/// Solves on all levels of the hierarchy from zero; fills status, levels and errors of the report
/// (converted to pixels by cell_px). The state is left in hierarchy[0].
template <class T>
void nested_iteration(Hierarchy<T>& hierarchy, const NestedOptions& options, double cell_px,
                      grid::MemoryMeter& meter, SolveReport& report);

}  // namespace drumhead::multigrid
