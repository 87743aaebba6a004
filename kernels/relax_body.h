// SPDX-License-Identifier: MIT
#pragma once
// Rows of the relaxation: red-black Gauss–Seidel on x̂ and coloured, D-weighted Kaczmarz on the
// volume rows.
#include "elastic_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// The part of k in [range.begin, range.end), columns 2k + parity, that is in a span.
inline Range within(Range range, Span span, int parity) {
  const int begin = (span.begin - parity + 1) >> 1, end = (span.end - parity + 1) >> 1;
  return {begin > range.begin ? begin : range.begin, end < range.end ? end : range.end};
}

/// Nodes of some spans of row j with i + j + colour even: both components of d += (f − H d)/K_ii.
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
        stencil.apply(lane, zero, k, hx, hy, inverse);
        lane.store(lane.load(dx + k) + (lane.load(fx + k) - hx) * inverse, dx + k);
        lane.store(lane.load(dy + k) + (lane.load(fy + k) - hy) * inverse, dy + k);
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
      stencil.edges(lane, zero, k, w, e, s, n);
      return decltype(zero)(T(1)) / ((w + e) + (s + n));
    });
  } else {
    const T inverse = T(1) / (T(4) * m.mu.value);
    scale([=](auto, auto zero, int) { return decltype(zero)(inverse); });
  }
}

/// 1/K_ii at the four nodes of a cell; 0 on the fixed boundary.
template <class B>
struct CornerInverse {
  B i00, i10, i01, i11;
};

/// One D-weighted Kaczmarz update of volume rows, B d − A/kappa dP − jump = g:
/// r = g − (B d − A/kappa dP − jump), s = Σ B_i²/K_ii + A/kappa + weight of the jump, d_i += B_i
/// r/(s K_ii), dP −= r/s. `floor` keeps s positive in a cell that has collapsed to a point.
template <class L, class B, class T>
void relax_volume(L lane, B zero, const CellStencil<T>& stencil, const Corners<T>& x,
                  const Corners<T>& y, const T* g, T* p, B compliance, const JumpSums<B>& jump,
                  B floor, const CornerInverse<B>& inverse, int k) {
  B d1x, d1y, d2x, d2y;
  stencil.cell_diagonals(lane, zero, k, d1x, d1y, d2x, d2y);
  B x00 = lane.load(x.n00 + k), x10 = lane.load(x.n10 + k), x01 = lane.load(x.n01 + k),
    x11 = lane.load(x.n11 + k);
  B y00 = lane.load(y.n00 + k), y10 = lane.load(y.n10 + k), y01 = lane.load(y.n01 + k),
    y11 = lane.load(y.n11 + k);
  const B half(T(0.5)), quarter(T(0.25)), dp = lane.load(p + k);
  const B product =
      half * ((d1x * (y01 - y10) - d1y * (x01 - x10)) + ((x11 - x00) * d2y - (y11 - y00) * d2x));
  const B r = lane.load(g + k) - ((product - compliance * dp) - jump.difference);
  const B weight = (d2x * d2x + d2y * d2y) * (inverse.i11 + inverse.i00) +
                   (d1x * d1x + d1y * d1y) * (inverse.i01 + inverse.i10);
  const B t = r / ((quarter * weight + compliance + floor) + jump.weight);
  const B v = half * t;
  lane.store(dp - t, p + k);
  lane.store(x11 + d2y * (v * inverse.i11), x.n11 + k);
  lane.store(y11 - d2x * (v * inverse.i11), y.n11 + k);
  lane.store(x00 - d2y * (v * inverse.i00), x.n00 + k);
  lane.store(y00 + d2x * (v * inverse.i00), y.n00 + k);
  lane.store(x01 - d1y * (v * inverse.i01), x.n01 + k);
  lane.store(y01 + d1x * (v * inverse.i01), y.n01 + k);
  lane.store(x10 + d1y * (v * inverse.i10), x.n10 + k);
  lane.store(y10 - d1x * (v * inverse.i10), y.n10 + k);
}

/// Volume rows of the cells of columns 2k + parity in some spans of row j; they share no node.
template <bool kJump, class T>
void relax_volume_cells(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<T>& d,
                        int parity, Spans spans, int j) {
  const CellStencil<T> stencil(m, j, parity);
  const Corners<T> x(d.x, j, parity), y(d.y, j, parity);
  const CellCompliance<T> compliance(m, j, parity);
  const PressureJump<T> jumps(m, d.p, j, parity);
  const T* g = f.p.half(j, parity);
  T* p = d.p.half(j, parity);
  const T floor = T(1e-6) * m.spacing * m.spacing / (T(4) * m.mu.value);
  const T inverse = T(1) / (T(4) * m.mu.value);
  const T south = j > 0 ? inverse : T(0), north = j + 1 < d.p.rows ? inverse : T(0);
  const bool cells = bool(m.inverse_diagonal);
  const Corners<const T> diagonal =
      cells ? Corners<const T>(m.inverse_diagonal, j, parity) : Corners<const T>{};
  const Range row{0, half_count(d.p.columns, parity)};
  for (const Span span : spans)
    for_cells_of_row<T>(
        d.p.columns, parity, within(row, span, parity),
        [&](auto lane, auto zero, int k, bool has_west, bool has_east) {
          using B = decltype(zero);
          JumpSums<B> jump{zero, zero};
          if constexpr (kJump) jump = jumps(lane, zero, k, has_west, has_east);
          // A side of the first and of the last cell lies on the fixed boundary.
          const T w = T(has_west), e = T(has_east);
          CornerInverse<B> at{B(w * south), B(e * south), B(w * north), B(e * north)};
          if (cells)
            at = {lane.load(diagonal.n00 + k), lane.load(diagonal.n10 + k),
                  lane.load(diagonal.n01 + k), lane.load(diagonal.n11 + k)};
          relax_volume(lane, zero, stencil, x, y, g, p, compliance(lane, zero, k), jump, B(floor),
                       at, k);
        });
}

template <class T>
[[gnu::flatten]] void relax_volume_row(const Membrane<T>& m, const Unknowns<const T>& f,
                                       const Unknowns<T>& d, int parity, Spans cells, int j) {
  if (m.pressure_jump > T(0))
    relax_volume_cells<true>(m, f, d, parity, cells, j);
  else
    relax_volume_cells<false>(m, f, d, parity, cells, j);
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
