// SPDX-License-Identifier: MIT
#pragma once
// What the options say about the curves of a drawing, and what the lattice demands of them.
#include <drumhead/grid/lattice.h>
#include <vector>

#include "options.h"
#include "svg_curves.h"

namespace drumhead::driver {

/// The pairs with their weights and turns: --weight for pairs (pins stay exactly hard), then the
/// scene's
/// [[curve]] tables, whose name is a pair's or that of all its subpaths.
/// Throws std::invalid_argument naming file and line of a table whose curve the drawing does not
/// have.
std::vector<grid::CurvePair> apply_settings(const Options& options,
                                            const std::vector<SvgCurve>& curves);

/// Throws std::invalid_argument naming the curve, its outermost point and the lattice's extent
/// where a source leaves the lattice. Targets may.
void check_inside(const grid::Lattice& lattice, const std::vector<SvgCurve>& curves);

}  // namespace drumhead::driver
