// SPDX-License-Identifier: MIT
#pragma once
// Rows of the relaxation: coloured, D-weighted Kaczmarz on the volume rows.
//
// Cells of one column parity in a row share no node. A whole row takes both parities in one loop,
// which loads and stores every node once where the parities one after the other do it twice: .57 to
// .66 of the time at 128² to 1672² (AVX-512). Odd before even cells goes from west to east: an even
// cell shares its west nodes with the odd cell before, which is of the same batch but for one lane.
// Even before odd cells goes from east to west. The result is that of the parities one after the
// other, bit for bit.
#include <array>

#include "elastic_body.h"
#include "pressure_jump.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// What a volume row has beside its corners: f, dP, A/kappa, the jump term; `share` 0: the row is
/// left as it is, 1: relaxed.
template <class B>
struct VolumeRow {
  B g, dp, compliance, share;
  JumpSums<B> jump;
};

/// One D-weighted Kaczmarz update of volume rows, B d − A/kappa dP − jump = g:
/// r = g − (B d − A/kappa dP − jump), s = Σ B_i²/K_ii + A/kappa + weight of the jump, d_i += B_i
/// r/(s K_ii), dP −= r/s. `west`, `east`: d; `state_west`, `state_east`: u; `inverse_…`: 1/K_ii, 0
/// on the fixed boundary; `floor` keeps s positive in a cell that has collapsed to a point.
template <bool kJump, class B, class T>
void relax_cell(Sides<B>& west, Sides<B>& east, const Sides<B>& state_west,
                const Sides<B>& state_east, VolumeRow<B>& row, T spacing, T floor,
                const Side<B>& inverse_west, const Side<B>& inverse_east) {
  const B h(spacing), half(T(0.5)), quarter(T(0.25));
  const B d1x = (state_east.x.north - state_west.x.south) + h,
          d1y = (state_east.y.north - state_west.y.south) + h,
          d2x = (state_west.x.north - state_east.x.south) - h,
          d2y = (state_west.y.north - state_east.y.south) + h;
  const B product =
      half * ((d1x * (west.y.north - east.y.south) - d1y * (west.x.north - east.x.south)) +
              ((east.x.north - west.x.south) * d2y - (east.y.north - west.y.south) * d2x));
  B r = row.g - (product - row.compliance * row.dp);
  if constexpr (kJump) r = r + row.jump.difference;
  const B weight = (d2x * d2x + d2y * d2y) * (inverse_east.north + inverse_west.south) +
                   (d1x * d1x + d1y * d1y) * (inverse_west.north + inverse_east.south);
  B s = quarter * weight + (row.compliance + B(floor));
  if constexpr (kJump) s = s + row.jump.weight;
  const B t = row.share * (r / s);
  const B v = half * t;
  row.dp = row.dp - t;
  east.x.north = east.x.north + d2y * (v * inverse_east.north);
  east.y.north = east.y.north - d2x * (v * inverse_east.north);
  west.x.south = west.x.south - d2y * (v * inverse_west.south);
  west.y.south = west.y.south + d2x * (v * inverse_west.south);
  west.x.north = west.x.north - d1y * (v * inverse_west.north);
  west.y.north = west.y.north + d1x * (v * inverse_west.north);
  east.x.south = east.x.south + d1y * (v * inverse_east.south);
  east.y.south = east.y.south - d1x * (v * inverse_east.south);
}

/// What relax_cell takes that is the same in a row: spacing, floor, 1/K_ii in a constant membrane.
template <class T>
struct VolumeConstants {
  T spacing, floor, south, north;
  VolumeConstants(const Membrane<T>& m, int j, int rows)
      : spacing(m.spacing), floor(T(1e-6) * m.spacing * m.spacing / (T(4) * m.mu.value)) {
    const T inverse = T(1) / (T(4) * m.mu.value);
    south = j > 0 ? inverse : T(0);
    north = j + 1 < rows ? inverse : T(0);
  }
};

