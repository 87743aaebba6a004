// SPDX-License-Identifier: MIT
#include <drumhead/kernels/soft_nodes.h>

#include <algorithm>

#include <drumhead/kernels/model.h>
#include <drumhead/kernels/special.h>

#include "special_state.h"

namespace drumhead::kernels {
namespace {

/// A node of a special cell as couplings name it.
struct Name {
  int column, row;  // row < 0: curve node `column`
};
Name name_of(int vertex, int i, int j) {
  if (vertex >= kFirstCrossing) return {vertex - kFirstCrossing, -1};
  return {i + (vertex & 1), j + (vertex >> 1)};
}

template <class T>
using Lists = std::vector<std::vector<T>>;

template <class T>
NodeCoupling<T>& coupling_to(std::vector<NodeCoupling<T>>& list, Name name) {
  for (NodeCoupling<T>& c : list)
    if (c.column == name.column && c.row == name.row) return c;
  return list.emplace_back(NodeCoupling<T>{name.column, name.row});
}

/// A coupling between any vertex of a part and those of its vertices that are soft curve nodes.
/// `soft`(vertex): number of one, −1: it is none.
template <class T, class F>
void couple_parts(const SpecialRows<T>& rows, F&& soft, Lists<NodeCoupling<T>>& node,
                  Lists<NodeCoupling<T>>& of_near) {
  const SpecialCells<T>& cells = rows.cells();
  for_special(cells, [&](int n, int i, int j) {
    auto unknown_corner = [&](int v) {
      return v < kFirstCrossing ? rows.unknown_corner(n, v) : -1;
    };
    for_parts(cells, n, [&](int p) {
      const auto begin = cells.vertex.begin() + cells.vertex_begin[std::size_t(p)],
                 end = cells.vertex.begin() + cells.vertex_begin[std::size_t(p) + 1];
      for (auto a = begin; a != end; ++a) {
        const int s = soft(a->vertex);
        for (auto b = begin; b != end && s >= 0; ++b)
          if (const int near = unknown_corner(b->vertex); near >= 0) {
            coupling_to(node[std::size_t(s)], name_of(b->vertex, i, j));
            coupling_to(of_near[std::size_t(near)], name_of(a->vertex, i, j));
          } else if (b != a && soft(b->vertex) >= 0) {
            coupling_to(node[std::size_t(s)], name_of(b->vertex, i, j));
          }
      }
    });
  });
}

/// One list after the other; begins of all of them and the end.
template <class T>
std::vector<int> join(const Lists<T>& lists, std::vector<T>& out) {
  std::vector<int> begin;
  for (const std::vector<T>& list : lists) {
    begin.push_back(int(out.size()));
    out.insert(out.end(), list.begin(), list.end());
  }
  begin.push_back(int(out.size()));
  return begin;
}

/// visit(part, vertex, the one before and after it) along the boundaries of a special cell's parts.
template <class T, class F>
void for_part_vertices(const SpecialCells<T>& cells, int cell, F&& visit) {
  for_parts(cells, cell, [&](int p) {
    const int begin = cells.vertex_begin[std::size_t(p)],
              end = cells.vertex_begin[std::size_t(p) + 1];
    for (int v = begin; v < end; ++v)
      visit(p, cells.vertex[std::size_t(v)], cells.vertex[std::size_t(v > begin ? v - 1 : end - 1)],
            cells.vertex[std::size_t(v + 1 < end ? v + 1 : begin)]);
  });
}

}  // namespace

template <class T>
void SoftRows<T>::list_nodes(const SpecialCells<T>& cells, int rows) {
  for (std::size_t c = 0; c < cells.crossing.size(); ++c)
    if (!cells.crossing[c].known()) row_.push_back({.node = int(c)});
  if (row_.empty()) return;
  auto place = [&](const Row& row) { return cells.crossing[std::size_t(row.node)].place; };
  std::ranges::stable_sort(row_, {}, place);
  index_.assign(cells.crossing.size(), -1);
  row_begin_.assign(std::size_t(rows) + 1, 0);
  for (std::size_t n = 0; n < row_.size(); ++n) {
    index_[std::size_t(row_[n].node)] = int(n);
    row_[n].diagonal = cells.crossing[std::size_t(row_[n].node)].stiffness;
    ++row_begin_[std::size_t(place(row_[n])) + 1];
  }
  for (std::size_t j = 1; j < row_begin_.size(); ++j) row_begin_[j] += row_begin_[j - 1];
}

template <class T>
SoftRows<T>::SoftRows(const SpecialRows<T>& rows, const Membrane<T>& membrane) {
  const SpecialCells<T>& cells = rows.cells();
  list_nodes(cells, membrane.ux.rows);
  if (row_.empty()) return;
  Lists<NodeCoupling<T>> node(row_.size()), of_near(std::size_t(rows.near_begin(membrane.ux.rows)));
  Lists<AreaCoupling<T>> part(row_.size()), of_part(std::size_t(cells.parts()));
  auto soft = [&](int vertex) {
    return vertex >= kFirstCrossing ? index_[std::size_t(vertex - kFirstCrossing)] : -1;
  };
  const bool blocks = isotropic(membrane.law.model);
  if (blocks) couple_parts(rows, soft, node, of_near);
  for_special(cells, [&](int n, int i, int j) {
    const T mu = mu_at(membrane, i, j);
    for (int t = cells.triangle_begin[std::size_t(n)]; t < cells.triangle_begin[std::size_t(n) + 1];
         ++t) {
      const Triangle<T>& triangle = cells.triangle[std::size_t(t)];
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
          const int own = triangle.vertex[a], other = triangle.vertex[b];
          const T k = mu * triangle.area *
                      (triangle.gx[a] * triangle.gx[b] + triangle.gy[a] * triangle.gy[b]);
          const bool to_unknown =
              soft(other) >= 0 || (other < kFirstCrossing && rows.unknown_corner(n, other) >= 0);
          if (const int s = soft(own); s >= 0 && own == other)
            row_[std::size_t(s)].diagonal += k;
          else if (s >= 0 && to_unknown)
            coupling_to(node[std::size_t(s)], name_of(other, i, j)).k += k;
          else if (soft(other) >= 0 && own < kFirstCrossing && rows.unknown_corner(n, own) >= 0)
            coupling_to(of_near[std::size_t(rows.unknown_corner(n, own))], name_of(other, i, j))
                .k += k;
        }
    }
    for_part_vertices(cells, n, [&](int p, const PartVertex<T>& own, auto&, auto&) {
      if (const int s = soft(own.vertex); s >= 0) {
        part[std::size_t(s)].push_back({p});
        of_part[std::size_t(p)].push_back({own.vertex - kFirstCrossing});
      }
    });
  });
  row_.push_back({});
  const std::vector<int> node_begin = join(node, node_), part_begin = join(part, part_);
  near_begin_ = join(of_near, of_near_);
  area_begin_ = join(of_part, of_part_);
  for (std::size_t n = 0; n < row_.size(); ++n) {
    row_[n].node_begin = node_begin[n];
    row_[n].part_begin = part_begin[n];
    if (row_[n].diagonal > T(0)) row_[n].inverse = T(1) / row_[n].diagonal;
  }
  if (!blocks) return;
  node_block_.resize(node_.size());
  of_near_block_.resize(of_near_.size());
  own_block_.resize(std::size_t(size()));
  inverse_block_.resize(std::size_t(size()));
}

