// SPDX-License-Identifier: MIT
#pragma once
// The discretisation error of conforming cells from what two levels say of the nodes that both
// have: for an error of order p, u_h − u ≈ (u_h − u_2h) / (2^p − 1). Nodes that curves hold are
// left out: their places differ by level. (What Newton changes in the interpolated start, which
// estimates the error of averaged rows, holds the error of the interpolation too, and is 1.5 to 2.5
// times as much.)
#include <cmath>
#include <vector>

#include "level.h"

namespace drumhead::multigrid {

/// In finest cells.
struct LevelChange {
  double rms = 0.0, max = 0.0;
};

/// The displacements of a level, kept while the next finer one is solved.
template <class T>
class LevelCopy {
 public:
  explicit LevelCopy(const Level<T>& level, grid::MemoryMeter& meter);
  /// What the next finer level, solved by now, says otherwise.
  LevelChange change(const Level<T>& coarse, const Level<T>& fine) const;

 private:
  grid::Field<T> ux_, uy_;
};

/// Error as a share of the last change: `tips`: whether curves end within the lattice. Those make
/// the order 1 (S1 kappa/mu 1: 0.9 to 1.1 of the truth) unless the change before that says
/// otherwise; without them it is 2 (S2, S4: 0.7 to 1.2).
inline double error_share(bool tips, const std::vector<LevelChange>& changes) {
  if (!tips) return 1.0 / 3.0;
  if (changes.size() < 2 || !(changes.back().rms > 0.0)) return 1.0;
  const double gain = changes[changes.size() - 2].rms / changes.back().rms;  // 2^p
  return 1.0 / (std::fmin(std::fmax(gain, 2.0), 4.0) - 1.0);
}

}  // namespace drumhead::multigrid