/// Volume rows of the cells of columns 2k + parity in some spans of row j.
template <bool kJump, class T>
void relax_volume_cells(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<T>& d,
                        int parity, Spans spans, int j) {
  const CellCompliance<T> compliance(m, j, parity);
  const PressureJump<T> jumps(m, d.p, j, parity);
  const VolumeConstants<T> constants(m, j, d.p.rows);
  const std::ptrdiff_t stride = d.x.stride, state_stride = m.ux.stride;
  const T* g = f.p.half(j, parity);
  T* p = d.p.half(j, parity);
  // Column 2k + parity of a node field, and the next one.
  const auto west_of = [&](const auto& plane) { return plane.half(j, parity); };
  const auto east_of = [&](const auto& plane) { return plane.half(j, 1 - parity) + parity; };
  const Range row{0, half_count(d.p.columns, parity)};
  for (const Span span : spans)
    for_cells_of_row<T>(
        d.p.columns, parity, within(row, span, parity),
        [&](auto lane, auto zero, int k, bool has_west, bool has_east) {
          using B = decltype(zero);
          VolumeRow<B> cell{
              lane.load(g + k), lane.load(p + k), compliance(lane, zero, k), B(T(1)), {zero, zero}};
          if constexpr (kJump) cell.jump = jumps(lane, zero, k, has_west, has_east);
          // A side of the first and of the last cell lies on the fixed boundary.
          const T w = T(has_west), e = T(has_east);
          Side<B> inverse_west{B(w * constants.south), B(w * constants.north)},
              inverse_east{B(e * constants.south), B(e * constants.north)};
          if (const auto& plane = m.inverse_diagonal) {
            inverse_west = load_side<B>(lane, west_of(plane) + k, plane.stride);
            inverse_east = load_side<B>(lane, east_of(plane) + k, plane.stride);
          }
          Sides<B> west = load_sides<B>(lane, west_of(d.x) + k, west_of(d.y) + k, stride),
                   east = load_sides<B>(lane, east_of(d.x) + k, east_of(d.y) + k, stride);
          relax_cell<kJump>(west, east,
                            load_sides<B>(lane, west_of(m.ux) + k, west_of(m.uy) + k, state_stride),
                            load_sides<B>(lane, east_of(m.ux) + k, east_of(m.uy) + k, state_stride),
                            cell, constants.spacing, constants.floor, inverse_west, inverse_east);
          lane.store(cell.dp, p + k);
          store_side(lane, east.x, east_of(d.x) + k, stride);
          store_side(lane, east.y, east_of(d.y) + k, stride);
          store_side(lane, west.x, west_of(d.x) + k, stride);
          store_side(lane, west.y, west_of(d.y) + k, stride);
        });
}

template <class T>
[[gnu::flatten]] void relax_volume_spans(const Membrane<T>& m, const Unknowns<const T>& f,
                                         const Unknowns<T>& d, int parity, Spans cells, int j) {
  if (m.pressure_jump > T(0))
    relax_volume_cells<true>(m, f, d, parity, cells, j);
  else
    relax_volume_cells<false>(m, f, d, parity, cells, j);
}

/// Sixteen lanes of 1, of which one may be 0.
template <class T>
const T* ones_but(int lane) {
  static constexpr std::array<T, 33> kOnes = [] {
    std::array<T, 33> ones{};
    for (T& one : ones) one = T(1);
    ones[16] = T(0);
    return ones;
  }();
  return kOnes.data() + (lane < 0 || lane > 15 ? 0 : 16 - lane);
}

/// Both parities of row j: the cells of columns 2k and 2k + 1 at a time, whose nodes are in columns
/// 2k (even), 2k + 1 (odd) and 2k + 2 (next).
template <bool kJump, class T>
struct VolumePairs {
  VolumeConstants<T> constants;
  std::ptrdiff_t stride, odd, state_stride, inverse_stride;
  T *x, *y, *p[2];
  const T *ux, *uy, *g[2], *inverse = nullptr, *share[2];
  CellCompliance<T> compliance[2];
  PressureJump<T> jumps[2];
  int last_odd, last_next;  ///< k at which an odd node or the next one lies on the fixed boundary

