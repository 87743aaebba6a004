// SPDX-License-Identifier: MIT
#pragma once
// Rows of the transfers between a lattice and its coarser one. Coarse node (I, J) lies on fine node
// (2I, 2J), coarse cell (I, J) covers fine cells (2I…2I+1, 2J…2J+1), as far as they exist: where
// the fine count is odd the last coarse cell overhangs the fixed edge. A coarse row is joined into
// natural column order in a small buffer, where it lines up with both halves of a fine row.
#include <drumhead/kernels/views.h>
#include "batch.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

constexpr int kBuffer = 512;

/// out[k] = value at column begin + k of a split row; begin even.
template <class T>
[[gnu::flatten]] void join_row(const SplitRow<const T>& row, int begin, int count, T* out) {
  const T *even = row.half[0] + begin / 2, *odd = row.half[1] + begin / 2;
  const int pairs = count / 2;
  for (int k = 0; k < pairs; ++k) {
    out[2 * k] = even[k];
    out[2 * k + 1] = odd[k];
  }
  if (count & 1) out[count - 1] = even[pairs];
}
/// The mean of two rows.
template <class T>
[[gnu::flatten]] void join_mean_row(const SplitRow<const T>& a, const SplitRow<const T>& b,
                                    int begin, int count, T* out) {
  const T *a_even = a.half[0] + begin / 2, *a_odd = a.half[1] + begin / 2;
  const T *b_even = b.half[0] + begin / 2, *b_odd = b.half[1] + begin / 2;
  const int pairs = count / 2;
  for (int k = 0; k < pairs; ++k) {
    out[2 * k] = T(0.5) * (a_even[k] + b_even[k]);
    out[2 * k + 1] = T(0.5) * (a_odd[k] + b_odd[k]);
  }
  if (count & 1) out[count - 1] = T(0.5) * (a_even[pairs] + b_even[pairs]);
}
template <class T>
[[gnu::flatten]] void split_row(const T* in, int begin, int count, const SplitRow<T>& row) {
  T *even = row.half[0] + begin / 2, *odd = row.half[1] + begin / 2;
  const int pairs = count / 2;
  for (int k = 0; k < pairs; ++k) {
    even[k] = in[2 * k];
    odd[k] = in[2 * k + 1];
  }
  if (count & 1) even[pairs] = in[count - 1];
}

/// Fine node row j (+)= bilinear interpolation of the coarse nodes; the fixed boundary is left
/// alone.
template <bool kAdd, class T>
[[gnu::flatten]] void prolong_nodes_row(const Plane<const T>& coarse, const Plane<T>& fine, int j) {
  T natural[kBuffer + 2];
  const int last = fine.columns - 2;  // last interior column
  for (int begin = 0; 2 * begin <= last; begin += kBuffer) {
    int count = coarse.columns - begin;
    if (count > kBuffer + 1) count = kBuffer + 1;
    if (j & 1)
      join_mean_row<T>(coarse.row(j / 2), coarse.row(j / 2 + 1), begin, count, natural);
    else
      join_row<T>(coarse.row(j / 2), begin, count, natural);
    T *even = fine.half(j, 0) + begin, *odd = fine.half(j, 1) + begin;
    auto ends = [&](int parity) {
      const int all = half_count(last + 1, parity) - begin;
      return all < kBuffer ? all : kBuffer;
    };
    for_lanes<T>(begin == 0 ? 1 : 0, ends(0), [&](auto lane, auto, int k) {
      auto value = lane.load(natural + k);
      if constexpr (kAdd) value = lane.load(even + k) + value;
      lane.store(value, even + k);
    });
    for_lanes<T>(0, ends(1), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      B value = B(T(0.5)) * (lane.load(natural + k) + lane.load(natural + k + 1));
      if constexpr (kAdd) value = lane.load(odd + k) + value;
      lane.store(value, odd + k);
    });
  }
}

/// Coarse node row J = adjoint of the bilinear interpolation of three fine rows 2J−1, 2J, 2J+1;
/// `above` null where row 2J+1 does not exist or is fixed. Fine values on the fixed boundary must
/// be 0.
template <class T>
[[gnu::flatten]] void restrict_nodes_row(const SplitRow<const T>& below,
                                         const SplitRow<const T>& middle,
                                         const SplitRow<const T>* above, int fine_columns,
                                         const Plane<T>& coarse, int j) {
  T column[2][kBuffer + 2], natural[kBuffer];
  const int end = coarse.columns - 1;  // interior coarse columns are [1, end)
  for (int begin = 0; begin < end; begin += kBuffer) {
    const int count = end - begin < kBuffer ? end - begin : kBuffer;
    // Vertical weights ½, 1, ½; the odd half starts one element early, at fine column 2 begin − 1.
    for (int parity = 0; parity < 2; ++parity) {
      const int available = half_count(fine_columns, parity) - begin;
      const int n = count < available ? count : available;
      const T *b = below.half[parity] + begin, *m = middle.half[parity] + begin;
      const T* a = above ? above->half[parity] + begin : nullptr;
      T* out = column[parity] + 1;
      out[-1] = T(0);
      out[count - 1] = T(0);
      auto vertical = [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        const B outer = a ? lane.load(b + k) + lane.load(a + k) : lane.load(b + k);
        lane.store(lane.load(m + k) + B(T(0.5)) * outer, out + k);
      };
      for_lanes<T>(0, n, vertical);
      if (parity == 1 && begin > 0) vertical(Lane<T>{}, T(0), -1);
    }
    for_lanes<T>(0, count, [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const B sides = lane.load(column[1] + k) + lane.load(column[1] + k + 1);
      lane.store(lane.load(column[0] + 1 + k) + B(T(0.5)) * sides, natural + k);
    });
    if (begin == 0) natural[0] = T(0);
    split_row(natural, begin, count, coarse.row(j));
  }
}

