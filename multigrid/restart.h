// SPDX-License-Identifier: MIT
#pragma once
// Going on from an earlier solution: a curve that was dragged a little, or let go, needs a few
// Newton steps on the finest lattice instead of the nested iteration (Setaluri et al. 2014, Figure
// 5: deformations recover smoothly once the constraints are lifted).
#include <drumhead/multigrid/warp.h>

#include "nested.h"

namespace drumhead::multigrid {

/// Throws std::invalid_argument, naming value and bound, where `start` is not a finite solution on
/// this lattice.
void check_start(const Solution& start, const grid::Lattice& lattice);

/// Forces that the curves of `cuts` exert at the finest level's state, cell by cell.
template <class T>
std::vector<CurveForce> curve_forces(const Hierarchy<T>& hierarchy, const grid::CutCells& cuts);

/// Newton on the finest level from `start`, whose forces are taken over where the same cell is cut.
/// True if it was cancelled, or converged: to options.tolerance_cells or, if that is 0, to a tenth
/// of the start's discretisation error. Otherwise the state is zero again and nothing is reported.
template <class T>
bool continue_iteration(Hierarchy<T>& hierarchy, const grid::CutCells& cuts, const Solution& start,
                        const NestedOptions& options, grid::MemoryMeter& meter,
                        SolveReport& report);

}  // namespace drumhead::multigrid
