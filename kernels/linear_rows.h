// SPDX-License-Identifier: MIT
#pragma once
// Rows of H d and f − H d one after the other: each leaves to the next what its cells add to the
// nodes above them. What a chunk of rows is given first is computed anew, so that results do not
// depend on where chunks begin.
#include <cassert>
#include <cstdint>
#include <vector>

#include "kernel_table.h"

namespace drumhead::kernels {

/// Rows of one thread. Keeps its memory, which belongs to the calling thread, from call to call.
template <class T>
class LinearRows {
 public:
  explicit LinearRows(int columns) {
    constexpr std::size_t kLine = 64 / sizeof(T);
    const std::size_t half = (std::size_t(columns) / 2 + kLine) / kLine * kLine;
    thread_local std::vector<T> storage;
    if (storage.size() < 10 * half + kLine) storage.assign(10 * half + kLine, T(0));
    const auto address = reinterpret_cast<std::uintptr_t>(storage.data());
    T* at = storage.data() + (64 - address % 64) % 64 / sizeof(T);
    for (SplitRow<T>* row :
         {&unwanted_.x, &unwanted_.y, &unwanted_.p, &unwanted_.carried_x, &unwanted_.carried_y})
      for (T*& part : row->half) {
        part = at;
        at += half;
      }
  }

  /// What the cells south of node row j add to it, before rows j, j + 1, … are asked for.
  void begin(const Membrane<T>& m, const Unknowns<const T>& d, int j) {
    assert(m.ux.stride == d.x.stride && m.ux.odd == d.x.odd);
    if (j > 0) table<T>().apply(m, nullptr, d, unwanted_, j - 1);
  }
  /// Row j of H d, or of f − H d if there is an f: nodes (row 0 has none) and volume rows.
  void row(const Membrane<T>& m, const Unknowns<const T>* f, const Unknowns<const T>& d,
           const Unknowns<T>& out, int j) {
    row(m, f, d, out.x.row(j), out.y.row(j), out.p.row(j), j);
  }
  void row(const Membrane<T>& m, const Unknowns<const T>* f, const Unknowns<const T>& d,
           const SplitRow<T>& x, const SplitRow<T>& y, const SplitRow<T>& p, int j) {
    LinearRow<T> out = unwanted_;
    if (j > 0) {
      out.x = x;
      out.y = y;
    }
    out.p = p;
    (f ? table<T>().residual : table<T>().apply)(m, f, d, out, j);
  }

 private:
  LinearRow<T> unwanted_;  ///< takes what nobody wants; its carried rows are those in use
};

}  // namespace drumhead::kernels
