// SPDX-License-Identifier: MIT
#pragma once
// Which way a scene's curves are met.
#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

/// What `options.curve_method` means for this scene: automatic is conforming where that is
/// possible, and otherwise, or where exact curves are asked for, averaged, the paper's way. (The
/// study's 31 cases all converge with conforming cells on 32² and 128²; where one does not, solve()
/// takes averaged rows.) A start goes on by its own method where that is possible. Throws
/// std::invalid_argument where conforming is asked for and not possible.
CurveMethod chosen_method(const WarpProblem& problem, const SolverOptions& options);

}  // namespace drumhead::multigrid
