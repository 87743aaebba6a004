// SPDX-License-Identifier: MIT
#pragma once
// Rows of the coarse operators of isotropic membranes: one symmetric 4×4 tangent a cell, on (a₁,
// a₂, b₁, b₂), the mean over all points of all the finest cells that it covers. For displacements
// linear in the cell it stores what the finest lattice stores. Rediscretising at the injected x̂ was
// tried and lost: it does not see thin stiff layers along curves (neohookean, kappa 1, 128²: 134
// cycles on S1 instead of 46), and an evaluation of the law costs several times as much (work units
// of whole solves: neohookean S4 666 instead of 403, arap S4 761 instead of 315).
#include "isotropic_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

template <class B>
struct CellTangent {
  B at[kTangentEntries];
  void apply(const Split<B>& f, B& a1, B& a2, B& b1, B& b2) const {
    a1 = (at[0] * f.a1 + at[1] * f.a2) + (at[2] * f.b1 + at[3] * f.b2);
    a2 = (at[1] * f.a1 + at[4] * f.a2) + (at[5] * f.b1 + at[6] * f.b2);
    b1 = (at[2] * f.a1 + at[5] * f.a2) + (at[7] * f.b1 + at[8] * f.b2);
    b2 = (at[3] * f.a1 + at[6] * f.a2) + (at[8] * f.b1 + at[9] * f.b2);
  }
};

/// Entry e of cell row j: a plane holds the entries one after the other, cells.rows/10 rows each.
template <class T>
const T* entry_row(const Plane<const T>& cells, int e, int j, int parity) {
  return cells.half(e * (cells.rows / kTangentEntries) + j, parity);
}

/// Cell row j of the tangents of a membrane at its state: out[e] is a row of entry e.
template <class Model, class T>
[[gnu::flatten]] void cell_tangent_row(const Membrane<T>& m, const SplitRow<T>* out, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const CellReader<T> reader(m, j, parity);
    T* row[kTangentEntries];
    for (int e = 0; e < kTangentEntries; ++e) row[e] = out[e].half[parity];
    for_lanes<T>(0, half_count(m.ux.columns - 1, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const CellState<T, B> cell = reader.read(lane, zero, k);
      B sum[kTangentEntries];
      for (B& entry : sum) entry = zero;
      for_points<T, Model>(cell, [&](auto density, T s, T t, const Parameters<B>& c) {
        B part[kTangentEntries];
        Tangent<T, B>(density, cell.at(s, t), c, B(m.clamp_width)).entries(part);
        for (int e = 0; e < kTangentEntries; ++e) sum[e] = sum[e] + part[e];
      });
      for (int e = 0; e < kTangentEntries; ++e) lane.store(B(T(0.25)) * sum[e], row[e] + k);
    });
  }
}

/// Reads the tangents of the cells of columns 2k + parity in row j.
template <class T>
struct TangentReader {
  const T* row[kTangentEntries];
  TangentReader(const Membrane<T>& m, int j, int parity) {
    for (int e = 0; e < kTangentEntries; ++e) row[e] = entry_row(m.tangent, e, j, parity);
  }
  template <class L, class B>
  CellTangent<B> read(L lane, B, int k) const {
    CellTangent<B> tangent;
    for (int e = 0; e < kTangentEntries; ++e) tangent.at[e] = lane.load(row[e] + k);
    return tangent;
  }
};

template <class T>
[[gnu::flatten]] void averaged_product_row(const Membrane<T>& m, const Unknowns<const T>& d,
                                           const Unknowns<T>& out, bool first, int j) {
  two_parities<T>({out.x, out.y}, first, j, [&](int parity, bool fresh) {
    const TangentReader<T> reader(m, j, parity);
    const Corners<const T> dx(d.x, j, parity), dy(d.y, j, parity);
    const TwoRows<T> x(out.x, j, parity), y(out.y, j, parity);
    for_lanes<T>(0, half_count(d.x.columns - 1, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const CellTangent<B> tangent = reader.read(lane, zero, k);
      const CellState<T, B> change{edge_differences(lane, zero, dx, dy, k), {}, {}};
      EdgeSums<T, B> sum(zero);
      for (const double t : GaussPoints::at)
        for (const double s : GaussPoints::at) {
          B a1, a2, b1, b2;
          tangent.apply(change.at(T(s), T(t)), a1, a2, b1, b2);
          sum.add(T(s), T(t), a1, a2, b1, b2);
        }
      scatter_edges(lane, sum, B(T(0.125)), x, y, fresh, k);
    });
  });
}

template <class T>
[[gnu::flatten]] void averaged_diagonal_row(const Membrane<T>& m, const Plane<T>* block, bool first,
                                            int j) {
  diagonal_row<T>(block, first, j, [&](int parity) {
    return [reader = TangentReader<T>(m, j, parity)](auto lane, auto zero, int k, auto&& add) {
      const CellTangent<decltype(zero)> tangent = reader.read(lane, zero, k);
      for (const double t : GaussPoints::at)
        for (const double s : GaussPoints::at) add(tangent, T(s), T(t));
    };
  });
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
