// SPDX-License-Identifier: MIT
// What a user should hear about a solution besides its numbers.
#pragma once

#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

/// Says which hard curves miss their targets visibly: the rows of a cell hold on average only,
/// curves in one cell share a row, and a fixed edge or a stay too short for the lattice cannot
/// follow. Expects `report.curves`.
void note_gaps(const WarpProblem& problem, SolveReport& report);

/// Where areas hold most of the energy: which closed hard curve's target changes its area most, so
/// that kappa can keep no area within. Expects `report.energy`.
void note_changed_area(const WarpProblem& problem, SolveReport& report);

/// What folds mean where a model rules them out (Eq. 8 as an inequality) or invites them. Expects
/// `report.folds`.
void note_folds(const grid::Material& material, SolveReport& report);

}  // namespace drumhead::multigrid
