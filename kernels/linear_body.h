// SPDX-License-Identifier: MIT
#pragma once
// Rows of H d and of f − H d where there are pressures, cell by cell: the diagonals of a cell serve
// its volume row and the forces on its four corners. With d1 = x̂11 − x̂00, d2 = x̂01 − x̂10 and e1, e2
// the same of d, half of g2 = dP d2 + P_H e2, turned by a quarter, (g2y, −g2x), acts on corner 11,
// minus that on 00; half of g1 = dP d1 + P_H e1, turned likewise, acts on 10, minus that on 01.
//
// This is 67 operations a node; node by node, from differences of pressures along edges
// (stencil.h), it is a hundred, since every node clamps four pressures and the cells' diagonals
// come on top. A large pressure that is the same everywhere rounds like |P| |e| here, there it
// drops out before.
//
// Both parities in one loop: a pair of columns shares its loads, and only the cell west of an even
// node is of another batch; its g is handed on in registers.
#include "elastic_body.h"
#include "kernel_table.h"
#include "pressure_jump.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// A node field at columns 2k, 2k + 1 and 2k + 2 of row j, and of the row above (_n).
template <class B>
struct PairNodes {
  B even, odd, east, even_n, odd_n, east_n;
};
template <class E, class O, class T>
auto pair_nodes(E at_even, O at_odd, const T* row, std::ptrdiff_t odd, std::ptrdiff_t stride) {
  using B = decltype(at_even.load(row));
  return PairNodes<B>{at_even.load(row),
                      at_even.load(row + odd),
                      at_odd.load(row + 1),
                      at_even.load(row + stride),
                      at_even.load(row + (stride + odd)),
                      at_odd.load(row + 1 + stride)};
}

/// The diagonals of a cell, 11 − 00 and 01 − 10.
template <class B>
struct Diagonals {
  B x1, y1, x2, y2;
};
template <class B>
Diagonals<B> even_diagonals(const PairNodes<B>& x, const PairNodes<B>& y) {
  return {x.odd_n - x.even, y.odd_n - y.even, x.even_n - x.odd, y.even_n - y.odd};
}
template <class B>
Diagonals<B> odd_diagonals(const PairNodes<B>& x, const PairNodes<B>& y) {
  return {x.east_n - x.odd, y.east_n - y.odd, x.odd_n - x.east, y.odd_n - y.east};
}
/// Of positions from those of displacements.
template <class B>
Diagonals<B> positions(const Diagonals<B>& u, B h) {
  return {u.x1 + h, u.y1 + h, u.x2 - h, u.y2 + h};
}

/// g1 and g2 of a cell.
template <class B>
struct CellForces {
  B x1, y1, x2, y2;
};
template <class B>
CellForces<B> cell_forces(B dual, const Diagonals<B>& d, B primal, const Diagonals<B>& e) {
  return {dual * d.x1 + primal * e.x1, dual * d.y1 + primal * e.y1, dual * d.x2 + primal * e.x2,
          dual * d.y2 + primal * e.y2};
}

/// The cells of one parity in row j: their volume row and their forces.
template <bool kResidual, bool kMuCells, class T>
struct CellPass {
  const T *p, *dp, *mu_cells = nullptr, *f = nullptr;
  T* out;
  T centre, width, bound, spacing, area;
  T constant[16];       ///< 1/kappa where it is the same everywhere
  const T* compliance;  ///< 1/kappa of cell k at k·step
  std::ptrdiff_t step;

