// SPDX-License-Identifier: MIT
#pragma once
// All unknowns of the finest level beside its curves, solved at once: nodes, pressures and curve
// forces of the cells within kReach of a cut one, for the Newton system as it is, its clamp wide
// open and its rows without the jump. Where rows are exact, cycles leave modes of q that hardly
// move a node (zigzag along straight lines, short arcs), and pressures there exceed mu by far, so
// that a definite cycle is of another system; both decay within a cell or two from the curve.
// A cycle for the system with its jump, between two solutions of the strip, then leaves as much as
// with averaged rows: S2, kappa 1e4, 256², to 1e-3: 18 cycles; with the curve rows and the volume
// rows about them as one block of every level's relaxation, 48.
#include <memory>

#include "newton_system.h"

namespace drumhead::multigrid {

/// From so many nodes on exact rows are solved so, with few of GCR's directions; smaller lattices
/// can afford hundreds, and with those and curve_patch.h instead S5, kappa 1e4, 128², takes 222
/// Newton steps; with the strip and 8 or 20 directions it ends with `limit` after 400.
inline constexpr std::size_t kStripNodes = 30000;

template <class T>
class CurveStrip {
 public:
  /// Factorises the strip's equations at the system's state.
  explicit CurveStrip(const NewtonSystem<T>& system);
  ~CurveStrip();
  CurveStrip(CurveStrip&&) noexcept;

  /// x += the solution for r of the strip's equations, all else held.
  void add_solution(const Vector<T>& r, Vector<T>& x);

 private:
  struct Block;
  std::unique_ptr<Block> block_;
};

}  // namespace drumhead::multigrid
