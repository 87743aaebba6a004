// SPDX-License-Identifier: MIT
#pragma once
// What a level of an isotropic membrane (kernels/model.h) has in place of pressures: the law and
// its fields, the blocks of the Hessian's diagonal, and room for a Hessian product.
#include <drumhead/grid/field.h>
#include <drumhead/kernels/relax.h>

namespace drumhead::multigrid {

/// neohookean: the J below which ln J is a parabola at first; Newton lowers it.
inline constexpr double kFirstFloor = 0.1;

template <class T>
struct Solid {
  kernels::Law<T> law;  ///< its views are filled by `view`
  grid::Field<T> kappa;
  grid::Field<T> shift[4];
  grid::Field<T> block[3];
  grid::Field<T> tangent;  ///< of levels below the finest: mean of the finer cells'
  bool averaged = false;   ///< whether the level's operator is made of it
  grid::UnknownFields<T> product;
  T largest = T(2);  ///< eigenvalue of D⁻¹ H

  Solid() = default;
  Solid(int nx, int ny, grid::MemoryMeter& meter) : product(nx, ny, false, meter) {
    for (grid::Field<T>& b : block) b = grid::Field<T>(nx + 1, ny + 1, meter);
  }

  /// Sets the parts of a membrane that are of the law.
  void view(kernels::Membrane<T>& m) const {
    m.law = law;
    m.law.kappa.cells = kappa.view();
    for (int n = 0; n < 4; ++n) m.law.shift[n] = shift[n].view();
    for (int n = 0; n < 3; ++n) m.inverse_block[n] = block[n].view();
    if (averaged) m.tangent = tangent.view();
  }
};

}  // namespace drumhead::multigrid
