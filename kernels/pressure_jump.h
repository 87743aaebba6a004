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

/// The term at the cells of one parity in row j.
template <class T>
struct PressureJump {
  T strength, spacing, mu, south, north;
  CellStencil<T> state;
  const T *own, *odd, *below, *above;  // dP; the west neighbour is odd[k − 1 + parity]
  const T *mu_own = nullptr, *mu_odd = nullptr, *mu_below = nullptr, *mu_above = nullptr;
  int west;

  PressureJump(const Membrane<T>& m, const Plane<const T>& p, int j, int parity)
      : strength(T(0.125) * m.pressure_jump),
        spacing(m.spacing),
        mu(m.mu.value),
        south(T(j > 0)),
        north(T(j + 1 < p.rows)),
        state(m, j, parity),
        west(parity - 1) {
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

  /// `has_west`, `has_east`: false in the first and last column.
  template <class L, class B>
  JumpSums<B> operator()(L lane, B zero, int k, bool has_west = true, bool has_east = true) const {
    JumpSums<B> sums{zero, zero};
    const B p = lane.load(own + k), h(spacing);
    const auto& x = state.ux;
    const auto& y = state.uy;
    auto edge = [&](B ex, B ey, const T* other, const T* mu_other, int n, T present) {
      B weight = B(strength * present) * (ex * ex + ey * ey);
      if (mu_own)
        weight = weight / (lane.load(mu_own + k) + lane.load(mu_other + n));
      else
        weight = weight * B(T(0.5) / mu);
      sums.difference = sums.difference + weight * (p - lane.load(other + n));
      sums.weight = sums.weight + weight;
    };
    const B x00 = lane.load(x.n00 + k), x10 = lane.load(x.n10 + k), x01 = lane.load(x.n01 + k),
            x11 = lane.load(x.n11 + k);
    const B y00 = lane.load(y.n00 + k), y10 = lane.load(y.n10 + k), y01 = lane.load(y.n01 + k),
            y11 = lane.load(y.n11 + k);
    const int w = k + west, e = w + 1;
    if (has_west) edge(x01 - x00, (y01 - y00) + h, odd, mu_odd, w, T(1));
    if (has_east) edge(x11 - x10, (y11 - y10) + h, odd, mu_odd, e, T(1));
    edge((x10 - x00) + h, y10 - y00, below, mu_below, k, south);
    edge((x11 - x01) + h, y11 - y01, above, mu_above, k, north);
    return sums;
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
