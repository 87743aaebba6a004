// SPDX-License-Identifier: MIT
#include "resample_boxes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drumhead::kernels {

// Comparisons that a NaN fails: a node that is not finite leaves the box as it is.
void Box::add(Position p) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
  x0 = std::min(x0, p.x);
  y0 = std::min(y0, p.y);
  x1 = std::max(x1, p.x);
  y1 = std::max(y1, p.y);
}

void Box::add(const Box& box) {
  x0 = std::min(x0, box.x0);
  y0 = std::min(y0, box.y0);
  x1 = std::max(x1, box.x1);
  y1 = std::max(y1, box.y1);
}

int SplitCellsView::find(int i, int j) const {
  if (!row_begin) return -1;
  const int *begin = column + row_begin[j], *end = column + row_begin[j + 1];
  const int* const at = std::lower_bound(begin, end, i);
  return at != end && *at == i ? int(at - column) : -1;
}

BoxTree::BoxTree(const LatticeMapView& map) {
  Level leaves{(map.nx + kBlock - 1) / kBlock, (map.ny + kBlock - 1) / kBlock, {}};
  leaves.boxes.resize(std::size_t(leaves.columns) * std::size_t(leaves.rows));
  Box* box = leaves.boxes.data();
  for (int j0 = 0; j0 < map.ny; j0 += kBlock) {
    for (int i0 = 0; i0 < map.nx; i0 += kBlock, ++box) {
      for (int j = j0; j <= std::min(j0 + kBlock, map.ny); ++j) {
        for (int i = i0; i <= std::min(i0 + kBlock, map.nx); ++i) box->add(warped_node(map, i, j));
      }
    }
  }
  const SplitCellsView& split = map.split;
  for (int j = 0; split.row_begin && j < map.ny; ++j) {
    for (int c = split.row_begin[j]; c < split.row_begin[j + 1]; ++c) {
      Box& block = leaves.boxes[std::size_t(j / kBlock) * std::size_t(leaves.columns) +
                                std::size_t(split.column[c] / kBlock)];
      for (int n = split.triangle_begin[c]; n < split.triangle_begin[c + 1]; ++n) {
        for (int k = 0; k < 3; ++k) block.add(warped_corner(split.triangle[n], k));
      }
    }
  }
  levels_.push_back(std::move(leaves));
  while (levels_.back().boxes.size() > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
    coarse.boxes.resize(std::size_t(coarse.columns) * std::size_t(coarse.rows));
    for (int j = 0; j < fine.rows; ++j) {
      for (int i = 0; i < fine.columns; ++i) {
        coarse.boxes[std::size_t(j / 2) * std::size_t(coarse.columns) + std::size_t(i / 2)].add(
            fine.at(i, j));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

}  // namespace drumhead::kernels
