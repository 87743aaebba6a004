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

/// The curves with targets of as many segments as their sources (grid::matched).
std::vector<grid::CurvePair> one_to_one(const std::vector<grid::CurvePair>& curves);

/// The curves with targets at share t of the way, 0…1; at 1 the targets themselves.
std::vector<grid::CurvePair> partway(const std::vector<grid::CurvePair>& curves, double t);

}  // namespace drumhead::multigrid