  CellPass(const Membrane<T>& m, const Unknowns<const T>* right, const Unknowns<const T>& d,
           const LinearRow<T>& row, int j, int parity)
      : p(m.pressure.half(j, parity)),
        dp(d.p.half(j, parity)),
        out(row.p.half[parity]),
        centre(m.clamp_centre),
        width(m.clamp_width),
        bound(m.clamp_width * m.mu.value),
        spacing(m.spacing),
        area(m.spacing * m.spacing),
        compliance(m.compliance.cells ? m.compliance.cells.half(j, parity) : constant),
        step(m.compliance.cells ? 1 : 0) {
    for (T& value : constant) value = m.compliance.value;
    if constexpr (kMuCells) mu_cells = m.mu.cells.half(j, parity);
    if constexpr (kResidual) f = right->p.half(j, parity);
  }
  [[gnu::always_inline]] void prefetch(int k, std::ptrdiff_t stride) const {
    for (const T* at : {p, dp, static_cast<const T*>(out)}) ask(at + k + stride);
    if constexpr (kResidual) ask(f + k + stride);
  }
  /// P_H.
  template <class L, class B>
  B primal(L lane, B zero, int k) const {
    B limit(bound);
    if constexpr (kMuCells) limit = B(width) * lane.load(mu_cells + k);
    return larger(smaller(lane.load(p + k) - B(centre), limit), zero - limit);
  }
  /// The volume row and the forces where the diagonals of u are `u`, those of d `e`.
  template <class L, class B>
  CellForces<B> apply(L lane, B zero, int k, const Diagonals<B>& u, const Diagonals<B>& e,
                      B& volume) const {
    const Diagonals<B> d = positions(u, B(spacing));
    const B dual = lane.load(dp + k), per_kappa = B(area) * lane.load(compliance + k * step);
    volume =
        B(T(0.5)) * ((d.x1 * e.y2 - d.y1 * e.x2) + (e.x1 * d.y2 - e.y1 * d.x2)) - per_kappa * dual;
    if constexpr (kResidual) volume = lane.load(f + k) - volume;
    return cell_forces(dual, d, primal(lane, zero, k), e);
  }
};

/// The nodes of one parity in row j, between two cells of that row; `carried` holds what the two
/// cells south of them add.
template <bool kResidual, bool kMuCells, class T>
struct NodePass {
  NodeStencil<T, false, kMuCells> stencil;
  T *carried_x, *carried_y, *out_x, *out_y;
  const T *fx = nullptr, *fy = nullptr;

  NodePass(const Membrane<T>& m, const Unknowns<const T>* f, const Unknowns<const T>& d,
           const LinearRow<T>& row, int j, int parity)
      : stencil(m, d, j, parity),
        carried_x(row.carried_x.half[parity]),
        carried_y(row.carried_y.half[parity]),
        out_x(row.x.half[parity]),
        out_y(row.y.half[parity]) {
    if constexpr (kResidual) {
      fx = f->x.half(j, parity);
      fy = f->y.half(j, parity);
    }
  }
  [[gnu::always_inline]] void prefetch(int k, std::ptrdiff_t stride) const {
    for (const T* at : {out_x, out_y}) ask(at + k + stride);
    if constexpr (kResidual)
      for (const T* at : {fx, fy}) ask(at + k + stride);
  }
  /// `mu`: around the nodes, if it is not constant; `x`, `y`: d at the nodes and their neighbours.
  template <class L, class B>
  void apply(L lane, B zero, int k, const FourCells<B>& mu, const FiveNodes<B>& x,
             const FiveNodes<B>& y, const CellForces<B>& west, const CellForces<B>& east, B& hx,
             B& hy) const {
    stencil.membrane(zero, mu, x, y, hx, hy);
    const B half(T(0.5));
    hx = hx + half * (lane.load(carried_x + k) + (west.y1 - east.y2));
    hy = hy - half * (lane.load(carried_y + k) + (west.x1 - east.x2));
    if constexpr (kResidual) {
      hx = lane.load(fx + k) - hx;
      hy = lane.load(fy + k) - hy;
    }
  }
  /// mu around even nodes, without reading past column 0.
  template <class E, class O, class B>
  FourCells<B> mu_around_even(E at_even, O at_odd, B zero, int k) const {
    if constexpr (!kMuCells) return {};
    const CellsAtNode<T>& mu = stencil.mu_cells;
    const auto west = [&](const T* row) {
      return k == 0 ? shifted(zero, at_odd.load(row + 1)) : at_even.load(row + k);
    };
    return {west(mu.sw), at_even.load(mu.se + k), west(mu.nw), at_even.load(mu.ne + k)};
  }
  template <class L, class B>
  void store(L lane, int k, const CellForces<B>& west, const CellForces<B>& east, B hx,
             B hy) const {
    lane.store(west.y2 - east.y1, carried_x + k);
    lane.store(west.x2 - east.x1, carried_y + k);
    lane.store(hx, out_x + k);
    lane.store(hy, out_y + k);
  }
};

