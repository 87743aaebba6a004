// SPDX-License-Identifier: MIT
#pragma once
// The two stencils that every elastic kernel is made of, each written once over any lane type.
//
// A node (i, j) sees its neighbours W, E, S, N and the four cells sw, se, nw, ne around it. With
// A J* = ½ d1 × d2, d1 = x̂11 − x̂00, d2 = x̂01 − x̂10 (Eq. 7), the derivative of Σ P A J* at a node is
//   x: ½ [P_sw (ŷ_W − ŷ_S) + P_se (ŷ_S − ŷ_E) + P_ne (ŷ_E − ŷ_N) + P_nw (ŷ_N − ŷ_W)]
//   y: minus the same with x̂.
// It is linear in P and in x̂: with (P_H, d) it is the product G d, with (dP, x̂) the product Bᵀ dP,
// with (P, x̂) the volume force. Differences of displacements keep their digits where positions
// would not.
#include <drumhead/kernels/views.h>

#include "batch.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// A node's field values at columns 2k + parity of row j: itself and its edge neighbours.
template <class T>
struct AtNode {
  const T *c, *w, *e, *s, *n;
  AtNode() = default;
  AtNode(const Plane<const T>& f, int j, int parity)
      : c(f.half(j, parity)),
        w(f.half(j, 1 - parity) + parity - 1),
        e(f.half(j, 1 - parity) + parity),
        s(f.half(j - 1, parity)),
        n(f.half(j + 1, parity)) {}
};

/// The four cells around the nodes of columns 2k + parity of row j.
template <class T>
struct CellsAtNode {
  const T *sw, *se, *nw, *ne;
  CellsAtNode() = default;
  CellsAtNode(const Plane<const T>& f, int j, int parity)
      : sw(f.half(j - 1, 1 - parity) + parity - 1),
        se(f.half(j - 1, parity)),
        nw(f.half(j, 1 - parity) + parity - 1),
        ne(f.half(j, parity)) {}
};

/// The four nodes of the cells of columns 2k + parity of row j.
template <class T>
struct Corners {
  T *n00, *n10, *n01, *n11;
  Corners() = default;
  Corners(const Plane<T>& f, int j, int parity)
      : n00(f.half(j, parity)),
        n10(f.half(j, 1 - parity) + parity),
        n01(f.half(j + 1, parity)),
        n11(f.half(j + 1, 1 - parity) + parity) {}
};

/// Values of a field at a node's four neighbours as differences along the diagonals of its four
/// cells.
template <class B>
struct Diagonals {
  B sw, se, ne, nw;  // W − S, S − E, E − N, N − W
};
template <class L, class B, class T>
Diagonals<B> diagonals(L lane, B, const AtNode<T>& f, int k) {
  const B w = lane.load(f.w + k), e = lane.load(f.e + k), s = lane.load(f.s + k),
          n = lane.load(f.n + k);
  return {w - s, s - e, e - n, n - w};
}
/// Σ P_cell · diagonal over the four cells.
template <class B>
B around(const Diagonals<B>& p, const Diagonals<B>& d) {
  return (p.sw * d.sw + p.se * d.se) + (p.ne * d.ne + p.nw * d.nw);
}

/// The operator K + P_H G and Bᵀ at the nodes of one parity in row j, applied to a correction d.
template <class T, bool kPressure, bool kMuCells>
struct NodeStencil {
  T mu, spacing, centre, width;
  AtNode<T> dx, dy, ux, uy;
  CellsAtNode<T> p, dp, mu_cells;

  NodeStencil(const Membrane<T>& m, const Unknowns<const T>& d, int j, int parity)
      : mu(m.mu.value),
        spacing(m.spacing),
        centre(m.clamp_centre),
        width(m.clamp_width),
        dx(d.x, j, parity),
        dy(d.y, j, parity) {
    if constexpr (kPressure) {
      ux = {m.ux, j, parity};
      uy = {m.uy, j, parity};
      p = {m.pressure, j, parity};
      dp = {d.p, j, parity};
    }
    if constexpr (kMuCells) mu_cells = {m.mu.cells, j, parity};
  }

  /// clamp(P − centre, ±width mu_cell) at the four cells.
  template <class L, class B>
  Diagonals<B> hessian_pressure(L lane, B, int k) const {
    const B middle(centre);
    auto clamped = [&](const T* at, const T* local) {
      B bound(width * mu);
      if constexpr (kMuCells) bound = B(width) * lane.load(local + k);
      return larger(smaller(lane.load(at + k) - middle, bound), B(T(0)) - bound);
    };
    return {clamped(p.sw, mu_cells.sw), clamped(p.se, mu_cells.se), clamped(p.ne, mu_cells.ne),
            clamped(p.nw, mu_cells.nw)};
  }

