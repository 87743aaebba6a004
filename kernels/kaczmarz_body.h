// SPDX-License-Identifier: MIT
#pragma once
// Rows of Kaczmarz's method on the volume rows, and the balance of the rows.
#include <drumhead/kernels/kaczmarz.h>

#include "kaczmarz_nodes_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// Keeps the norm of a volume row positive in a cell that has collapsed to a point, per cell area.
template <class T>
constexpr T kCollapsed = T(1e-6);

/// The volume rows of the cells of one parity in row j.
template <class T>
struct VolumeRows {
  CellStencil<T> stencil;
  CellCompliance<T> compliance;
  Corners<T> x, y;
  const T *f, *alpha2;
  T* p;
  T omega, floor, south, north;
  int parity, last, count;

  VolumeRows(const KaczmarzSystem<T>& s, int parity_, int j)
      : stencil(s.level.membrane, j, parity_),
        compliance(s.level.membrane, j, parity_),
        x(s.level.d.x, j, parity_),
        y(s.level.d.y, j, parity_),
        f(s.level.f.p.half(j, parity_)),
        alpha2(s.alpha2.half(j, parity_)),
        p(s.level.d.p.half(j, parity_)),
        omega(s.omega),
        floor(kCollapsed<T> * s.level.membrane.spacing * s.level.membrane.spacing),
        south(T(j > 0)),
        north(T(j + 1 < s.level.d.p.rows)),
        parity(parity_),
        last(s.level.d.p.columns - 1),
        count(half_count(last + 1, parity_)) {}

  /// body(lane, zero, west, east, k) for all cells; west, east: 0 where that side is fixed.
  template <class F>
  void for_cells(F&& body) const {
    const int first = parity == 0 ? 1 : 0, end = (last & 1) == parity ? count - 1 : count;
    if (first == 1 && count > 0) single(0, body);
    for_lanes<T>(first, end, [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      body(lane, zero, B(T(1)), B(T(1)), k);
    });
    if (end < count && end >= first) single(end, body);
  }
  template <class F>
  void single(int k, F&& body) const {
    const int i = 2 * k + parity;
    body(Lane<T>{}, T(0), T(i > 0), T(i < last), k);
  }

  /// delta = omega residual/|row|² where the residual row is taken as B d − (A/kappa) dP.
  template <class L, class B>
  B delta(L lane, B zero, B west, B east, int k) const {
    B d1x, d1y, d2x, d2y, e1x, e1y, e2x, e2y;
    stencil.cell_diagonals(lane, zero, k, d1x, d1y, d2x, d2y);
    e1x = lane.load(x.n11 + k) - lane.load(x.n00 + k);
    e1y = lane.load(y.n11 + k) - lane.load(y.n00 + k);
    e2x = lane.load(x.n01 + k) - lane.load(x.n10 + k);
    e2y = lane.load(y.n01 + k) - lane.load(y.n10 + k);
    const B c = compliance(lane, zero, k);
    const B product = B(T(0.5)) * ((d1x * e2y - d1y * e2x) + (e1x * d2y - e1y * d2x));
    const B r = lane.load(f + k) - (product - c * lane.load(p + k));
    const B free2 = east * B(north) + west * B(south), free1 = west * B(north) + east * B(south);
    const B norm2 =
        B(T(0.25)) * ((d2x * d2x + d2y * d2y) * free2 + (d1x * d1x + d1y * d1y) * free1);
    return B(omega) * r / (norm2 + (lane.load(alpha2 + k) * c) * c + B(floor));
  }

  /// S⁻¹ d += delta a.
  template <class L, class B>
  void move(L lane, B zero, B west, B east, int k) const {
    const B v = delta(lane, zero, west, east, k);
    B d1x, d1y, d2x, d2y;
    stencil.cell_diagonals(lane, zero, k, d1x, d1y, d2x, d2y);
    const B half_v = B(T(0.5)) * v;
    const B v00 = half_v * (west * B(south)), v10 = half_v * (east * B(south)),
            v01 = half_v * (west * B(north)), v11 = half_v * (east * B(north));
    const auto add = [&](T* at, B value) { lane.store(lane.load(at) + value, at); };
    add(x.n11 + k, d2y * v11);
    add(y.n11 + k, zero - d2x * v11);
    add(x.n00 + k, zero - d2y * v00);
    add(y.n00 + k, d2x * v00);
    add(x.n01 + k, zero - d1y * v01);
    add(y.n01 + k, d1x * v01);
    add(x.n10 + k, d1y * v10);
    add(y.n10 + k, zero - d1x * v10);
    add(p + k, zero - (lane.load(alpha2 + k) * compliance(lane, zero, k)) * v);
  }
};

