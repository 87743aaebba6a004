// SPDX-License-Identifier: MIT
#pragma once
// The oracle's own cutting of curves by the lattice. A polyline makes everything exact: within a
// cell the bilinear weights are quadratic and the target is linear along a chord, so Simpson's rule
// integrates both without error. Lengths and positions are in cells, node (0, 0) at the origin.
#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scenes.h"

namespace drumhead::oracle {

/// The averaged constraint of one cell over all curves in it: sum_k weight[k] x_k = target, where
/// the corners k are 00, 10, 01, 11 (first index along x) and the weights sum to 1.
struct CutRow {
  int i = 0, j = 0;                  ///< the cell
  std::array<double, 4> weight{};    ///< means of the bilinear weights over the arcs in the cell
  Eigen::Vector2d target{0.0, 0.0};  ///< mean of the target over the same points
  double length = 0.0;               ///< of the arcs, in cells
};

struct Cuts {
  std::vector<CutRow> rows;  ///< in the order in which the curves first enter the cells
  /// Rows of cells that follow one another along a curve, smaller index first, each pair once: the
  /// pairs of the q-jump.
  std::vector<std::pair<int, int>> neighbours;
};

/// A point within this distance of a lattice line (in cells) is moved onto it.
inline constexpr double kSnapCells = 1e-9;
/// An arc that stays in one cell for less than this (in cells) is left out.
inline constexpr double kShortestArc = 1e-3;
/// A row whose weights on nodes off the fixed boundary sum to less than this is left out.
inline constexpr double kLeastInteriorWeight = 0.02;

/// Cuts the scene's polylines by an n × n lattice of the unit square.
Cuts cut(const scenes::Scene& scene, int n);

}  // namespace drumhead::oracle
