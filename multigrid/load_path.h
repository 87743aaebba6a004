// SPDX-License-Identifier: MIT
#pragma once
// The way to large rotations: beyond about 100 degrees the harmonic start has collapsed, so the
// curves are carried to their targets in steps, each turned by a growing share of its own angle
// (Procrustes) and interpolated linearly for the rest.
#include <vector>

#include <drumhead/grid/curve.h>

namespace drumhead::multigrid {

/// Largest of the angles, in radians, that best turn sources to targets (least squares over arc
/// length, about the centroids). With turn_degrees ≠ 0 it is the equivalent angle closest to that.
double largest_turn(const std::vector<grid::CurvePair>& curves);

/// Centroids and best rotation of a matched pair.
struct Motion {
  grid::Point source, target;
  double angle = 0.0;
};

/// The way of curves to their targets. `curves`: such as grid::check lets pass.
class LoadPath {
 public:
  explicit LoadPath(const std::vector<grid::CurvePair>& curves);
  /// The curves, matched (grid::matched), with targets at share t of the way, 0…1; at 1 the targets
  /// themselves. Valid until the next call, at 1 as long as the path is.
  const std::vector<grid::CurvePair>& at(double t);

 private:
  std::vector<grid::CurvePair> curves_, part_;
  std::vector<Motion> motions_;
};

}  // namespace drumhead::multigrid
