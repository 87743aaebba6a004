// SPDX-License-Identifier: MIT
#pragma once
// What a caller hears of a solve while it lasts, and how it stops it.
#include <cmath>
#include <functional>
#include <utility>

#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

/// Asked before each Newton step of a level: step from 1, share 0…1 of the level that is done,
/// below 1; false: stop.
using LevelProgress = std::function<bool(int step, double share)>;

/// The part of a level's progress from one share to another.
inline LevelProgress part_of(const LevelProgress& whole, double from, double to) {
  if (!whole) return {};
  return [=](int step, double share) { return whole(step, from + (to - from) * share); };
}

/// That of level `l` of a nested iteration that begins on level `start`. Work falls by four from
/// level to level.
inline LevelProgress level_progress(const std::function<bool(const Progress&)>& tell, int nx,
                                    int ny, int l, int start) {
  if (!tell) return {};
  const double least = std::pow(0.25, start + 1);
  const auto share_before = [=](int k) { return (std::pow(0.25, k + 1) - least) / (1.0 - least); };
  const double from = share_before(l), to = share_before(l - 1);
  return [=](int step, double share) { return tell({nx, ny, step, from + (to - from) * share}); };
}

/// Stands between the solver and SolverOptions::progress. A fraction that falls belongs to a solve
/// begun anew (where a start was of no use, or with averaged rows), which takes what was left. Once
/// told to stop, it does not ask again.
class ProgressLine {
 public:
  explicit ProgressLine(std::function<bool(const Progress&)> tell) : tell_(std::move(tell)) {}

  bool operator()(Progress at) {
    if (stopped_) return false;
    if (at.fraction < before_) begin_ = told_;
    before_ = at.fraction;
    told_ = at.fraction = begin_ + (1.0 - begin_) * at.fraction;
    stopped_ = !tell_(at);
    return !stopped_;
  }

 private:
  std::function<bool(const Progress&)> tell_;
  double begin_ = 0.0, before_ = 0.0, told_ = 0.0;
  bool stopped_ = false;
};

}  // namespace drumhead::multigrid
