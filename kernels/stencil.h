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

/// Asks for what a later row will want. A stencil is some thirty short streams, more than a
/// processor's prefetcher follows. Into L2: a row of every field fills L1, which the present row
/// needs.
[[gnu::always_inline]] inline void ask(const void* at) { __builtin_prefetch(at, 0, 2); }

/// A node's field values at columns 2k + parity of row j: itself and its edge neighbours.
template <class T>
struct AtNode {
  const T *c, *e, *s, *n;  // the west neighbour is e[-1]
  AtNode() = default;
  AtNode(const Plane<const T>& f, int j, int parity)
      : c(f.half(j, parity)),
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

/// Σ P_cell · diagonal over a node's cells, summed by parts: every edge neighbour's value times the
/// difference of the two cells beside that edge.
template <class B>
struct EdgeWeights {
  B w, e, s, n;
};
template <class B>
EdgeWeights<B> edge_weights(B sw, B se, B nw, B ne) {
  return {sw - nw, ne - se, se - sw, nw - ne};
}
template <class L, class B, class T>
B around(L lane, const EdgeWeights<B>& weight, const AtNode<T>& f, int k) {
  return (weight.w * lane.load(f.e + k - 1) + weight.e * lane.load(f.e + k)) +
         (weight.s * lane.load(f.s + k) + weight.n * lane.load(f.n + k));
}
/// The same for the four cells of a plane.
template <class L, class B, class T>
EdgeWeights<B> edge_weights(L lane, B, const CellsAtNode<T>& p, int k) {
  return edge_weights<B>(lane.load(p.sw + k), lane.load(p.se + k), lane.load(p.nw + k),
                         lane.load(p.ne + k));
}

/// A field at a node and at its edge neighbours.
template <class B>
struct FiveNodes {
  B c, w, e, s, n;
};
template <class L, class T>
auto five_nodes(L lane, const AtNode<T>& f, int k) {
  using B = decltype(lane.load(f.c));
  return FiveNodes<B>{lane.load(f.c + k), lane.load(f.e + k - 1), lane.load(f.e + k),
                      lane.load(f.s + k), lane.load(f.n + k)};
}

/// A value of the four cells around a node.
template <class B>
struct FourCells {
  B sw, se, nw, ne;
};

/// The operator K + P_H G and Bᵀ at the nodes of one parity in row j, applied to a correction d.
template <class T, bool kPressure, bool kMuCells>
struct NodeStencil {
  T mu, spacing, centre, width;
  std::ptrdiff_t node_row, cell_row;  // distances between rows
  AtNode<T> dx, dy, ux, uy;
  CellsAtNode<T> p, dp, mu_cells;

  NodeStencil(const Membrane<T>& m, const Unknowns<const T>& d, int j, int parity)
      : mu(m.mu.value),
        spacing(m.spacing),
        centre(m.clamp_centre),
        width(m.clamp_width),
        node_row(d.x.stride),
        cell_row(d.p.stride),
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

  /// Asks for what the stencil will read that many rows further on.
  [[gnu::always_inline]] void prefetch(int k, int rows) const {
    for (const T* at : {dx.n, dy.n}) ask(at + k + rows * node_row);
    if constexpr (kPressure) {
      for (const T* at : {ux.n, uy.n}) ask(at + k + rows * node_row);
      for (const T* at : {p.ne, dp.ne}) ask(at + k + rows * cell_row);
    }
  }

  /// Edge weights of clamp(P − centre, ±width mu_cell).
  template <class L, class B>
  EdgeWeights<B> hessian_pressure(L lane, B, int k) const {
    const B middle(centre);
    auto clamped = [&](const T* at, const T* local) {
      B bound(width * mu);
      if constexpr (kMuCells) bound = B(width) * lane.load(local + k);
      return larger(smaller(lane.load(at + k) - middle, bound), B(T(0)) - bound);
    };
    return edge_weights<B>(clamped(p.sw, mu_cells.sw), clamped(p.se, mu_cells.se),
                           clamped(p.nw, mu_cells.nw), clamped(p.ne, mu_cells.ne));
  }