  VolumePairs(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<T>& d,
              const SplitRow<const T>& of_cells, int j)
      : constants(m, j, d.p.rows),
        stride(d.x.stride),
        odd(d.x.odd),
        state_stride(m.ux.stride),
        inverse_stride(m.inverse_diagonal.stride),
        x(d.x.half(j, 0)),
        y(d.y.half(j, 0)),
        p{d.p.half(j, 0), d.p.half(j, 1)},
        ux(m.ux.half(j, 0)),
        uy(m.uy.half(j, 0)),
        g{f.p.half(j, 0), f.p.half(j, 1)},
        share{of_cells.half[0], of_cells.half[1]},
        compliance{{m, j, 0}, {m, j, 1}},
        jumps{{m, d.p, j, 0}, {m, d.p, j, 1}},
        last_odd(d.p.columns % 2 == 1 ? d.p.columns / 2 : -1),
        last_next(d.p.columns % 2 == 0 ? d.p.columns / 2 - 1 : -1) {
    if (m.inverse_diagonal) inverse = m.inverse_diagonal.half(j, 0);
  }

  /// 1/K_ii in the columns at `offset`, of which lane `fixed` lies on the boundary.
  template <class L, class B>
  Side<B> inverse_at(L lane, B, std::ptrdiff_t offset, int fixed) const {
    if (inverse) return load_side<B>(lane, inverse + offset, inverse_stride);
    const B free = lane.load(ones_but<T>(fixed));
    return {B(constants.south) * free, B(constants.north) * free};
  }
  /// dP and mu of the cells beside a cell.
  template <class B>
  struct Beside {
    B dp_west, dp_east, mu_west, mu_east;
  };
  /// d and u in the columns at `offset`, and 1/K_ii.
  template <class B>
  struct Column {
    Sides<B> d, u;
    Side<B> inverse;
  };
  template <class L, class B>
  Column<B> column(L lane, B zero, std::ptrdiff_t offset, int fixed) const {
    return {load_sides<B>(lane, x + offset, y + offset, stride),
            load_sides<B>(lane, ux + offset, uy + offset, state_stride),
            inverse_at(lane, zero, offset, fixed)};
  }
  template <class L, class B>
  void store(L lane, const Sides<B>& d, std::ptrdiff_t offset) const {
    store_side(lane, d.x, x + offset, stride);
    store_side(lane, d.y, y + offset, stride);
  }

  /// Cells of one parity between two columns; `beside`: what the jump takes of their neighbours in
  /// the row. Stores dP and returns it.
  template <class L, class B>
  B relax(L lane, B zero, int parity, int k, Column<B>& west, Column<B>& east,
          const Beside<B>& beside) const {
    VolumeRow<B> row{lane.load(g[parity] + k),
                     lane.load(p[parity] + k),
                     compliance[parity](lane, zero, k),
                     share[parity] ? lane.load(share[parity] + k) : B(T(1)),
                     {zero, zero}};
    if constexpr (kJump) {
      const PressureJump<T>& jump = jumps[parity];
      const B free_west = lane.load(ones_but<T>(parity == 0 ? -k : -1)),
              free_east = lane.load(ones_but<T>((parity == 0 ? last_odd : last_next) - k));
      row.jump = jump.sums(
          row.dp,
          {beside.dp_west, beside.dp_east, lane.load(jump.below + k), lane.load(jump.above + k)},
          jump.scale(lane, k, free_west, free_east, beside.mu_west, beside.mu_east), west.u,
          east.u);
    }
    relax_cell<kJump>(west.d, east.d, west.u, east.u, row, constants.spacing, constants.floor,
                      west.inverse, east.inverse);
    lane.store(row.dp, p[parity] + k);
    return row.dp;
  }
  /// Of even cells: dP and mu of the odd cells k − 1 and k. Nothing is read past the ends of a row.
  template <class E, class O, class B>
  Beside<B> beside_even(E at_even, O at_odd, B zero, int k) const {
    if (!kJump) return {zero, zero, zero, zero};
    const auto west = [&](const T* row) {
      return k == 0 ? shifted(zero, at_odd.load(row)) : at_even.load(row + k - 1);
    };
    const T* mu = jumps[1].mu_own;
    return {west(p[1]), at_odd.load(p[1] + k), mu ? west(mu) : zero,
            mu ? at_odd.load(mu + k) : zero};
  }
  /// Of odd cells: dP and mu of the even cells k and k + 1.
  template <class E, class O, class B>
  Beside<B> beside_odd(E at_even, O at_odd, B zero, int k) const {
    if (!kJump) return {zero, zero, zero, zero};
    const auto east = [&](const T* row) {
      return last_next >= 0 && k + int(sizeof(B) / sizeof(T)) > last_next
                 ? shifted_back(at_even.load(row + k), zero)
                 : at_odd.load(row + k + 1);
    };
    const T* mu = jumps[0].mu_own;
    return {at_even.load(p[0] + k), east(p[0]), mu ? at_even.load(mu + k) : zero,
            mu ? east(mu) : zero};
  }
};

