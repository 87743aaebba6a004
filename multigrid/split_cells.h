// SPDX-License-Identifier: MIT
#pragma once
#include <drumhead/grid/conforming.h>
#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

/// Sets solution.split from conforming cells and the displacements of their curve nodes. On entry
/// u_px, v_px are the displacements of the nodes from their own rest positions, moved or not; on
/// return those of the points that rest at the lattice's places.
void set_split_cells(const grid::ConformingCells& cells,
                     const std::vector<grid::Point>& curve_displacement_px, Solution& solution);

}  // namespace drumhead::multigrid
