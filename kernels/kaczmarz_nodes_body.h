// SPDX-License-Identifier: MIT
#pragma once
// Rows of Kaczmarz's method on the momentum rows.
#include <drumhead/kernels/kaczmarz.h>

#include "elastic_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// 1 for every second lane, from the first or from the second on.
template <class T>
inline constexpr T kEverySecond[18] = {1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0};

/// The coefficients of a node's momentum row: of its own component at the node and its neighbours,
/// of the other component at the neighbours, of the pressures of its four cells. 0 for neighbours
/// on the fixed boundary.
template <class B>
struct MomentumRow {
  B c, w, e, s, n;
  B other_w, other_e, other_s, other_n;
  B sw, se, nw, ne;
};

/// 0 where the neighbour is on the fixed boundary, 1 elsewhere.
template <class B>
struct FreeNeighbours {
  B w, e, s, n;
};

/// Values of a correction around the nodes of one parity in row j, to be changed.
template <class T>
struct AroundNode {
  T *c, *e, *s, *n;  // the west neighbour is e[-1]
  AroundNode(const Plane<T>& f, int j, int parity)
      : c(f.half(j, parity)),
        e(f.half(j, 1 - parity) + parity),
        s(f.half(j - 1, parity)),
        n(f.half(j + 1, parity)) {}
};

/// The momentum rows of the nodes of one parity in row j.
template <class T, bool kPressure, bool kMuCells>
struct MomentumRows {
  const KaczmarzSystem<T>& system;
  NodeStencil<T, kPressure, kMuCells> stencil;
  AroundNode<T> dx, dy;
  const T *fx, *fy;
  CellsAtNode<T> alpha2;
  T *sw = nullptr, *se = nullptr, *nw = nullptr, *ne = nullptr;  // dP of the cells around
  T free_south, free_north;
  int j, parity;

  MomentumRows(const KaczmarzSystem<T>& s, int row, int parity_)
      : system(s),
        stencil(s.level.membrane, s.level.d, row, parity_),
        dx(s.level.d.x, row, parity_),
        dy(s.level.d.y, row, parity_),
        fx(s.level.f.x.half(row, parity_)),
        fy(s.level.f.y.half(row, parity_)),
        free_south(T(row > 1)),
        free_north(T(row + 2 < s.level.d.x.rows)),
        j(row),
        parity(parity_) {
    if constexpr (kPressure) {
      const Plane<T>& p = s.level.d.p;
      alpha2 = {s.alpha2, j, parity};
      sw = p.half(j - 1, 1 - parity) + parity - 1;
      se = p.half(j - 1, parity);
      nw = p.half(j, 1 - parity) + parity - 1;
      ne = p.half(j, parity);
    }
  }

  /// All neighbours free but where the row's are not.
  template <class B>
  FreeNeighbours<B> inner(B) const {
    return {B(T(1)), B(T(1)), B(free_south), B(free_north)};
  }
  FreeNeighbours<T> at_column(int i) const {
    return {T(i > 1), T(i + 2 < system.level.d.x.columns), free_south, free_north};
  }

  template <int kComponent, class L, class B>
  MomentumRow<B> row(L lane, B zero, const FreeNeighbours<B>& free, int k) const {
    MomentumRow<B> a{};
    B w(stencil.mu), e(stencil.mu), s(stencil.mu), n(stencil.mu);
    a.c = B(T(4) * stencil.mu);
    if constexpr (kMuCells) {
      stencil.edges(stencil.mu_around(lane, k), w, e, s, n);
      a.c = (w + e) + (s + n);
    }
    a.w = zero - free.w * w;
    a.e = zero - free.e * e;
    a.s = zero - free.s * s;
    a.n = zero - free.n * n;
    if constexpr (kPressure) {
      const EdgeWeights<B> p = stencil.hessian_pressure(lane, zero, k);
      const B half(kComponent == 0 ? T(0.5) : T(-0.5));
      a.other_w = half * (free.w * p.w);
      a.other_e = half * (free.e * p.e);
      a.other_s = half * (free.s * p.s);
      a.other_n = half * (free.n * p.n);
      const AtNode<T>& u = kComponent == 0 ? stencil.uy : stencil.ux;
      const B uw = lane.load(u.e + k - 1), ue = lane.load(u.e + k), us = lane.load(u.s + k),
              un = lane.load(u.n + k);
      const B h(stencil.spacing), turned = kComponent == 0 ? h : zero - h;
      a.sw = half * ((uw - us) + turned);
      a.se = half * ((us - ue) - h);
      a.nw = half * ((un - uw) + h);
      a.ne = half * ((ue - un) - turned);
    }
    return a;
  }

