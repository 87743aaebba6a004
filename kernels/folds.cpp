// SPDX-License-Identifier: MIT
#include <drumhead/kernels/folds.h>

#include "kernel_table.h"
#include "parallel.h"

namespace drumhead::kernels {

std::vector<RowFolds> count_folds(const LatticeMapView& map) {
  std::vector<RowFolds> folds(static_cast<std::size_t>(map.ny));
  const std::ptrdiff_t row = map.nx + 1;
  const SplitCellsView& split = map.split;
  for_rows(0, map.ny, map.nx, [&](int j) {
    Columns left_out;
    if (split.row_begin)
      left_out = {split.column + split.row_begin[j], split.column + split.row_begin[j + 1]};
    table<double>().folds(map.u + j * row, map.v + j * row, map.nx, 1.0 / map.cell_px, left_out,
                          folds[static_cast<std::size_t>(j)]);
  });
  return folds;
}

}  // namespace drumhead::kernels
