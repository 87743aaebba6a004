// SPDX-License-Identifier: MIT
#pragma once
// The discretisation error of conforming cells from what two levels say of the nodes that both
// have: for an error of order p, u_h − u ≈ (u_h − u_2h) / (2^p − 1). Nodes that curves hold are
// left out: their places differ by level. (What Newton changes in the interpolated start, which
// estimates the error of averaged rows, holds the error of the interpolation too, and is 1.5 to 2.5
// times as much.)
#include <cmath>
#include <limits>
#include <optional>
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

/// Estimates the discretisation error of one level after another.
class ErrorEstimate {
 public:
  /// `of_moves`: of a level that nothing more is known of, as a share of what its steps move;
  /// `compares`: conforming cells, whose levels are told what they say otherwise; `tips`: see
  /// error_share().
  ErrorEstimate(double of_moves, bool compares, bool tips)
      : of_moves_(of_moves),
        of_next_(compares && !tips ? kChangeOfMoves * of_moves : of_moves),
        tips_(tips) {}

  /// The next level's, before it is known, as a share of what its steps move.
  double of_next_moves() const { return of_next_; }

  /// Of a level whose steps moved so much, finest cells; not a number for the `start` level.
  LevelChange of(const LevelChange& moves, bool start, const std::optional<LevelChange>& change) {
    if (!change) return times(start ? std::numeric_limits<double>::quiet_NaN() : of_moves_, moves);
    changes_.push_back(*change);
    const double share = error_share(tips_, changes_);
    if (moves.rms > 0.0) of_next_ = share * change->rms / moves.rms;
    return times(share, *change);
  }

 private:
  // What a level says otherwise than the one before, as a share of what its steps move, where no
  // curve ends: S2 .73, S4 .57. With 1 instead, and for all levels, runs ended with .07 to .15 of
  // the discretisation error, means of six offsets; so with .03 to .14, in 1.0 to 1.14 of the time.
  static constexpr double kChangeOfMoves = 0.6;
  static LevelChange times(double share, const LevelChange& change) {
    return {share * change.rms, share * change.max};
  }
  double of_moves_, of_next_;
  bool tips_;
  std::vector<LevelChange> changes_;
};

}  // namespace drumhead::multigrid