  /// |a|² without the curve rows' entries.
  template <class L, class B>
  B norm2(L lane, const MomentumRow<B>& a, int k) const {
    B sum = a.c * a.c + ((a.w * a.w + a.e * a.e) + (a.s * a.s + a.n * a.n));
    if constexpr (kPressure) {
      sum = sum + ((a.other_w * a.other_w + a.other_e * a.other_e) +
                   (a.other_s * a.other_s + a.other_n * a.other_n));
      sum = sum +
            ((lane.load(alpha2.sw + k) * (a.sw * a.sw) + lane.load(alpha2.se + k) * (a.se * a.se)) +
             (lane.load(alpha2.nw + k) * (a.nw * a.nw) + lane.load(alpha2.ne + k) * (a.ne * a.ne)));
    }
    return sum;
  }

  template <int kComponent, class L, class B>
  B residual(L lane, B zero, int k) const {
    B hx, hy, inverse;
    stencil.apply(lane, zero, k, hx, hy, inverse);
    return kComponent == 0 ? lane.load(fx + k) - hx : lane.load(fy + k) - hy;
  }

  /// S⁻¹ d += delta a.
  template <int kComponent, class L, class B>
  void move(L lane, const MomentumRow<B>& a, B delta, int k) const {
    const auto add = [&](T* at, B value) { lane.store(lane.load(at) + value, at); };
    const AroundNode<T>&own = kComponent == 0 ? dx : dy, &other = kComponent == 0 ? dy : dx;
    add(own.c + k, a.c * delta);
    add(own.e + k - 1, a.w * delta);
    add(own.e + k, a.e * delta);
    add(own.s + k, a.s * delta);
    add(own.n + k, a.n * delta);
    if constexpr (kPressure) {
      add(other.e + k - 1, a.other_w * delta);
      add(other.e + k, a.other_e * delta);
      add(other.s + k, a.other_s * delta);
      add(other.n + k, a.other_n * delta);
      add(sw + k, lane.load(alpha2.sw + k) * (a.sw * delta));
      add(se + k, lane.load(alpha2.se + k) * (a.se * delta));
      add(nw + k, lane.load(alpha2.nw + k) * (a.nw * delta));
      add(ne + k, lane.load(alpha2.ne + k) * (a.ne * delta));
    }
  }
};

/// body(rows, parity) with the momentum rows of each parity in `parities` of node row j.
template <class T, class F>
void with_momentum_rows(const KaczmarzSystem<T>& system, int j, int parity, F&& body) {
  with_scene(system.level.membrane, [&](auto pressure, auto mu_cells) {
    body(MomentumRows<T, pressure.value, mu_cells.value>(system, j, parity));
  });
}

/// body(begin, end) for the stretches of node columns 2k + parity, k in [begin, end), between the
/// single nodes of row j.
template <class T, class F>
void between_single_nodes(const SingleNodes<T>& nodes, int parity, int j, F&& body) {
  for (int n = nodes.row_begin[j]; n + 1 < nodes.row_begin[j + 1]; ++n) {
    const int begin = (nodes.column[n] - parity) / 2 + 1;
    const int end = (nodes.column[n + 1] - parity + 1) / 2;
    if (begin < end) body(begin, end);
  }
}

/// Σ β² W² of single node n.
template <class T>
T curve_norm2(const KaczmarzSystem<T>& system, int n) {
  const SingleNodes<T>& nodes = system.nodes;
  T sum = T(0);
  for (int m = nodes.entry_begin[n]; m < nodes.entry_begin[n + 1]; ++m) {
    const T w = system.level.cuts.weight[4 * nodes.cut[m] + nodes.corner[m]];
    sum += system.beta2[nodes.cut[m]] * (w * w);
  }
  return sum;
}

/// dq −= β² W delta of single node n, component by component; f goes on carrying Wᵀ dq.
template <int kComponent, class T>
void move_curve(const KaczmarzSystem<T>& system, int n, T delta, int j) {
  const SingleNodes<T>& nodes = system.nodes;
  const Plane<T>& f = kComponent == 0 ? system.level.f.x : system.level.f.y;
  for (int m = nodes.entry_begin[n]; m < nodes.entry_begin[n + 1]; ++m) {
    const int cut = nodes.cut[m], corner = nodes.corner[m];
    const T* w = system.level.cuts.weight + 4 * cut;
    const T change = T(0) - system.beta2[cut] * (w[corner] * delta);
    system.level.dq[2 * cut + kComponent] += change;
    const int i0 = nodes.column[n] - (corner & 1), j0 = j - (corner >> 1);
    for (int c = 0; c < 4; ++c) f.at(i0 + (c & 1), j0 + (c >> 1)) += w[c] * change;
  }
}