template <bool kResidual, bool kMuCells, class T>
void linear_row_of(const Membrane<T>& m, const Unknowns<const T>* f, const Unknowns<const T>& d,
                   const LinearRow<T>& out, int j) {
  using Cells = CellPass<kResidual, kMuCells, T>;
  using Nodes = NodePass<kResidual, kMuCells, T>;
  const Cells even_cells(m, f, d, out, j, 0), odd_cells(m, f, d, out, j, 1);
  // Of row 0 nothing is wanted: it takes row 1's stencil.
  const Nodes even_nodes(m, f, d, out, j > 0 ? j : 1, 0), odd_nodes(m, f, d, out, j > 0 ? j : 1, 1);
  const std::ptrdiff_t odd = d.x.odd, stride = d.x.stride, cell_stride = d.p.stride;
  const T *const ux = m.ux.half(j, 0), *const uy = m.uy.half(j, 0), *const dx = d.x.half(j, 0),
                 *const dy = d.y.half(j, 0);
  // The loop writes column 0, too, which lies on the fixed boundary.
  const T kept_x = *out.x.half[0], kept_y = *out.y.half[0];
  for_lane_pairs<4, T>(
      half_count(d.p.columns, 0), half_count(d.p.columns, 1),
      [&](auto at_even, auto at_odd, auto zero, int k, auto& west_odd) {
        using B = decltype(zero);
        for (const T* at : {ux, uy, dx, dy}) {
          ask(at + k + 2 * stride);
          ask(at + k + (2 * stride + odd));
        }
        even_cells.prefetch(k, cell_stride);
        odd_cells.prefetch(k, cell_stride);
        even_nodes.prefetch(k, stride);
        odd_nodes.prefetch(k, stride);
        const PairNodes<B> x = pair_nodes(at_even, at_odd, dx + k, odd, stride),
                           y = pair_nodes(at_even, at_odd, dy + k, odd, stride),
                           vx = pair_nodes(at_even, at_odd, ux + k, odd, stride),
                           vy = pair_nodes(at_even, at_odd, uy + k, odd, stride);
        B even_volume, odd_volume;
        const CellForces<B> e = even_cells.apply(at_even, zero, k, even_diagonals(vx, vy),
                                                 even_diagonals(x, y), even_volume);
        const CellForces<B> o = odd_cells.apply(at_odd, zero, k, odd_diagonals(vx, vy),
                                                odd_diagonals(x, y), odd_volume);
        const CellForces<B> w{shifted(west_odd[0], o.x1), shifted(west_odd[1], o.y1),
                              shifted(west_odd[2], o.x2), shifted(west_odd[3], o.y2)};
        west_odd = {o.x1, o.y1, o.x2, o.y2};
        B even_x, even_y, odd_x, odd_y;
        auto even_five = [&](const PairNodes<B>& d, const AtNode<T>& at) {
          const B west = k == 0 ? shifted(zero, d.odd) : at_even.load(at.e + k - 1);
          return FiveNodes<B>{d.even, west, d.odd, at_even.load(at.s + k), d.even_n};
        };
        auto odd_five = [&](const PairNodes<B>& d, const AtNode<T>& at) {
          return FiveNodes<B>{d.odd, d.even, d.east, at_odd.load(at.s + k), d.odd_n};
        };
        even_nodes.apply(at_even, zero, k, even_nodes.mu_around_even(at_even, at_odd, zero, k),
                         even_five(x, even_nodes.stencil.dx), even_five(y, even_nodes.stencil.dy),
                         w, e, even_x, even_y);
        odd_nodes.apply(at_odd, zero, k, odd_nodes.stencil.mu_around(at_odd, k),
                        odd_five(x, odd_nodes.stencil.dx), odd_five(y, odd_nodes.stencil.dy), e, o,
                        odd_x, odd_y);
        // Stores last: a load after a store would not be shared with one before it.
        even_nodes.store(at_even, k, w, e, even_x, even_y);
        odd_nodes.store(at_odd, k, e, o, odd_x, odd_y);
        at_even.store(even_volume, even_cells.out + k);
        at_odd.store(odd_volume, odd_cells.out + k);
      });
  *out.x.half[0] = kept_x;
  *out.y.half[0] = kept_y;
  if (m.pressure_jump > T(0)) add_pressure_jump_row(m, d.p, T(kResidual ? 1 : -1), out.p, j);
}

/// Row j of f − H d (kResidual) or of H d, see LinearRow, the jump term included.
template <bool kResidual, class T>
[[gnu::flatten]] void linear_row(const Membrane<T>& m, const Unknowns<const T>* f,
                                 const Unknowns<const T>& d, const LinearRow<T>& out, int j) {
  if (m.mu.cells)
    linear_row_of<kResidual, true>(m, f, d, out, j);
  else
    linear_row_of<kResidual, false>(m, f, d, out, j);
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
