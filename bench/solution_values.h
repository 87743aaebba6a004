// SPDX-License-Identifier: MIT
#pragma once
// What a solve has cost and reached, as the values of a row (results.h); scenes on the unit square
// are taken as pictures of 1000 px.
#include <algorithm>
#include <cmath>

#include <drumhead/multigrid/warp.h>

#include "results.h"

namespace drumhead::bench {

inline constexpr double kPicture = 1000.0;  // px of the unit square

/// Appends b's members to a's.
inline Json joined(Json a, const Json& b) {
  a.update(b);
  return a;
}

inline double seconds_of(const multigrid::Solution& solution) {
  return solution.report.cut_seconds + solution.report.solve_seconds;
}

/// Status, cost and errors of `solution`; the work units are those of `seconds_of` it.
inline Json values_of(const multigrid::Solution& solution) {
  const multigrid::SolveReport& report = solution.report;
  std::size_t steps = 0;
  for (const multigrid::LevelReport& level : report.levels) steps += level.newton.size();
  int cycles = 0;
  for (const multigrid::NewtonStep& step : report.levels.back().newton) cycles += step.krylov;
  double squares = 0.0, gap_max = 0.0, length = 0.0;
  for (const multigrid::CurveReport& curve : report.curves) {
    squares += curve.length_px * curve.gap_rms_px * curve.gap_rms_px;
    length += curve.length_px;
    gap_max = std::max(gap_max, curve.gap_max_px);
  }
  const double nodes = double(solution.lattice.nodes());
  return {{"status", multigrid::name(report.status)},
          {"seconds", seconds_of(solution)},
          {"cut_seconds", report.cut_seconds},
          {"work_units", report.work_units},
          {"product_ns", 1e9 * report.work_unit_seconds / nodes},
          {"newton", report.levels.back().newton.size()},
          {"newton_all", steps},
          {"cycles", cycles},
          {"bytes", report.solver_bytes},
          {"bytes_per_node", double(report.solver_bytes) / nodes},
          {"gap_rms_px", kPicture * std::sqrt(squares / length)},
          {"gap_max_px", kPicture * gap_max},
          {"discretisation_px", kPicture * report.discretisation_rms_px},
          {"algebraic_share", report.algebraic_rms_px / report.discretisation_rms_px},
          {"inverted", report.folds.inverted_cells},
          {"folded", report.folds.folded_cells},
          {"least_corner_J", report.folds.min_corner_J}};
}

/// The scene and its kappa as keys of a row; a mask is named with the scene.
template <class Scene>
Json keys_of(const Scene& scene, double kappa) {
  if (scene.kappa_mask) return {{"scene", scene.name + " mask"}};
  return {{"scene", scene.name}, {"kappa", kappa}};
}

}  // namespace drumhead::bench
