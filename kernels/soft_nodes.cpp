// SPDX-License-Identifier: MIT
#include <drumhead/kernels/soft_nodes.h>

#include <algorithm>

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
SoftRows<T>::SoftRows(const SpecialRows<T>& rows, const Membrane<T>& membrane) {
  const SpecialCells<T>& cells = rows.cells();
  for (std::size_t c = 0; c < cells.crossing.size(); ++c)
    if (!cells.crossing[c].known()) row_.push_back({.node = int(c)});
  if (row_.empty()) return;
  auto place = [&](const Row& row) { return cells.crossing[std::size_t(row.node)].place; };
  std::ranges::stable_sort(row_, {}, place);
  index_.assign(cells.crossing.size(), -1);
  row_begin_.assign(std::size_t(membrane.ux.rows) + 1, 0);
  for (std::size_t n = 0; n < row_.size(); ++n) {
    index_[std::size_t(row_[n].node)] = int(n);
    row_[n].diagonal = cells.crossing[std::size_t(row_[n].node)].stiffness;
    ++row_begin_[std::size_t(place(row_[n])) + 1];
  }
  for (std::size_t j = 1; j < row_begin_.size(); ++j) row_begin_[j] += row_begin_[j - 1];

  Lists<NodeCoupling<T>> node(row_.size()), of_near(std::size_t(rows.near_begin(membrane.ux.rows)));
  Lists<AreaCoupling<T>> part(row_.size()), of_part(std::size_t(cells.parts()));
  auto soft = [&](int vertex) {
    return vertex >= kFirstCrossing ? index_[std::size_t(vertex - kFirstCrossing)] : -1;
  };
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
std::size_t SoftRows<T>::bytes() const {
  return (index_.size() + row_begin_.size() + near_begin_.size() + area_begin_.size()) *
             sizeof(int) +
         row_.size() * sizeof(Row) + (node_.size() + of_near_.size()) * sizeof(NodeCoupling<T>) +
         (part_.size() + of_part_.size()) * sizeof(AreaCoupling<T>);
}

template class SoftRows<float>;
template class SoftRows<double>;

}  // namespace drumhead::kernels
