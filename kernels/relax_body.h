// SPDX-License-Identifier: MIT
#pragma once
// Rows of the relaxation: red-black Gauss–Seidel on x̂.
#include "elastic_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// Nodes of some spans of row j with i + j + colour even: both components of d += (f − H d)/K_ii,
/// which their own d has no part in.
/// The components couple only across colours, so updating them together is Gauss–Seidel in the two
/// colours.
template <class T>
[[gnu::flatten]] void relax_nodes_row(const Membrane<T>& m, const Unknowns<const T>& f,
                                      const Unknowns<T>& d, int colour, Spans nodes, int j) {
  with_scene(m, [&](auto pressure, auto mu_cells) {
    const int parity = (j + colour) & 1;
    const NodeStencil<T, pressure.value, mu_cells.value> stencil(m, d, j, parity);
    T *dx = d.x.half(j, parity), *dy = d.y.half(j, parity);
    const T *fx = f.x.half(j, parity), *fy = f.y.half(j, parity);
    const T* fp = pressure.value ? f.p.half(j, parity) : nullptr;
    // Each colour asks for its half of the rows ahead of both; black works two rows behind red.
    const int ahead = colour == 0 ? 3 : 5;
    for (const Span span : nodes) {
      const Range range = within(interior(d.x.columns, parity), span, parity);
      for_lanes<T>(range.begin, range.end, [&](auto lane, auto zero, int k) {
        stencil.prefetch(k, ahead);
        for (const T* at : {fx, fy}) ask(at + k + ahead * stencil.node_row);
        if constexpr (pressure.value) ask(fp + k + ahead * stencil.cell_row);
        decltype(zero) hx, hy, inverse;
        stencil.template apply<false>(lane, zero, k, hx, hy, inverse);
        lane.store((lane.load(fx + k) - hx) * inverse, dx + k);
        lane.store((lane.load(fy + k) - hy) * inverse, dy + k);
      });
    }
  });
}

/// The same for red nodes where all of d is 0: d = f/K_ii.
template <class T>
[[gnu::flatten]] void start_nodes_row(const Membrane<T>& m, const Unknowns<const T>& f,
                                      const Unknowns<T>& d, int j) {
  const int parity = j & 1;
  const Range range = interior(d.x.columns, parity);
  T *dx = d.x.half(j, parity), *dy = d.y.half(j, parity);
  const T *fx = f.x.half(j, parity), *fy = f.y.half(j, parity);
  auto scale = [&](auto&& inverse) {
    for_lanes<T>(range.begin, range.end, [&](auto lane, auto zero, int k) {
      const auto by = inverse(lane, zero, k);
      lane.store(lane.load(fx + k) * by, dx + k);
      lane.store(lane.load(fy + k) * by, dy + k);
    });
  };
  if (m.mu.cells) {
    const NodeStencil<T, false, true> stencil(m, d, j, parity);
    scale([&](auto lane, auto zero, int k) {
      auto w = zero, e = zero, s = zero, n = zero;
      stencil.edges(stencil.mu_around(lane, k), w, e, s, n);
      return decltype(zero)(T(1)) / ((w + e) + (s + n));
    });
  } else {
    const T inverse = T(1) / (T(4) * m.mu.value);
    scale([=](auto, auto zero, int) { return decltype(zero)(inverse); });
  }
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
