// SPDX-License-Identifier: MIT
#pragma once
// What exact curves (SolverOptions::exact) ask of Newton's method besides: a kappa that grows step
// by step on the level where the iteration starts, and on the finest level last steps until no node
// moves, with averaged rows without the q-jump. Conforming cells meet hard curves by construction;
// the same steps solve them to the same tolerance.
#include "curve_strip.h"
#include "nested.h"

namespace drumhead::multigrid {

/// A trace of the q-jump that stays in the preconditioner: S2 kappa 10, 32² takes 412, 270, 191,
/// 163, 231 cycles with .005, 5e-4, 5e-5, 1e-5, 0; kappa 100 1033, 669, 508, 491, 1147.
inline constexpr double kTraceOfJump = 5e-5;

/// Of the q-jump `inside`, what stays in the preconditioner of exact rows on this many nodes:
/// beside a strip (curve_strip.h) all of it. S2, kappa 1e4, 128², to 1e-3: 15 cycles with .005, 23
/// with .001, 27 with 5e-4, with 5e-5 it stalls.
inline double jump_kept(std::size_t nodes, double inside) {
  return nodes < kStripNodes ? kTraceOfJump : inside;
}

/// On the start level, with a harmonic state: Newton for ever larger kappa, all but the last. At
/// once, stiff scenes end in worse minima, or nowhere (S2 turned by 135°, kappa 1e4). Returns the
/// steps taken.
template <class T>
std::vector<NewtonStep> stiffen(const NestedOptions& options, NewtonOptions newton_options,
                                Newton<T>& newton, ClampSchedule& clamp,
                                const LevelProgress& progress);

/// On the finest level, from the solution `before`, whose steps and changes are counted, until no
/// node moves: averaged rows without the q-jump, conforming cells as they are. `linear`: the solver
/// and how its cycles relax. Where that does not converge, `notes` gets a statement of what is
/// left.
template <class T>
NewtonReport until_at_rest(Hierarchy<T>& hierarchy, const LinearOptions& linear, Newton<T>& newton,
                           const NewtonReport& before, const LevelProgress& progress,
                           double cell_px, std::vector<std::string>& notes);

}  // namespace drumhead::multigrid