template <class T>
void SoftRows<T>::linearise(const SpecialRows<T>& rows, const Membrane<T>& m) {
  for (NodeCoupling<T>& c : node_) c.g = T(0);
  for (NodeCoupling<T>& c : of_near_) c.g = T(0);
  if (!m.pressure || size() == 0) return;
  const SpecialCells<T>& cells = rows.cells();
  auto add = [&](std::vector<NodeCoupling<T>>& list, int begin, int end, Name name, T g) {
    for (int k = begin; k < end; ++k)
      if (NodeCoupling<T>& c = list[std::size_t(k)]; c.column == name.column && c.row == name.row)
        c.g += g;
  };
  auto set = [&](std::vector<AreaCoupling<T>>& list, int begin, int end, int other, T bx, T by) {
    for (int k = begin; k < end; ++k)
      if (AreaCoupling<T>& c = list[std::size_t(k)]; c.other == other) c = {other, bx, by};
  };
  for_special(cells, [&](int n, int i, int j) {
    for_part_vertices(
        cells, n,
        [&](int p, const PartVertex<T>& own, const PartVertex<T>& previous,
            const PartVertex<T>& next) {
          const T half = T(0.5) * clamped(m, m.listed[p], i, j);
          const bool curve = own.vertex >= kFirstCrossing;
          for (const auto& [other, g] : {std::pair{next.vertex, half}, {previous.vertex, -half}}) {
            const Name name = name_of(other, i, j);
            if (!curve && other >= kFirstCrossing) {
              if (const int near = rows.unknown_corner(n, own.vertex); near >= 0)
                add(of_near_, near_begin(near), near_begin(near + 1), name, g);
            } else if (curve && index(own.vertex - kFirstCrossing) >= 0) {
              const std::size_t s = std::size_t(index(own.vertex - kFirstCrossing));
              add(node_, row_[s].node_begin, row_[s + 1].node_begin, name, g);
            }
          }
          if (!curve || index(own.vertex - kFirstCrossing) < 0) return;
          const Vector2<T> to = at_vertex(cells, m.ux, m.uy, i, j, next.vertex),
                           from = at_vertex(cells, m.ux, m.uy, i, j, previous.vertex);
          const T bx = T(0.5) * ((next.y - previous.y) + (to.y - from.y));
          const T by = T(-0.5) * ((next.x - previous.x) + (to.x - from.x));
          const int node = own.vertex - kFirstCrossing;
          const std::size_t s = std::size_t(index(node));
          set(part_, row_[s].part_begin, row_[s + 1].part_begin, p, bx, by);
          set(of_part_, area_begin(p), area_begin(p + 1), node, bx, by);
        });
  });
}

