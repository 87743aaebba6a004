// SPDX-License-Identifier: MIT
// What SpecialRows lists once per lattice: near nodes, visits, borders and couplings.
#include <drumhead/kernels/special.h>

#include <drumhead/kernels/model.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "special_state.h"

namespace drumhead::kernels {
namespace {

/// Sorts the columns that were listed since row j began by parity and halves them.
void halve(std::vector<int>& columns, std::vector<int>& begin, int j) {
  const auto row = columns.begin() + begin[2 * std::size_t(j)];
  const auto odd = std::stable_partition(row, columns.end(), [](int i) { return i % 2 == 0; });
  begin[2 * std::size_t(j) + 1] = int(odd - columns.begin());
  begin[2 * std::size_t(j) + 2] = int(columns.size());
  std::for_each(row, columns.end(), [](int& i) { i /= 2; });
}

/// visit(corner, part) for the corners of cell `n` that are a part's vertex.
template <class T, class F>
void for_corner_vertices(const SpecialCells<T>& cells, int n, F&& visit) {
  for_parts(cells, n, [&](int p) {
    for (int v = cells.vertex_begin[std::size_t(p)]; v < cells.vertex_begin[std::size_t(p) + 1];
         ++v)
      if (const int corner = cells.vertex[std::size_t(v)].vertex; corner < kFirstCrossing)
        visit(corner, p);
  });
}

}  // namespace

template <class T>
void SpecialRows<T>::list_near_nodes(int columns, int rows) {
  struct Corner {
    int column, cell, corner;  // cell −1: a known node
  };
  corner_.assign(4 * std::size_t(cells_->size()), -1);
  near_begin_.assign(std::size_t(rows) + 1, 0);
  known_begin_ = loose_begin_ = near_begin_;
  near_half_begin_.assign(2 * std::size_t(rows) + 1, 0);
  std::vector<Corner> corners;
  for (int j = 1; j + 1 < rows; ++j) {
    corners.clear();
    for (const int row : {j - 1, j})
      for (int n = cells_->row_begin[std::size_t(row)]; n < cells_->row_begin[std::size_t(row) + 1];
           ++n)
        for (const int east : {0, 1})
          corners.push_back({cells_->column[std::size_t(n)] + east, n, 2 * (j - row) + east});
    for (int k = cells_->held_begin[std::size_t(j)]; k < cells_->held_begin[std::size_t(j) + 1];
         ++k)
      if (const HeldNode<T>& node = cells_->held[std::size_t(k)]; node.known())
        corners.push_back({node.place, -1, 0});
      else
        corners.push_back({node.place, cells_->size(), 0});
    std::ranges::sort(corners, {}, [](const Corner& c) { return std::pair(c.column, c.cell); });
    for (std::size_t first = 0, end = 0; first < corners.size(); first = end) {
      const int column = corners[first].column;
      int regular = 15;
      for (end = first; end < corners.size() && corners[end].column == column; ++end)
        if (corners[end].cell >= 0 && corners[end].cell < cells_->size())
          regular &= ~(1 << corner_towards_node(corners[end].corner));
      if (column == 0 || column + 1 == columns) continue;
      near_half_.push_back(column);
      if (corners[first].cell < 0) {
        known_.push_back(column);
        if (regular != 0) loose_.push_back(column);
        continue;
      }
      for (std::size_t c = first; c < end && corners[c].cell < cells_->size(); ++c)
        corner_[4 * std::size_t(corners[c].cell) + std::size_t(corners[c].corner)] =
            int(near_node_.size());
      near_node_.push_back({column, regular});
    }
    halve(near_half_, near_half_begin_, j);
    near_begin_[std::size_t(j) + 1] = int(near_node_.size());
    known_begin_[std::size_t(j) + 1] = int(known_.size());
    loose_begin_[std::size_t(j) + 1] = int(loose_.size());
  }
  near_begin_[std::size_t(rows)] = int(near_node_.size());
  known_begin_[std::size_t(rows)] = int(known_.size());
  loose_begin_[std::size_t(rows)] = int(loose_.size());
  for (const int last : {2 * rows - 1, 2 * rows})
    near_half_begin_[std::size_t(last)] = int(near_half_.size());
}

/// Makes room for the diagonals of the near nodes that triangles join with unknown ones.
template <class T>
void SpecialRows<T>::list_diagonals() {
  std::vector<char> joined(near_node_.size(), 0);
  for (int n = 0; n < cells_->size(); ++n)
    for (int t = cells_->triangle_begin[std::size_t(n)];
         t < cells_->triangle_begin[std::size_t(n) + 1]; ++t)
      for (const int own : cells_->triangle[std::size_t(t)].vertex)
        for (const int other : cells_->triangle[std::size_t(t)].vertex)
          if (own < kFirstCrossing && other == 3 - own && unknown_corner(n, own) >= 0 &&
              unknown_corner(n, other) >= 0)
            joined[std::size_t(unknown_corner(n, own))] = 1;
  int count = 0;
  for (std::size_t n = 0; n < joined.size(); ++n)
    if (joined[n]) near_node_[n].diagonal = count++;
  diagonal_.resize(std::size_t(count));
}

template <class T>
void SpecialRows<T>::list_visits() {
  const SpecialCells<T>& cells = *cells_;
  visit_begin_.assign(1, 0);
  for (std::size_t j = 0; j + 1 < cells.row_begin.size(); ++j)
    for (const int parity : {0, 1}) {
      for (int n = cells.row_begin[j]; n < cells.row_begin[j + 1]; ++n) {
        if ((cells.column[std::size_t(n)] & 1) != parity) continue;
        CellVisit<T>& visit = visit_.emplace_back();
        visit.column = cells.column[std::size_t(n)];
        visit.part_begin = cells.part_begin[std::size_t(n)];
        visit.part_end = cells.part_begin[std::size_t(n) + 1];
        for (int c = 0; c < 4; ++c)
          if (const int node = unknown_corner(n, c); node >= 0)
            visit.inverse[c] = near(node).inverse;
      }
      visit_begin_.push_back(int(visit_.size()));
    }
}

template <class T>
void SpecialRows<T>::list_borders() {
  border_begin_.assign(1, 0);
  border_.clear();
  for (std::size_t j = 0; j + 1 < cells_->border_begin.size(); ++j)
    for (const int parity : {0, 1}) {
      for (int b = cells_->border_begin[j]; b < cells_->border_begin[j + 1]; ++b)
        if (const PartBorder& border = cells_->border[std::size_t(b)];
            (border.column & 1) == parity)
          border_.push_back({border.column >> 1, border.part, border.neighbour});
      border_begin_.push_back(int(border_.size()));
    }
}

template <class T>
void SpecialRows<T>::list_couplings() {
  std::vector<std::pair<int, int>> further;  // near node, part
  for (int n = 0; n < cells_->size(); ++n)
    for_corner_vertices(*cells_, n, [&](int corner, int p) {
      const int node = unknown_corner(n, corner);
      if (node < 0) return;
      int& part = near_[std::size_t(node)].part[quadrant(corner)];
      if (part < 0)
        part = p;
      else
        further.push_back({node, p});
    });
  if (further.empty()) return;
  std::ranges::sort(further);
  further_begin_.assign(near_node_.size() + 1, 0);
  for (const auto& [node, p] : further) {
    ++further_begin_[std::size_t(node) + 1];
    further_.push_back({.part = p});
  }
  std::partial_sum(further_begin_.begin(), further_begin_.end(), further_begin_.begin());
}

#define DRUMHEAD_INSTANTIATE(T)                            \
  template void SpecialRows<T>::list_near_nodes(int, int); \
  template void SpecialRows<T>::list_diagonals();          \
  template void SpecialRows<T>::list_visits();             \
  template void SpecialRows<T>::list_borders();            \
  template void SpecialRows<T>::list_couplings();
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
