// SPDX-License-Identifier: MIT
#pragma once
// The part of a solution that is not a lattice of bilinear cells: the triangles of the cells that
// curves divide (grid/conforming.h), as the resampler and the analysis read them.
#include <vector>

#include <drumhead/kernels/resample.h>

namespace drumhead::multigrid {

/// As kernels::SplitCellsView, which it owns.
struct SplitCells {
  std::vector<int> row_begin, column, triangle_begin;
  std::vector<kernels::MapTriangle> triangle;
  std::vector<double> pressure;  ///< of each triangle, in units of mu; empty where none exist
  /// A window; must not outlive this.
  kernels::SplitCellsView view() const {
    if (column.empty()) return {};
    return {row_begin.data(), column.data(), triangle_begin.data(), triangle.data()};
  }
};

/// Change of area of a triangle.
double triangle_J(const kernels::MapTriangle& triangle);

}  // namespace drumhead::multigrid
