// SPDX-License-Identifier: MIT
#pragma once
// Visits of the special cells of conforming cells, of their parts and of the triangles of a part.
#include <array>
#include <cmath>

#include <drumhead/grid/conforming.h>

namespace drumhead::multigrid {

/// Whether lattice node (i, j) is no unknown: on the outer boundary, or held by a hard curve.
inline bool is_known(const grid::ConformingCells& cells, int i, int j) {
  if (i == 0 || j == 0 || i == cells.nx || j == cells.ny) return true;
  const int n = cells.find_node(i, j);
  return n >= 0 && std::isinf(cells.node[std::size_t(n)].stiffness);
}

/// Finds columns in one row of a list that is sorted by rows; asked for in ascending order.
class InRow {
 public:
  /// Row j of `column`; a row that does not exist is empty.
  InRow(const std::vector<int>& begin, const std::vector<int>& column, int j) : column_(&column) {
    if (j < 0 || j + 1 >= int(begin.size())) return;
    at_ = begin[std::size_t(j)];
    end_ = begin[std::size_t(j) + 1];
  }
  /// The entry of column i, −1: none.
  int find(int i) {
    while (at_ < end_ && (*column_)[std::size_t(at_)] < i) ++at_;
    return at_ < end_ && (*column_)[std::size_t(at_)] == i ? at_ : -1;
  }

 private:
  const std::vector<int>* column_;
  int at_ = 0, end_ = 0;
};

/// visit(special cell, i, j)
template <class F>
void for_special(const grid::ConformingCells& cells, F&& visit) {
  for (int j = 0; j < cells.ny; ++j)
    for (int c = cells.cell_begin[std::size_t(j)]; c < cells.cell_begin[std::size_t(j) + 1]; ++c)
      visit(c, cells.cell_column[std::size_t(c)], j);
}
template <class F>
void for_parts(const grid::ConformingCells& cells, int c, F&& visit) {
  for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1]; ++p)
    visit(p);
}
template <class F>
void for_triangles(const grid::ConformingCells& cells, int p, F&& visit) {
  const std::size_t first = std::size_t(cells.part_node_begin[std::size_t(p)]);
  for (int t = cells.part_triangle_begin[std::size_t(p)];
       t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
    const grid::PartTriangle& triangle = cells.triangle[std::size_t(t)];
    std::array<int, 3> code{};
    for (std::size_t a = 0; a < 3; ++a)
      code[a] = cells.part_node[first + std::size_t(triangle.node[a])];
    visit(triangle, code);
  }
}

}  // namespace drumhead::multigrid