  /// mu of the four cells around the nodes.
  template <class L>
  auto mu_around(L lane, int k) const {
    using B = decltype(lane.load(mu_cells.sw));
    if constexpr (!kMuCells) return FourCells<B>{};
    return FourCells<B>{lane.load(mu_cells.sw + k), lane.load(mu_cells.se + k),
                        lane.load(mu_cells.nw + k), lane.load(mu_cells.ne + k)};
  }
  /// Edge stiffness ½(mu + mu) of the two cells beside it, in the order W, E, S, N.
  template <class B>
  static void edges(const FourCells<B>& mu, B& w, B& e, B& s, B& n) {
    const B half(T(0.5));
    w = half * (mu.sw + mu.nw);
    e = half * (mu.se + mu.ne);
    s = half * (mu.sw + mu.se);
    n = half * (mu.nw + mu.ne);
  }

  /// hx, hy = (H d) at the nodes, without the curve forces and, unless kCentre, without their own
  /// K_ii d; inverse = 1/K_ii.
  template <bool kCentre = true, class L, class B>
  void apply(L lane, B zero, int k, B& hx, B& hy, B& inverse) const {
    B px = zero, py = zero;
    if constexpr (kPressure) {
      const EdgeWeights<B> dual = edge_weights(lane, zero, dp, k);
      const EdgeWeights<B> primal = hessian_pressure(lane, zero, k);
      const B half(T(0.5));
      px = half * (volume_x(lane, dual, k) + around(lane, primal, dy, k));
      py = half * (volume_y(lane, dual, k) + around(lane, primal, dx, k));
    }
    inverse = membrane<kCentre>(zero, mu_around(lane, k), five_nodes(lane, dx, k),
                                five_nodes(lane, dy, k), hx, hy);
    if constexpr (kPressure) {
      hx = hx + px;
      hy = hy - py;
    }
  }

  /// hx, hy = (K d) at the nodes where d is x, y, see apply; returns 1/K_ii.
  template <bool kCentre = true, class B>
  B membrane(B zero, const FourCells<B>& around, const FiveNodes<B>& x, const FiveNodes<B>& y,
             B& hx, B& hy) const {
    if constexpr (kMuCells) {
      B w, e, s, n;
      edges(around, w, e, s, n);
      const B sum = (w + e) + (s + n);
      const B centre_x = kCentre ? sum * x.c : zero, centre_y = kCentre ? sum * y.c : zero;
      hx = centre_x - ((w * x.w + e * x.e) + (s * x.s + n * x.n));
      hy = centre_y - ((w * y.w + e * y.e) + (s * y.s + n * y.n));
      return B(T(1)) / sum;
    } else {
      const B beside_x = (x.w + x.e) + (x.s + x.n), beside_y = (y.w + y.e) + (y.s + y.n);
      hx = kCentre ? B(mu) * (B(T(4)) * x.c - beside_x) : B(-mu) * beside_x;
      hy = kCentre ? B(mu) * (B(T(4)) * y.c - beside_y) : B(-mu) * beside_y;
      return B(T(1) / (T(4) * mu));
    }
  }

  /// Σ weight·ŷ and Σ weight·x̂ over the edge neighbours, x̂ = X + u.
  template <class L, class B>
  B volume_x(L lane, const EdgeWeights<B>& p, int k) const {
    return around(lane, p, uy, k) + B(spacing) * (p.n - p.s);
  }
  template <class L, class B>
  B volume_y(L lane, const EdgeWeights<B>& p, int k) const {
    return around(lane, p, ux, k) + B(spacing) * (p.e - p.w);
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

/// A value at the two nodes of a cell's west or east side.
template <class B>
struct Side {
  B south, north;
};
template <class B, class L, class T>
Side<B> load_side(L lane, const T* south, std::ptrdiff_t stride) {
  return {lane.load(south), lane.load(south + stride)};
}
template <class B, class L, class T>
void store_side(L lane, const Side<B>& side, T* south, std::ptrdiff_t stride) {
  lane.store(side.south, south);
  lane.store(side.north, south + stride);
}
/// Both components.
template <class B>
struct Sides {
  Side<B> x, y;
};
template <class B, class L, class T>
Sides<B> load_sides(L lane, const T* x, const T* y, std::ptrdiff_t stride) {
  return {load_side<B>(lane, x, stride), load_side<B>(lane, y, stride)};
}

/// Interior node columns of one parity: k in [begin, end).
struct Range {
  int begin, end;
};
inline Range interior(int columns, int parity) {
  return {parity == 0 ? 1 : 0, half_count(columns - 1, parity)};
}

/// The part of k in [range.begin, range.end), columns 2k + parity, that is in a span.
inline Range within(Range range, Span span, int parity) {
  const int begin = (span.begin - parity + 1) >> 1, end = (span.end - parity + 1) >> 1;
  return {begin > range.begin ? begin : range.begin, end < range.end ? end : range.end};
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
