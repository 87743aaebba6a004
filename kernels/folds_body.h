// SPDX-License-Identifier: MIT
#pragma once
// J of the cells of one row, in rows of nodes as pictures have them, not split.
#include <bit>
#include <cstdint>

#include <drumhead/kernels/folds.h>
#include <drumhead/kernels/views.h>

#include "batch.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// A number's bits as an integer of the same order; a minimum of those vectorises.
inline std::int64_t in_order(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits ^ ((bits >> 63) & 0x7fffffffffffffff);
}
inline double from_order(std::int64_t key) {
  return std::bit_cast<double>(key ^ ((key >> 63) & 0x7fffffffffffffff));
}

/// u, v: displacements of the nodes below and, `cells` + 1 further, above; `scale`: 1/h.
[[gnu::flatten]] inline void folds_row(const double* u, const double* v, int cells, double scale,
                                       const Columns& left_out, RowFolds& folds) {
  constexpr int kChunk = 256;
  double centre[kChunk], least[kChunk];
  std::int64_t centre_key = in_order(folds.least_J), least_key = in_order(folds.least_corner_J);
  const double *u_above = u + cells + 1, *v_above = v + cells + 1;
  for (int begin = 0; begin < cells; begin += kChunk) {
    const int end = begin + kChunk < cells ? begin + kChunk : cells;
    for_lanes<double>(begin, end, [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const B h(scale), one(1.0);
      const B x00 = h * lane.load(u + k), y00 = h * lane.load(v + k);
      const B x10 = one + h * lane.load(u + k + 1), y10 = h * lane.load(v + k + 1);
      const B x01 = h * lane.load(u_above + k), y01 = one + h * lane.load(v_above + k);
      const B x11 = one + h * lane.load(u_above + k + 1);
      const B y11 = one + h * lane.load(v_above + k + 1);
      auto cross = [](B ax, B ay, B bx, B by) { return ax * by - ay * bx; };
      const B mean = B(0.5) * cross(x11 - x00, y11 - y00, x01 - x10, y01 - y10);
      const B south_west = cross(x10 - x00, y10 - y00, x01 - x00, y01 - y00);
      const B south_east = cross(x10 - x00, y10 - y00, x11 - x10, y11 - y10);
      const B north_west = cross(x11 - x01, y11 - y01, x01 - x00, y01 - y00);
      const B north_east = cross(x11 - x01, y11 - y01, x11 - x10, y11 - y10);
      const B south = smaller(smaller(one, south_west), south_east);
      // −0 becomes 0, which is no fold.
      lane.store(smaller(one, mean) + zero, centre + (k - begin));
      lane.store(smaller(smaller(south, north_west), north_east) + zero, least + (k - begin));
    });
    for (const int i : left_out)
      if (i >= begin && i < end) centre[i - begin] = least[i - begin] = 1.0;
    int inverted = 0, folded = 0;
    for (int k = 0; k < end - begin; ++k) {
      const std::int64_t c = in_order(centre[k]), l = in_order(least[k]);
      centre_key = c < centre_key ? c : centre_key;
      least_key = l < least_key ? l : least_key;
      inverted += c < 0;
      folded += l < 0;
    }
    folds.inverted += inverted;
    folds.folded += folded;
  }
  folds.least_J = from_order(centre_key);
  folds.least_corner_J = from_order(least_key);
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
