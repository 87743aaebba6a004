// SPDX-License-Identifier: MIT
// What a scene asks of the solver: the measures of its material and curves that decide the way it
// is solved.
#pragma once

#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

/// The material the default path solves: kappa capped at 1e4 mu, with a note. Models that know no
/// pressure take kappa as it is.
grid::Material capped(const grid::Material& material, SolveReport& report);

/// In units of the scene's mu: a curve must be hard where the membrane is stiffest, too.
double largest_mu(const grid::Material& material);

/// In units of the scene's mu.
double largest_kappa(const grid::Material& material);

bool has_pressure(const grid::Material& material);

/// Whether a curve ends within the lattice: solutions are singular there.
bool has_tips(const WarpProblem& problem);

/// Extent of the smallest source curve, in cells.
double smallest_feature(const WarpProblem& problem);

}  // namespace drumhead::multigrid
