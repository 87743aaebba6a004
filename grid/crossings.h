// SPDX-License-Identifier: MIT
#pragma once
// Where a Bézier crosses the lines of the lattice.
#include <vector>

#include <drumhead/grid/curve.h>
#include <drumhead/grid/lattice.h>

namespace drumhead::grid {

/// Distance in cells under which a point counts as lying on a line of the lattice.
constexpr double kSnap = 1e-9;

/// Parameters in (0, 1), ascending, at which a curve in cell units meets an integer x or y. Points
/// within 1e-9 of a line count as on it and yield no crossing on their own.
void find_crossings(const CubicBezier& curve, std::vector<double>& out);

/// Cell of a coordinate, 0…n−1: points on a line belong to the cell of larger index.
int cell_index(double x, int n);

/// Throws std::invalid_argument: the source leaves the lattice at a point given in cells.
[[noreturn]] void refuse_outside(const CurvePair& curve, Point cells, const Lattice& lattice);

/// Appends the parameters in (0, 1) at which x or y turns back: x' = 0 or y' = 0.
void add_turning_points(const CubicBezier& curve, std::vector<double>& out);

}  // namespace drumhead::grid