/// Coarse node row J = fine node row 2J at the same places; interior columns only.
template <class T>
[[gnu::flatten]] void inject_nodes_row(const Plane<const T>& fine, const Plane<T>& coarse, int j) {
  const T* even = fine.half(2 * j, 0);
  for (int begin = 0; begin < coarse.columns - 1; begin += kBuffer) {
    const int rest = coarse.columns - 1 - begin;
    split_row(even + begin, begin, rest < kBuffer ? rest : kBuffer, coarse.row(j));
  }
}

/// Both halves of fine cell row j += the coarse cell's value: constant interpolation.
template <class T>
[[gnu::flatten]] void prolong_cells_row(const Plane<const T>& coarse, const Plane<T>& fine, int j) {
  T natural[kBuffer];
  for (int begin = 0; begin < coarse.columns; begin += kBuffer) {
    const int rest = coarse.columns - begin, count = rest < kBuffer ? rest : kBuffer;
    join_row<T>({{coarse.half(j / 2, 0), coarse.half(j / 2, 1)}}, begin, count, natural);
    for (int parity = 0; parity < 2; ++parity) {
      T* out = fine.half(j, parity) + begin;
      const int available = half_count(fine.columns, parity) - begin;
      for_lanes<T>(0, count < available ? count : available, [&](auto lane, auto, int k) {
        lane.store(lane.load(out + k) + lane.load(natural + k), out + k);
      });
    }
  }
}

/// Coarse cell row J = sum (or mean) of the fine cells it covers; `above` null where row 2J+1 does
/// not exist.
template <bool kMean, class T>
[[gnu::flatten]] void gather_cells_row(const SplitRow<const T>& below,
                                       const SplitRow<const T>* above, int fine_columns,
                                       const Plane<T>& coarse, int j) {
  T natural[kBuffer];
  const T rows = above ? T(2) : T(1);
  for (int begin = 0; begin < coarse.columns; begin += kBuffer) {
    const int rest = coarse.columns - begin, count = rest < kBuffer ? rest : kBuffer;
    const int odd_columns = half_count(fine_columns, 1) - begin;
    auto gather = [&](bool both) {
      return [&, both](auto lane, auto zero, int k) {
        using B = decltype(zero);
        auto column = [&](int parity) {
          B value = lane.load(below.half[parity] + begin + k);
          if (above) value = value + lane.load(above->half[parity] + begin + k);
          return value;
        };
        B sum = column(0);
        if (both) sum = sum + column(1);
        if constexpr (kMean) sum = sum * B(T(1) / (both ? T(2) * rows : rows));
        lane.store(sum, natural + k);
      };
    };
    const int complete = count < odd_columns ? count : odd_columns;
    for_lanes<T>(0, complete, gather(true));
    for_lanes<T>(complete, count, gather(false));
    split_row(natural, begin, count, coarse.row(j));
  }
}

/// Fine cell row j = bilinear interpolation between coarse cell centres (weights 9, 3, 3, 1 in 16),
/// constant beyond the outermost centres. Not the transfer of the cycles: it starts a finer level
/// of the nested iteration.
template <class T>
[[gnu::flatten]] void interpolate_cells_row(const Plane<const T>& coarse, const Plane<T>& fine,
                                            int j) {
  T natural[kBuffer + 2], other[kBuffer + 2];
  const int near = j / 2, wanted = (j & 1) ? near + 1 : near - 1;
  const int far = wanted < 0 ? 0 : wanted < coarse.rows ? wanted : coarse.rows - 1;
  for (int begin = 0; begin < coarse.columns; begin += kBuffer) {
    const int rest = coarse.columns - begin, count = rest < kBuffer ? rest : kBuffer;
    const int more = rest > kBuffer ? 1 : 0;
    join_row<T>({{coarse.half(near, 0), coarse.half(near, 1)}}, begin, count + more, natural + 1);
    join_row<T>({{coarse.half(far, 0), coarse.half(far, 1)}}, begin, count + more, other + 1);
    natural[0] = begin ? coarse.at(begin - 1, near) : natural[1];
    other[0] = begin ? coarse.at(begin - 1, far) : other[1];
    if (!more) {
      natural[count + 1] = natural[count];
      other[count + 1] = other[count];
    }
    for_lanes<T>(0, count + 2, [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      lane.store(B(T(0.75)) * lane.load(natural + k) + B(T(0.25)) * lane.load(other + k),
                 natural + k);
    });
    for (int parity = 0; parity < 2; ++parity) {
      T* out = fine.half(j, parity) + begin;
      const int available = half_count(fine.columns, parity) - begin;
      for_lanes<T>(0, count < available ? count : available, [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        lane.store(B(T(0.75)) * lane.load(natural + 1 + k) +
                       B(T(0.25)) * lane.load(natural + 2 * parity + k),
                   out + k);
      });
    }
  }
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
