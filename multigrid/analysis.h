// SPDX-License-Identifier: MIT
#pragma once
// What the report says about a finished lattice: curve gaps and folds. Done once, off the solver's
// clock.
#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

/// Distance warped source – target along each curve, at about four points per cell.
std::vector<CurveReport> curve_gaps(const Solution& solution,
                                    const std::vector<grid::CurvePair>& curves);

/// Cells with J* < 0, cells with a corner J < 0, the least of both and where they are.
FoldReport find_folds(const Solution& solution);

}  // namespace drumhead::multigrid
