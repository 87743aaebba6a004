// SPDX-License-Identifier: MIT
#pragma once
// Scenes that try the whole solver, each with the outcome that is expected of averaged curves: what
// the tests assert and bench/stability_bench tabulates.
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <drumhead/multigrid/warp.h>

namespace drumhead::scenes {

struct HardCase {
  std::string group, name;
  multigrid::WarpProblem problem;
  multigrid::Status status = multigrid::Status::converged;
  int most_steps = 0;  ///< Newton's, on the finest lattice; about twice what was found
  /// Least energy found on 32² cells with exact rows, 0: unknown. A finer lattice has less.
  double energy_at_32 = 0.0;
  /// Whether that energy is of the only minimum there is, as far as all searches found: kappa up to
  /// 100, turns up to 135 degrees, no curves that ask for a fold.
  bool unique = false;
  double most_gap_px = std::numeric_limits<double>::infinity();  ///< of any curve
};
inline void PrintTo(const HardCase& c, std::ostream* out) { *out << c.name; }

/// Curves on grid lines, through corners of cells, doubled, in conflict, crossing, shorter than a
/// cell, into the fixed boundary; pictures and lattices of the smallest sizes.
std::vector<HardCase> degenerate_cases();

/// The 31 cases of the study: six scenes at kappa/mu 1, 10, 100, 1e4 and infinity, and S3 with its
/// mask, on n × n cells, curves at offset 0.
std::vector<HardCase> study_cases(int n);

}  // namespace drumhead::scenes