/// Gauss–Seidel over the volume rows of one parity in row j; they share no node.
template <class T>
[[gnu::flatten]] void kaczmarz_cells_row(const KaczmarzSystem<T>& system, Reach reach, int parity,
                                         int j) {
  const VolumeRows<T> rows(system, parity, j);
  const auto move = [&](auto lane, auto zero, auto west, auto east, int k) {
    rows.move(lane, zero, west, east, k);
  };
  if (reach == Reach::everywhere) {
    rows.for_cells(move);
    return;
  }
  const Cuts<T>& cuts = system.level.cuts;
  for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k)
    if ((cuts.column[k] & 1) == parity) rows.single(cuts.column[k] >> 1, move);
}

/// e = −omega residual/|row|² of the volume rows of row j.
template <class T>
[[gnu::flatten]] void jacobi_cells_row(const KaczmarzSystem<T>& system, const Unknowns<T>& e,
                                       int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const VolumeRows<T> rows(system, parity, j);
    T* out = e.p.half(j, parity);
    rows.for_cells([&](auto lane, auto zero, auto west, auto east, int k) {
      lane.store(zero - rows.delta(lane, zero, west, east, k), out + k);
    });
  }
}

/// dP −= α² (B e − (A/kappa) e_P) in the cells of row j.
template <class T>
[[gnu::flatten]] void jacobi_pressures_row(const KaczmarzSystem<T>& system,
                                           const Unknowns<const T>& e, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const CellStencil<T> stencil(system.level.membrane, j, parity);
    const CellCompliance<T> compliance(system.level.membrane, j, parity);
    const Corners<const T> x(e.x, j, parity), y(e.y, j, parity);
    const T *ep = e.p.half(j, parity), *alpha2 = system.alpha2.half(j, parity);
    T* p = system.level.d.p.half(j, parity);
    for_lanes<T>(0, half_count(e.p.columns, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      B d1x, d1y, d2x, d2y, e1x, e1y, e2x, e2y;
      stencil.cell_diagonals(lane, zero, k, d1x, d1y, d2x, d2y);
      correction_diagonals(lane, zero, x, y, k, e1x, e1y, e2x, e2y);
      const B product = B(T(0.5)) * ((d1x * e2y - d1y * e2x) + (e1x * d2y - e1y * d2x)) -
                        compliance(lane, zero, k) * lane.load(ep + k);
      lane.store(lane.load(p + k) - lane.load(alpha2 + k) * product, p + k);
    });
  }
}

/// α² = 20 mu²/(h² |F|²) of the cells of row j; h² |F|² = (|d1|² + |d2|²)/2.
template <class T>
[[gnu::flatten]] void balance_cells_row(const Membrane<T>& m, const Plane<T>& alpha2, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const CellStencil<T> stencil(m, j, parity);
    const T* mu_cells = m.mu.cells ? m.mu.cells.half(j, parity) : nullptr;
    T* out = alpha2.half(j, parity);
    for_lanes<T>(0, half_count(alpha2.columns, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      B d1x, d1y, d2x, d2y, mu(m.mu.value);
      stencil.cell_diagonals(lane, zero, k, d1x, d1y, d2x, d2y);
      if (mu_cells) mu = lane.load(mu_cells + k);
      const B norm2 = B(T(0.5)) * ((d1x * d1x + d1y * d1y) + (d2x * d2x + d2y * d2y));
      const B floor(kCollapsed<T> * m.spacing * m.spacing);
      lane.store(B(T(20)) * (mu * mu) / (norm2 + floor), out + k);
    });
  }
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
