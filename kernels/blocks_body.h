// SPDX-License-Identifier: MIT
#pragma once
// Rows of the relaxation of isotropic membranes: the 2×2 blocks of the Hessian's diagonal, and the
// corner pressures.
#include "isotropic_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// Node row j of the blocks (xx, xy, yy) → their inverses. A node that nothing holds gets 1e-4 mu.
template <class T>
[[gnu::flatten]] void invert_blocks_row(T mu, const Plane<T>* block, int j) {
  const T least = T(1e-4) * mu;
  for (int parity = 0; parity < 2; ++parity) {
    const Range range = interior(block[0].columns, parity);
    T *xx = block[0].half(j, parity), *xy = block[1].half(j, parity),
      *yy = block[2].half(j, parity);
    for_lanes<T>(range.begin, range.end, [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const B a = lane.load(xx + k) + B(least), b = lane.load(xy + k),
              c = lane.load(yy + k) + B(least);
      const B one(T(1)), inverse = one / larger(a * c - b * b, B(least * least));
      lane.store(c * inverse, xx + k);
      lane.store(zero - b * inverse, xy + k);
      lane.store(a * inverse, yy + k);
    });
  }
}

/// Node row j of d += omega D⁻¹ (f − product).
template <class T>
[[gnu::flatten]] void block_step_row(const Plane<const T>* inverse, T omega,
                                     const Unknowns<const T>& f, const Unknowns<const T>& product,
                                     const Unknowns<T>& d, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const Range range = interior(d.x.columns, parity);
    const T *xx = inverse[0].half(j, parity), *xy = inverse[1].half(j, parity),
            *yy = inverse[2].half(j, parity);
    const T *fx = f.x.half(j, parity), *fy = f.y.half(j, parity);
    const T *px = product.x.half(j, parity), *py = product.y.half(j, parity);
    T *dx = d.x.half(j, parity), *dy = d.y.half(j, parity);
    for_lanes<T>(range.begin, range.end, [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const B rx = lane.load(fx + k) - lane.load(px + k),
              ry = lane.load(fy + k) - lane.load(py + k);
      const B w(omega), b = lane.load(xy + k);
      lane.store(lane.load(dx + k) + w * (lane.load(xx + k) * rx + b * ry), dx + k);
      lane.store(lane.load(dy + k) + w * (b * rx + lane.load(yy + k) * ry), dy + k);
    });
  }
}

/// Cell row j: the corner pressures at the state over relief, into shift (which the membrane may
/// read).
template <class T>
[[gnu::flatten]] void corner_pressure_row(const Membrane<T>& m, const Plane<T>* shift, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const CellReader<T> reader(m, j, parity);
    T* out[4];
    for (int n = 0; n < 4; ++n) out[n] = shift[n].half(j, parity);
    for_lanes<T>(0, half_count(m.ux.columns - 1, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const CellState<T, B> cell = reader.read(lane, zero, k);
      for (int n = 0; n < 4; ++n) {
        const Split<B> f = cell.at(T(n & 1), T(n >> 1));
        const B J = B(T(0.25)) * ((f.a1 * f.a1 + f.a2 * f.a2) - (f.b1 * f.b1 + f.b2 * f.b2));
        const OneSidedSquare<T, B> square(J - cell.c.eps + cell.shift[n], cell.c.onset);
        lane.store(cell.c.corner * B(T(1) / m.law.relief) * square.slope, out[n] + k);
      }
    });
  }
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
