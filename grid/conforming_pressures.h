// SPDX-License-Identifier: MIT
#pragma once
#include <drumhead/grid/conforming.h>

namespace drumhead::grid {

/// Gives every part its pressure unknown: its own, or for parts smaller than `least_area` that of
/// the largest part across a side of the cell (which is on the same side of all chords).
void share_pressures(ConformingCells& cells, double least_area);

}  // namespace drumhead::grid
