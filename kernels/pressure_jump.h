// SPDX-License-Identifier: MIT
#pragma once
// The jump term of a coarse level's volume rows (views.h, Membrane::pressure_jump):
//   sigma Σ_edges L²/(8 (mu_a + mu_b)) (dP − dP_neighbour),
// L the deformed length of the edge between cells a and b. It is what a coarse level lacks: nodes
// in the middle of its edges, which the finer lattice has and which give way to a difference of
// pressure across the edge, force ½ L ΔP against the diagonal 2 (mu_a + mu_b) of K. Eliminating
// them leaves this term.
#include "stencil.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// Σ weight·(dP − dP_neighbour) and Σ weight over a cell's edges.
template <class B>
struct JumpSums {
  B difference, weight;
};

/// Values of the cells beside a cell.
template <class B>
struct CellsBeside {
  B west, east, south, north;
};

/// The term at the cells of one parity in row j.
template <class T>
struct PressureJump {
  T strength, spacing, mu, south, north;
  Plane<const T> ux, uy;
  const T *own, *odd, *below, *above;  // dP; the west neighbour is odd[k − 1 + parity]
  const T *mu_own = nullptr, *mu_odd = nullptr, *mu_below = nullptr, *mu_above = nullptr;
  int row, parity;

  PressureJump(const Membrane<T>& m, const Plane<const T>& p, int j, int parity)
      : strength(T(0.125) * m.pressure_jump),
        spacing(m.spacing),
        mu(m.mu.value),
        south(T(j > 0)),
        north(T(j + 1 < p.rows)),
        ux(m.ux),
        uy(m.uy),
        row(j),
        parity(parity) {
    const int low = j > 0 ? j - 1 : j, high = j + 1 < p.rows ? j + 1 : j;
    own = p.half(j, parity);
    odd = p.half(j, 1 - parity);
    below = p.half(low, parity);
    above = p.half(high, parity);
    if (!m.mu.cells) return;
    mu_own = m.mu.cells.half(j, parity);
    mu_odd = m.mu.cells.half(j, 1 - parity);
    mu_below = m.mu.cells.half(low, parity);
    mu_above = m.mu.cells.half(high, parity);
  }

  /// Of cells with dP = p; `scale`: sigma/(8 (mu_a + mu_b)) of their edges, `west`, `east`: u.
  template <class B>
  JumpSums<B> sums(B p, const CellsBeside<B>& beside, const CellsBeside<B>& scale,
                   const Sides<B>& west, const Sides<B>& east) const {
    const B h(spacing);
    JumpSums<B> sums{B(T(0)), B(T(0))};
    auto edge = [&](B ex, B ey, B other, B by) {
      const B weight = by * (ex * ex + ey * ey);
      sums.difference = sums.difference + weight * (p - other);
      sums.weight = sums.weight + weight;
    };
    edge(west.x.north - west.x.south, (west.y.north - west.y.south) + h, beside.west, scale.west);
    edge(east.x.north - east.x.south, (east.y.north - east.y.south) + h, beside.east, scale.east);
    edge((east.x.south - west.x.south) + h, east.y.south - west.y.south, beside.south, scale.south);
    edge((east.x.north - west.x.north) + h, east.y.north - west.y.north, beside.north, scale.north);
    return sums;
  }

  /// sigma/(8 (mu_a + mu_b)) of the edges of cells k. `free_west`, `free_east`: 0 where the edge
  /// lies on the lattice's boundary, else 1; `mu_west`, `mu_east`: mu of the cells there.
  template <class L, class B>
  CellsBeside<B> scale(L lane, int k, B free_west, B free_east, B mu_west, B mu_east) const {
    const B once(strength * (T(0.5) / mu));
    if (!mu_own) return {once * free_west, once * free_east, once * B(south), once * B(north)};
    const B mu_here = lane.load(mu_own + k), least(T(1e-20));
    // Lanes past the end of a row have no mu.
    auto over = [&](B free, B mu_there) {
      return B(strength) * free / larger(mu_here + mu_there, least);
    };
    return {over(free_west, mu_west), over(free_east, mu_east),
            over(B(south), lane.load(mu_below + k)), over(B(north), lane.load(mu_above + k))};
  }

  /// `has_west`, `has_east`: false in the first and last column.
  template <class L, class B>
  JumpSums<B> operator()(L lane, B zero, int k, bool has_west = true, bool has_east = true) const {
    const int w = k + parity - 1, e = w + 1;
    const auto west_of = [&](const T* values) { return has_west ? lane.load(values + w) : zero; };
    const auto east_of = [&](const T* values) { return has_east ? lane.load(values + e) : zero; };
    const auto sides = [&](int of, int n) {
      return load_sides<B>(lane, ux.half(row, of) + n, uy.half(row, of) + n, ux.stride);
    };
    return sums(lane.load(own + k),
                {west_of(odd), east_of(odd), lane.load(below + k), lane.load(above + k)},
                scale(lane, k, B(T(has_west)), B(T(has_east)), mu_odd ? west_of(mu_odd) : zero,
                      mu_odd ? east_of(mu_odd) : zero),
                sides(parity, k), sides(1 - parity, k + parity));
  }
};

/// body(lane, zero, k, has_west, has_east) for the cells k in `range` of one parity in a row of
/// `columns` cells: the first and the last column one by one.
template <class T, class F>
void for_cells_of_row(int columns, int parity, Range range, F&& body) {
  const int last = columns - 1, count = half_count(columns, parity);
  const int first = parity == 0 ? 1 : 0;
  const int end = (last & 1) == parity ? count - 1 : count;
  if (first == 1 && range.begin == 0 && range.end > 0) body(Lane<T>{}, T(0), 0, false, last > 0);
  for_lanes<T>(range.begin > first ? range.begin : first, range.end < end ? range.end : end,
               [&](auto lane, auto zero, int k) { body(lane, zero, k, true, true); });
  if (end < count && end >= first && range.begin <= end && range.end > end)
    body(Lane<T>{}, T(0), end, last > 0, false);
}

/// out += sign · the jump term of dP in cell row j.
template <class T>
void add_pressure_jump_row(const Membrane<T>& m, const Plane<const T>& p, T sign,
                           const SplitRow<T>& out, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const PressureJump<T> jump(m, p, j, parity);
    T* row = out.half[parity];
    for_cells_of_row<T>(p.columns, parity, {0, half_count(p.columns, parity)},
                        [&](auto lane, auto zero, int k, bool has_west, bool has_east) {
                          using B = decltype(zero);
                          const JumpSums<B> sums = jump(lane, zero, k, has_west, has_east);
                          lane.store(lane.load(row + k) + B(sign) * sums.difference, row + k);
                        });
  }
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
