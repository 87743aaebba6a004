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

/// The special cells below and above a row of nodes, which is gone through by columns.
template <class T>
class CellsAround {
 public:
  CellsAround(const SpecialCells<T>& cells, int j) : column_(cells.column) {
    const int* const begin = &cells.row_begin[std::size_t(j)];
    rows_[0] = {begin[-1], begin[0], 2};
    rows_[1] = {begin[0], begin[1], 0};
  }
  /// The first column from this one on, `last` at most, whose node is a corner of a cell.
  int next(int column, int last) {
    for (Row& row : rows_) {
      while (row.at < row.end && column_[std::size_t(row.at)] + 1 < column) ++row.at;
      if (row.at < row.end) last = std::min(last, std::max(column, column_[std::size_t(row.at)]));
    }
    return last;
  }
  /// visit(cell, corner) for those of the node in the column that `next` gave.
  template <class F>
  void visit(int column, F&& visit) const {
    for (const Row& row : rows_)
      for (int n = row.at; n < row.end && column_[std::size_t(n)] <= column; ++n)
        visit(n, row.corner + column - column_[std::size_t(n)]);
  }

 private:
  struct Row {
    int at, end;  // from the cell on of which the node may be a corner
    int corner;   // its western one in this row of nodes
  };
  const std::vector<int>& column_;
  Row rows_[2];
};

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
  const std::vector<HeldNode<T>>& held = cells_->held;
  corner_.assign(4 * std::size_t(cells_->size()), -1);
  near_begin_.assign(std::size_t(rows) + 1, 0);
  known_begin_ = loose_begin_ = near_begin_;
  near_half_begin_.assign(2 * std::size_t(rows) + 1, 0);
  near_node_.reserve(2 * std::size_t(cells_->size()));
  std::vector<int> odd;
  for (int j = 1; j + 1 < rows; ++j) {
    CellsAround<T> around(*cells_, j);
    int k = cells_->held_begin[std::size_t(j)];
    const int held_end = cells_->held_begin[std::size_t(j) + 1];
    for (int column = 0;; ++column) {
      column = around.next(column, k < held_end ? held[std::size_t(k)].place : columns);
      if (column == columns) break;
      bool known = false;
      if (k < held_end && held[std::size_t(k)].place == column)
        known = held[std::size_t(k++)].known();
      const bool fixed = column == 0 || column + 1 == columns;
      int regular = 15;
      around.visit(column, [&](int n, int corner) {
        regular &= ~(1 << corner_towards_node(corner));
        if (!known && !fixed)
          corner_[4 * std::size_t(n) + std::size_t(corner)] = int(near_node_.size());
      });
      if (fixed) continue;
      (column % 2 ? odd : near_half_).push_back(column / 2);
      if (!known) {
        near_node_.push_back({column, regular});
        continue;
      }
      known_.push_back(column);
      if (regular != 0) loose_.push_back(column);
    }
    near_half_begin_[2 * std::size_t(j) + 1] = int(near_half_.size());
    near_half_.insert(near_half_.end(), odd.begin(), odd.end());
    near_half_begin_[2 * std::size_t(j) + 2] = int(near_half_.size());
    odd.clear();
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
  visit_.reserve(std::size_t(cells.size()));
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
