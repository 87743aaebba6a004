// SPDX-License-Identifier: MIT
#pragma once
// Eq. 8 with a large kappa (Setaluri et al. 2014), and fold-free's corners, as a row of easy
// problems: corners soft and their resistance gradual at first, then stiffer and sharper, each time
// the state has followed; from 300 mu on a step of the method of multipliers each time. For an
// inequality those wait for a state without folds: in others pressures would run away; fold-free's
// corners become still stiffer there. So Newton's method need not find out corner by corner which
// of them resist, and few linear systems see stiff ones.
#include "level.h"

namespace drumhead::multigrid {

/// kappa from which Eq. 8 stands for an inequality: a solution has no folds.
inline constexpr double kAsInequality = 1e3;

template <class T>
class Corners {
 public:
  /// Of a level; takes its law back to soft corners that keep their pressures. `onset`: the one to
  /// end with, in J. Does nothing where the law has no relief.
  Corners(Level<T>& level, double onset);

  /// Whether there is a row of problems at all.
  bool act() const { return level_.solid.law.relief > T(0); }
  /// Whether the state, whose force has this norm, has followed the last move.
  bool followed(double norm) const { return norm < kFollowed * moved_norm_; }
  /// The next problem; `norm` of its force is told by `moved_to`.
  void move();
  void moved_to(double norm) { moved_norm_ = norm; }
  /// Whether the last problem is at hand: whatever moves now are pressures.
  bool last() const;
  /// Whether the state is as free of folds as kappa asks for.
  bool unfolded() const { return !inequality() || least_J() > 0.0; }

 private:
  static constexpr double kFollowed = 0.3;

  void soften(double relief);
  bool inequality() const {
    const kernels::Law<T>& law = level_.solid.law;
    return double(law.corner > T(0) ? law.corner : law.kappa.value) >= kAsInequality;
  }
  double least_J() const;

  Level<T>& level_;
  double onset_ = 0.0, moved_norm_ = 0.0;
};

}  // namespace drumhead::multigrid