/// The cells of odd columns of row j, then those of even columns.
template <bool kJump, class T>
void relax_odd_even(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<T>& d,
                    const SplitRow<const T>& share, int j) {
  const VolumePairs<kJump, T> pairs(m, f, d, share, j);
  const std::ptrdiff_t odd = pairs.odd;
  for_lane_pairs<5, T>(half_count(d.p.columns, 0), half_count(d.p.columns, 1),
                       [&](auto at_even, auto at_odd, auto zero, int k, auto& before) {
                         auto middle = pairs.column(at_even, zero, odd + k, pairs.last_odd - k),
                              next = pairs.column(at_odd, zero, 1 + k, pairs.last_next - k);
                         const auto dual = pairs.relax(at_odd, zero, 1, k, middle, next,
                                                       pairs.beside_odd(at_even, at_odd, zero, k));
                         // Even nodes after the odd cells west of them.
                         auto first = pairs.column(at_even, zero, k, -k);
                         const Sides<decltype(zero)>& now = next.d;
                         first.d = {
                             {shifted(before[0], now.x.south), shifted(before[1], now.x.north)},
                             {shifted(before[2], now.y.south), shifted(before[3], now.y.north)}};
                         auto beside = pairs.beside_even(at_even, at_odd, zero, k);
                         beside.dp_west = shifted(before[4], dual);
                         beside.dp_east = dual;
                         pairs.relax(at_even, zero, 0, k, first, middle, beside);
                         before = {now.x.south, now.x.north, now.y.south, now.y.north, dual};
                         pairs.store(at_even, first.d, k);
                         pairs.store(at_even, middle.d, odd + k);
                       });
}

/// The cells of even columns of row j, then those of odd columns.
template <bool kJump, class T>
void relax_even_odd(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<T>& d,
                    const SplitRow<const T>& share, int j) {
  const VolumePairs<kJump, T> pairs(m, f, d, share, j);
  const std::ptrdiff_t odd = pairs.odd;
  for_lane_pairs_westwards<5, T>(
      half_count(d.p.columns, 0), half_count(d.p.columns, 1),
      [&](auto at_even, auto at_odd, auto zero, int k, auto& before) {
        auto first = pairs.column(at_even, zero, k, -k),
             middle = pairs.column(at_even, zero, odd + k, pairs.last_odd - k);
        const auto dual = pairs.relax(at_even, zero, 0, k, first, middle,
                                      pairs.beside_even(at_even, at_odd, zero, k));
        // The even nodes east of the odd cells after their own cells.
        auto next = pairs.column(at_odd, zero, 1 + k, pairs.last_next - k);
        const Sides<decltype(zero)>& now = first.d;
        next.d = {{shifted_back(now.x.south, before[0]), shifted_back(now.x.north, before[1])},
                  {shifted_back(now.y.south, before[2]), shifted_back(now.y.north, before[3])}};
        auto beside = pairs.beside_odd(at_even, at_odd, zero, k);
        beside.dp_west = dual;
        beside.dp_east = shifted_back(dual, before[4]);
        pairs.relax(at_odd, zero, 1, k, middle, next, beside);
        before = {now.x.south, now.x.north, now.y.south, now.y.north, dual};
        pairs.store(at_even, middle.d, odd + k);
        pairs.store(at_odd, next.d, 1 + k);
      });
}

/// Volume rows of the cells of row j: even columns, then odd ones; `reverse`: odd ones first.
/// `share`: 0 at cells that are left as they are, 1 at others; null: all are relaxed.
template <class T>
[[gnu::flatten]] void relax_volume_row(const Membrane<T>& m, const Unknowns<const T>& f,
                                       const Unknowns<T>& d, bool reverse,
                                       const SplitRow<const T>& share, int j) {
  const bool jump = m.pressure_jump > T(0);
  if (reverse && jump) return relax_odd_even<true>(m, f, d, share, j);
  if (reverse) return relax_odd_even<false>(m, f, d, share, j);
  if (jump) return relax_even_odd<true>(m, f, d, share, j);
  relax_even_odd<false>(m, f, d, share, j);
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