/// One component of the momentum rows in the columns i ≡ column (mod 4) of row j.
template <int kComponent, class Rows, class T>
void kaczmarz_colour(const Rows& rows, const KaczmarzSystem<T>& system, Reach reach, int column,
                     int j) {
  const SingleNodes<T>& nodes = system.nodes;
  if (reach == Reach::everywhere)
    between_single_nodes(nodes, rows.parity, j, [&](int begin, int end) {
      for_lanes<T>(begin, end, [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        const MomentumRow<B> a = rows.template row<kComponent>(lane, zero, rows.inner(zero), k);
        const B delta = B(system.omega) * rows.template residual<kComponent>(lane, zero, k) /
                        rows.norm2(lane, a, k);
        // + 0: the lanes of the other colour move by +0, whatever the sign of their residual.
        const B picked = lane.load(kEverySecond<T> + ((k + (column >> 1)) & 1)) * delta + zero;
        rows.template move<kComponent>(lane, a, picked, k);
      });
    });
  for (int n = nodes.row_begin[j]; n < nodes.row_begin[j + 1]; ++n) {
    const int i = nodes.column[n], k = i >> 1;
    const bool curve = nodes.entry_begin[n] < nodes.entry_begin[n + 1];
    if ((i & 3) != column || (reach == Reach::near_curves && !curve)) continue;
    const Lane<T> lane;
    const MomentumRow<T> a = rows.template row<kComponent>(lane, T(0), rows.at_column(i), k);
    const T norm2 = rows.norm2(lane, a, k) + curve_norm2(system, n);
    const T delta = system.omega * rows.template residual<kComponent>(lane, T(0), k) / norm2;
    rows.template move<kComponent>(lane, a, delta, k);
    move_curve<kComponent>(system, n, delta, j);
  }
}

/// Gauss–Seidel over the momentum rows of node row j, eight colours one after the other.
template <class T>
[[gnu::flatten]] void kaczmarz_nodes_row(const KaczmarzSystem<T>& system, Reach reach, int j) {
  for (int column = 0; column < 4; ++column)
    with_momentum_rows(system, j, column & 1, [&](const auto& rows) {
      kaczmarz_colour<0>(rows, system, reach, column, j);
      kaczmarz_colour<1>(rows, system, reach, column, j);
    });
}

/// e = −omega residual/|row|² of the momentum rows of row j.
template <class T>
[[gnu::flatten]] void jacobi_nodes_row(const KaczmarzSystem<T>& system, const Unknowns<T>& e,
                                       int j) {
  const SingleNodes<T>& nodes = system.nodes;
  for (int parity = 0; parity < 2; ++parity)
    with_momentum_rows(system, j, parity, [&](const auto& rows) {
      T *ex = e.x.half(j, parity), *ey = e.y.half(j, parity);
      const auto set = [&]<class B>(auto lane, B zero, const FreeNeighbours<B>& free, B curve,
                                    int k) {
        const B damping(T(0) - system.omega);
        const MomentumRow<B> x = rows.template row<0>(lane, zero, free, k);
        const MomentumRow<B> y = rows.template row<1>(lane, zero, free, k);
        B hx, hy, inverse;
        rows.stencil.apply(lane, zero, k, hx, hy, inverse);
        lane.store(damping * (lane.load(rows.fx + k) - hx) / (rows.norm2(lane, x, k) + curve),
                   ex + k);
        lane.store(damping * (lane.load(rows.fy + k) - hy) / (rows.norm2(lane, y, k) + curve),
                   ey + k);
      };
      between_single_nodes(nodes, parity, j, [&](int begin, int end) {
        for_lanes<T>(begin, end, [&](auto lane, auto zero, int k) {
          set(lane, zero, rows.inner(zero), zero, k);
        });
      });
      for (int n = nodes.row_begin[j]; n < nodes.row_begin[j + 1]; ++n) {
        const int i = nodes.column[n];
        if ((i & 1) == parity)
          set(Lane<T>{}, T(0), rows.at_column(i), curve_norm2(system, n), i >> 1);
      }
    });
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