  /// Edge stiffness ½(mu + mu) of the two cells beside it, in the order W, E, S, N.
  template <class L, class B>
  void edges(L lane, B, int k, B& w, B& e, B& s, B& n) const {
    const B sw = lane.load(mu_cells.sw + k), se = lane.load(mu_cells.se + k),
            nw = lane.load(mu_cells.nw + k), ne = lane.load(mu_cells.ne + k), half(T(0.5));
    w = half * (sw + nw);
    e = half * (se + ne);
    s = half * (sw + se);
    n = half * (nw + ne);
  }

  /// hx, hy = (H d) at the nodes, without the curve forces; inverse = 1/K_ii.
  template <class L, class B>
  void apply(L lane, B zero, int k, B& hx, B& hy, B& inverse) const {
    const B cx = lane.load(dx.c + k), cy = lane.load(dy.c + k);
    const B wx = lane.load(dx.w + k), ex = lane.load(dx.e + k), sx = lane.load(dx.s + k),
            nx = lane.load(dx.n + k);
    const B wy = lane.load(dy.w + k), ey = lane.load(dy.e + k), sy = lane.load(dy.s + k),
            ny = lane.load(dy.n + k);
    if constexpr (kMuCells) {
      B w, e, s, n;
      edges(lane, zero, k, w, e, s, n);
      const B sum = (w + e) + (s + n);
      hx = sum * cx - ((w * wx + e * ex) + (s * sx + n * nx));
      hy = sum * cy - ((w * wy + e * ey) + (s * sy + n * ny));
      inverse = B(T(1)) / sum;
    } else {
      hx = B(mu) * (B(T(4)) * cx - ((wx + ex) + (sx + nx)));
      hy = B(mu) * (B(T(4)) * cy - ((wy + ey) + (sy + ny)));
      inverse = B(T(1) / (T(4) * mu));
    }
    if constexpr (kPressure) {
      const Diagonals<B> ph = hessian_pressure(lane, zero, k);
      const Diagonals<B> gx{wx - sx, sx - ex, ex - nx, nx - wx};
      const Diagonals<B> gy{wy - sy, sy - ey, ey - ny, ny - wy};
      const Diagonals<B> pd{lane.load(dp.sw + k), lane.load(dp.se + k), lane.load(dp.ne + k),
                            lane.load(dp.nw + k)};
      Diagonals<B> bx = diagonals(lane, zero, ux, k), by = diagonals(lane, zero, uy, k);
      add_rest(bx, by);
      const B half(T(0.5));
      hx = hx + half * (around(ph, gy) + around(pd, by));
      hy = hy - half * (around(ph, gx) + around(pd, bx));
    }
  }

  /// Adds the rest positions' share of the diagonals of x̂ = X + u.
  template <class B>
  void add_rest(Diagonals<B>& x, Diagonals<B>& y) const {
    const B h(spacing);
    x = {x.sw - h, x.se - h, x.ne + h, x.nw + h};
    y = {y.sw + h, y.se - h, y.ne - h, y.nw + h};
  }
};

/// A J* − A and B at the cells of one parity in row j: gradients g of A J* with respect to the
/// corners are (±½ d2y, ∓½ d2x) at 11, 00 and (∓½ d1y, ±½ d1x) at 01, 10.
template <class T>
struct CellStencil {
  T spacing;
  Corners<const T> ux, uy;

  CellStencil(const Membrane<T>& m, int j, int parity)
      : spacing(m.spacing), ux(m.ux, j, parity), uy(m.uy, j, parity) {}

  /// d1 = x̂11 − x̂00, d2 = x̂01 − x̂10.
  template <class L, class B>
  void cell_diagonals(L lane, B, int k, B& d1x, B& d1y, B& d2x, B& d2y) const {
    const B h(spacing);
    d1x = (lane.load(ux.n11 + k) - lane.load(ux.n00 + k)) + h;
    d1y = (lane.load(uy.n11 + k) - lane.load(uy.n00 + k)) + h;
    d2x = (lane.load(ux.n01 + k) - lane.load(ux.n10 + k)) - h;
    d2y = (lane.load(uy.n01 + k) - lane.load(uy.n10 + k)) + h;
  }
};

/// δ(d1), δ(d2) of a correction at a cell's corners.
template <class L, class B, class T>
void correction_diagonals(L lane, B, const Corners<T>& x, const Corners<T>& y, int k, B& d1x,
                          B& d1y, B& d2x, B& d2y) {
  d1x = lane.load(x.n11 + k) - lane.load(x.n00 + k);
  d1y = lane.load(y.n11 + k) - lane.load(y.n00 + k);
  d2x = lane.load(x.n01 + k) - lane.load(x.n10 + k);
  d2y = lane.load(y.n01 + k) - lane.load(y.n10 + k);
}

/// Interior node columns of one parity: k in [begin, end).
struct Range {
  int begin, end;
};
inline Range interior(int columns, int parity) {
  return {parity == 0 ? 1 : 0, half_count(columns - 1, parity)};
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
