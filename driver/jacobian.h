// SPDX-License-Identifier: MIT
#pragma once
// det J of the membrane, J = ∂(warped)/∂(rest), as pictures show it: 1 where a warp keeps areas,
// less where it compresses, below 0 where it turns the membrane over. The one place that knows
// which value a point of a cell has.
#include <drumhead/kernels/resample.h>
#include <drumhead/multigrid/warp.h>

namespace drumhead::driver {

class JacobianField {
 public:
  /// `solution` must outlive it.
  explicit JacobianField(const multigrid::Solution& solution) : solution_(solution) {}

  /// det J of the cell that holds a rest position, taken at the cell's centre as the membrane's
  /// energy takes it (Eq. 7); 1 outside the lattice, where nothing moves.
  double at(kernels::Position rest_px) const;

  /// Whether det J < 0 somewhere in cell (i, j), that is at one of its corners.
  bool folded(int i, int j) const;

 private:
  struct Edges {
    kernels::Position south, north, west, east;
  };
  Edges edges(int i, int j) const;

  const multigrid::Solution& solution_;
};

}  // namespace drumhead::driver