template <class T>
void SoftRows<T>::clear_blocks(const SpecialCells<T>& cells) {
  std::ranges::fill(node_block_, NodeBlock<T>{});
  std::ranges::fill(of_near_block_, NodeBlock<T>{});
  for (std::size_t n = 0; n < own_block_.size(); ++n) {
    const T stiffness = cells.crossing[std::size_t(row_[n].node)].stiffness;
    own_block_[n] = {.xx = stiffness, .yy = stiffness};
  }
}

template <class T>
NodeBlock<T>* SoftRows<T>::find_block(int curve_node, int column, int row) {
  const std::size_t s = std::size_t(index(curve_node));
  if (row < 0 && column == curve_node) return &own_block_[s];
  for (int k = row_[s].node_begin; k < row_[s + 1].node_begin; ++k)
    if (node(k).column == column && node(k).row == row) return &node_block_[std::size_t(k)];
  return nullptr;
}

template <class T>
NodeBlock<T>& SoftRows<T>::find_block_of_near(int n, int curve_node) {
  int k = near_begin(n);
  while (of_near(k).column != curve_node) ++k;
  return of_near_block_[std::size_t(k)];
}

template <class T>
void SoftRows<T>::invert_blocks(T mu) {
  const T least = T(1e-4) * mu;
  for (std::size_t n = 0; n < own_block_.size(); ++n) {
    const NodeBlock<T>& own = own_block_[n];
    const T a = own.xx + least, b = own.xy, c = own.yy + least;
    const T inverse = T(1) / std::max(a * c - b * b, least * least);
    inverse_block_[n] = {c * inverse, -b * inverse, -b * inverse, a * inverse};
  }
}

template <class T>
std::size_t SoftRows<T>::bytes() const {
  return (index_.size() + row_begin_.size() + near_begin_.size() + area_begin_.size()) *
             sizeof(int) +
         row_.size() * sizeof(Row) + (node_.size() + of_near_.size()) * sizeof(NodeCoupling<T>) +
         (part_.size() + of_part_.size()) * sizeof(AreaCoupling<T>) +
         (node_block_.size() + of_near_block_.size() + 2 * own_block_.size()) *
             sizeof(NodeBlock<T>);
}

template class SoftRows<float>;
template class SoftRows<double>;

}  // namespace drumhead::kernels
