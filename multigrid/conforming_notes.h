// SPDX-License-Identifier: MIT
#pragma once
// What curves and lattice could not agree on, in words for the report: targets that contradict one
// another, a target that moves the fixed edge, tips that hold no node, cells too full to be divided
// as their curves ask (rules 6 and 7 of grid/conforming.h). A kind of trouble has one sentence for
// every pair of curves, with its number and its worst or first place.
#include <string>
#include <vector>

#include <drumhead/grid/conforming.h>
#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

std::vector<std::string> conforming_notes(const grid::ConformingCells& cells,
                                          const WarpProblem& problem);

}  // namespace drumhead::multigrid
