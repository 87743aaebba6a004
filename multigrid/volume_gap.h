// SPDX-License-Identifier: MIT
#pragma once
// The algebraic error of areas at the end of Newton's method, and when it deserves a word.
#include <drumhead/multigrid/warp.h>

#include "level.h"

namespace drumhead::multigrid {

/// NewtonReport::volume_gap of a level at the state whose force its f holds, with Σ g² =
/// `squares` over its cells; shares below `enough`, or all if that is 0, are of the energy at rest,
/// which is h² `stiffness`.
template <class T>
double volume_gap(const Level<T>& level, double squares, double stiffness, double enough);

/// Σ mu over all cells.
template <class T>
double total_stiffness(const Level<T>& level);

/// Says so where areas could not be had.
void note_areas(SolveReport& report);

}  // namespace drumhead::multigrid
