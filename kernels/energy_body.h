// SPDX-License-Identifier: MIT
#pragma once
// One row of cell energies at x̂ + t d, without storing the moved state: what a line search needs.
#include <drumhead/kernels/elastic.h>

#include "elastic_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// mu/4 Σ |edge|² of a cell (Eq. 6) at x̂ + t d for one component; hx, hy: rest lengths of its
/// edges.
template <class L, class B, class T>
B edge_squares(L lane, B, const Corners<const T>& u, const Corners<const T>& d, B t, bool moved,
               B hx, B hy, int k) {
  B a00 = lane.load(u.n00 + k), a10 = lane.load(u.n10 + k), a01 = lane.load(u.n01 + k),
    a11 = lane.load(u.n11 + k);
  if (moved) {
    a00 = a00 + t * lane.load(d.n00 + k);
    a10 = a10 + t * lane.load(d.n10 + k);
    a01 = a01 + t * lane.load(d.n01 + k);
    a11 = a11 + t * lane.load(d.n11 + k);
  }
  const B bottom = (a10 - a00) + hx, top = (a11 - a01) + hx;
  const B left = (a01 - a00) + hy, right = (a11 - a10) + hy;
  return (bottom * bottom + top * top) + (left * left + right * right);
}

/// Adds row j's elastic energy, primal volume energy, volume merit and number of inverted cells to
/// sums.
template <class T>
[[gnu::flatten]] void energy_row(const Membrane<T>& m, const Unknowns<const T>& d, T step,
                                 bool moved, const Columns& left_out, EnergySums& sums, int j) {
  constexpr int kChunk = 256;
  T elastic[kChunk], volume[kChunk], merit[kChunk], inverted[kChunk];
  Sixteen total[4];
  const T area = m.spacing * m.spacing;
  // Compressive stiffness of the merit function: min(kappa, 100 mu).
  const T soft = T(0.01) / m.mu.value;
  for (int parity = 0; parity < 2; ++parity) {
    const CellStencil<T> stencil(m, j, parity);
    Corners<const T> x = stencil.ux, y = stencil.uy;
    if (moved) {
      x = {d.x, j, parity};
      y = {d.y, j, parity};
    }
    const T* mu = m.mu.cells ? m.mu.cells.half(j, parity) : nullptr;
    const T* compliance = m.compliance.cells ? m.compliance.cells.half(j, parity) : nullptr;
    const T* p = m.pressure ? m.pressure.half(j, parity) : nullptr;
    const T* dp = moved && p ? d.p.half(j, parity) : nullptr;
    const int count = half_count(m.ux.columns - 1, parity);
    for (int begin = 0; begin < count; begin += kChunk) {
      const int end = begin + kChunk < count ? begin + kChunk : count;
      for_lanes<T>(begin, end, [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        const B t(step), h(m.spacing);
        const B stiffness = mu ? lane.load(mu + k) : B(m.mu.value);
        const B squares = edge_squares(lane, zero, stencil.ux, x, t, moved, h, zero, k) +
                          edge_squares(lane, zero, stencil.uy, y, t, moved, zero, h, k);
        lane.store(B(T(0.25)) * stiffness * squares, elastic + (k - begin));
        const B change = volume_change(lane, zero, stencil, x, y, t, moved, k) / B(area);
        const B one(T(1)), half_area(T(0.5) * area);
        lane.store(larger(zero, smaller(one, B(T(0)) - (change + one) * B(T(1e30)))),
                   inverted + (k - begin));
        if (!p) return;
        const B c0 = compliance ? lane.load(compliance + k) : B(m.compliance.value);
        B pressure = lane.load(p + k);
        if (dp) pressure = pressure + lane.load(dp + k);
        const B limited = larger(c0, B(soft));
        const B c = change - pressure * c0;
        const B direct = half_area * change * change / limited;
        const B lagrange = B(area) * pressure * c + half_area * c * c / B(soft);
        const B stiff = smaller(one, larger(zero, (B(soft) - c0) * B(T(1e30))));
        lane.store(direct + stiff * (lagrange - direct), merit + (k - begin));
        // 1/kappa = 0: J* = 1 holds by the constraint and stores no energy.
        const B finite = smaller(one, c0 * B(T(1e30)));
        lane.store(finite * half_area * change * change / larger(c0, B(T(1e-30))),
                   volume + (k - begin));
      });
      for (const int i : left_out) {
        const int k = i >> 1;
        if ((i & 1) != parity || k < begin || k >= end) continue;
        elastic[k - begin] = inverted[k - begin] = T(0);
        if (p) volume[k - begin] = merit[k - begin] = T(0);
      }
      total[0].add(elastic, end - begin);
      total[3].add(inverted, end - begin);
      if (!p) continue;
      total[1].add(volume, end - begin);
      total[2].add(merit, end - begin);
    }
  }
  sums.elastic += total[0].total();
  sums.volume += total[1].total();
  sums.volume_merit += total[2].total();
  sums.inverted_cells += total[3].total();
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
