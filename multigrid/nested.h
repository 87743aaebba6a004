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
