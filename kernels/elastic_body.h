// SPDX-License-Identifier: MIT
#pragma once
// Rows of the elastic kernels: product and residual at nodes alone, force.
#include "stencil.h"
#include "sums.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// Runs body(kPressure, kMuCells as std::bool_constant) for what the scene has.
template <class T, class F>
void with_scene(const Membrane<T>& m, F&& body) {
  using std::false_type, std::true_type;
  if (m.pressure) {
    if (m.mu.cells)
      body(true_type{}, true_type{});
    else
      body(true_type{}, false_type{});
  } else {
    if (m.mu.cells)
      body(false_type{}, true_type{});
    else
      body(false_type{}, false_type{});
  }
}

/// A/kappa of the cells of one parity in row j.
template <class T>
struct CellCompliance {
  T area, constant;
  const T* cells;
  CellCompliance(const Membrane<T>& m, int j, int parity)
      : area(m.spacing * m.spacing),
        constant(area * m.compliance.value),
        cells(m.compliance.cells ? m.compliance.cells.half(j, parity) : nullptr) {}
  template <class L, class B>
  B operator()(L lane, B, int k) const {
    return cells ? B(area) * lane.load(cells + k) : B(constant);
  }
};

/// Node row j of r = f − H d (kResidual) or of H d, without curve forces, node by node: where there
/// are no pressures, or volume rows are not wanted (otherwise linear_body.h).
template <bool kResidual, class T>
[[gnu::flatten]] void linear_nodes_row(const Membrane<T>& m, const Unknowns<const T>* f,
                                       const Unknowns<const T>& d, SplitRow<T> rx, SplitRow<T> ry,
                                       int j) {
  with_scene(m, [&](auto pressure, auto mu_cells) {
    for (int parity = 0; parity < 2; ++parity) {
      const NodeStencil<T, pressure.value, mu_cells.value> stencil(m, d, j, parity);
      const Range range = interior(d.x.columns, parity);
      T *out_x = rx.half[parity], *out_y = ry.half[parity];
      const T *fx = nullptr, *fy = nullptr;
      if constexpr (kResidual) {
        fx = f->x.half(j, parity);
        fy = f->y.half(j, parity);
      }
      for_lanes<T>(range.begin, range.end, [&](auto lane, auto zero, int k) {
        stencil.prefetch(k, 1);
        for (const T* at : {out_x, out_y}) ask(at + k + stencil.node_row);
        decltype(zero) hx, hy, inverse;
        stencil.apply(lane, zero, k, hx, hy, inverse);
        if constexpr (kResidual) {
          ask(fx + k + stencil.node_row);
          ask(fy + k + stencil.node_row);
          hx = lane.load(fx + k) - hx;
          hy = lane.load(fy + k) - hy;
        }
        lane.store(hx, out_x + k);
        lane.store(hy, out_y + k);
      });
    }
  });
}

/// Node row j of −(K x̂ + Bᵀ P): the elastic force, without curve forces.
template <class T>
[[gnu::flatten]] void force_nodes_row(const Membrane<T>& m, const Unknowns<T>& out, int j) {
  const Unknowns<const T> u{m.ux, m.uy, {}};
  with_scene(m, [&](auto pressure, auto mu_cells) {
    for (int parity = 0; parity < 2; ++parity) {
      const NodeStencil<T, false, mu_cells.value> stencil(m, u, j, parity);
      CellsAtNode<T> p;
      if constexpr (pressure.value) p = {m.pressure, j, parity};
      const Range range = interior(m.ux.columns, parity);
      T *fx = out.x.half(j, parity), *fy = out.y.half(j, parity);
      for_lanes<T>(range.begin, range.end, [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        B hx, hy, inverse;
        stencil.apply(lane, zero, k, hx, hy, inverse);
        if constexpr (mu_cells.value) {
          B w, e, s, n;
          stencil.edges(stencil.mu_around(lane, k), w, e, s, n);
          hx = hx + B(m.spacing) * (w - e);
          hy = hy + B(m.spacing) * (s - n);
        }
        if constexpr (pressure.value) {
          const EdgeWeights<B> weight = edge_weights(lane, zero, p, k);
          hx = hx + B(T(0.5)) * (around(lane, weight, stencil.dy, k) +
                                 B(m.spacing) * (weight.n - weight.s));
          hy = hy - B(T(0.5)) * (around(lane, weight, stencil.dx, k) +
                                 B(m.spacing) * (weight.e - weight.w));
        }
        lane.store(B(T(0)) - hx, fx + k);
        lane.store(B(T(0)) - hy, fy + k);
      });
    }
  });
}

/// A (J* − 1) of the cells at x̂ + t d, in a form that keeps the digits of small displacements.
template <class L, class B, class T>
B volume_change(L lane, B zero, const CellStencil<T>& stencil, const Corners<const T>& x,
                const Corners<const T>& y, B t, bool moved, int k) {
  const CellStencil<T>& s = stencil;
  B ax = lane.load(s.ux.n11 + k) - lane.load(s.ux.n00 + k);
  B ay = lane.load(s.uy.n11 + k) - lane.load(s.uy.n00 + k);
  B bx = lane.load(s.ux.n01 + k) - lane.load(s.ux.n10 + k);
  B by = lane.load(s.uy.n01 + k) - lane.load(s.uy.n10 + k);
  if (moved) {
    B e1x, e1y, e2x, e2y;
    correction_diagonals(lane, zero, x, y, k, e1x, e1y, e2x, e2y);
    ax = ax + t * e1x;
    ay = ay + t * e1y;
    bx = bx + t * e2x;
    by = by + t * e2y;
  }
  // ½ [(h+ax)(h+by) − (h+ay)(bx−h)] − h²
  const B h(stencil.spacing);
  return B(T(0.5)) * (h * ((ax + by) + (ay - bx)) + (ax * by - ay * bx));
}

/// Cell row j of −(A (J* − 1) − A/kappa P).
template <class T>
[[gnu::flatten]] void force_cells_row(const Membrane<T>& m, const Unknowns<T>& out, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const CellStencil<T> stencil(m, j, parity);
    const CellCompliance<T> compliance(m, j, parity);
    const T* p = m.pressure.half(j, parity);
    T* g = out.p.half(j, parity);
    for_lanes<T>(0, half_count(m.pressure.columns, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const B change = volume_change(lane, zero, stencil, stencil.ux, stencil.uy, zero, false, k);
      lane.store(compliance(lane, zero, k) * lane.load(p + k) - change, g + k);
    });
  }
}

/// Cells with J* < 0 in a row of `force_cells_row`'s result g: g − A/kappa P = −A (J* − 1) > A.
template <class T>
[[gnu::flatten]] int inverted_cells_row(const Membrane<T>& m, const Unknowns<T>& force, int j) {
  int count = 0;
  const T area = m.spacing * m.spacing, constant = m.compliance.value * area;
  for (int parity = 0; parity < 2; ++parity) {
    const T *p = m.pressure.half(j, parity), *g = force.p.half(j, parity);
    const T* cells = m.compliance.cells ? m.compliance.cells.half(j, parity) : nullptr;
    const int columns = half_count(m.pressure.columns, parity);
    if (cells)
      for (int k = 0; k < columns; ++k) count += g[k] - area * cells[k] * p[k] > area;
    else
      for (int k = 0; k < columns; ++k) count += g[k] - constant * p[k] > area;
  }
  return count;
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
