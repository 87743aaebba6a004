// SPDX-License-Identifier: MIT
#include <drumhead/kernels/transfer.h>

#include "kernel_table.h"
#include "parallel.h"

namespace drumhead::kernels {

template <class T>
void inject_nodes(const Plane<const T>& fine, const Plane<T>& coarse) {
  for_rows(1, coarse.rows - 1, coarse.columns,
           [&](int j) { table<T>().inject_nodes(fine, coarse, j); });
}

template <class T>
void prolong_nodes(const Plane<const T>& coarse, const Plane<T>& fine) {
  for_rows(1, fine.rows - 1, fine.columns,
           [&](int j) { table<T>().prolong_nodes(coarse, fine, j); });
}

template <class T>
void mean_cells(const Plane<const T>& fine, const Plane<T>& coarse) {
  for_rows(0, coarse.rows, fine.columns, [&](int j) {
    const SplitRow<const T> below = fine.row(2 * j);
    const bool pair = 2 * j + 1 < fine.rows;
    const SplitRow<const T> above = pair ? fine.row(2 * j + 1) : below;
    table<T>().mean_cells(below, pair ? &above : nullptr, fine.columns, coarse, j);
  });
}

template <class T>
void interpolate_cells(const Plane<const T>& coarse, const Plane<T>& fine) {
  for_rows(0, fine.rows, fine.columns,
           [&](int j) { table<T>().interpolate_cells(coarse, fine, j); });
}

#define DRUMHEAD_INSTANTIATE(T)                                        \
  template void inject_nodes(const Plane<const T>&, const Plane<T>&);  \
  template void prolong_nodes(const Plane<const T>&, const Plane<T>&); \
  template void mean_cells(const Plane<const T>&, const Plane<T>&);    \
  template void interpolate_cells(const Plane<const T>&, const Plane<T>&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
