// SPDX-License-Identifier: MIT
#include <drumhead/kernels/special.h>

#include <algorithm>
#include <array>

#include "special_state.h"

namespace drumhead::kernels {
namespace {

/// Place in a 3 × 3 stencil of corner `other` of a cell, seen from its corner `own`.
std::size_t stencil_place(int own, int other) {
  return std::size_t(4 + ((other & 1) - (own & 1)) + 3 * ((other >> 1) - (own >> 1)));
}

/// Corners of a cell that follow and precede one in the sense 00, 10, 11, 01.
constexpr std::array<int, 4> kNext{1, 3, 0, 2}, kPrevious{2, 0, 3, 1};

// The jump between two parts in shares of that between regular cells. Pieces of sides are short, L²
// in the term more so, and the nodes that a coarse level lacks there give way more easily than one
// in the middle of an edge. V-cycles that take a residual down by 1000 at 128², kappa 1e4, with 1,
// 2, 4, 8: S1 22, 21, 20, 20 (and F-cycles that diverge with 1); S2 30, 28, 29, 31; S4 20, 20, 21,
// 21.
constexpr double kPartJump = 4.0;

/// The corner of cell q of sw, se, nw, ne that is the node itself.
constexpr int corner_towards_node(int q) { return 3 - q; }

template <class T>
bool is_known(const SpecialCells<T>& cells, int i, int j) {
  const auto begin = cells.known.begin() + cells.known_begin[std::size_t(j)];
  const auto end = cells.known.begin() + cells.known_begin[std::size_t(j) + 1];
  return std::any_of(begin, end, [&](const KnownNode<T>& node) { return node.column == i; });
}

/// visit(vertex index, its corner, part) for the vertices of cell `n`'s parts that are corners.
template <class T, class F>
void for_corner_vertices(const SpecialCells<T>& cells, int n, F&& visit) {
  for_parts(cells, n, [&](int p) {
    for (int v = cells.vertex_begin[std::size_t(p)]; v < cells.vertex_begin[std::size_t(p) + 1];
         ++v)
      if (const int corner = cells.vertex[std::size_t(v)].vertex; corner < kFirstCrossing)
        visit(v, corner, p);
  });
}

}  // namespace

template <class T>
SpecialRows<T>::SpecialRows(const SpecialCells<T>& cells, const Membrane<T>& membrane)
    : cells_(&cells), part_(std::size_t(cells.parts())) {
  list_near_nodes(membrane.ux.columns, membrane.ux.rows);
  add_stiffness(membrane);
  list_couplings();
}

template <class T>
void SpecialRows<T>::list_near_nodes(int columns, int rows) {
  struct Corner {
    int column, cell, corner;
  };
  corner_.assign(4 * std::size_t(cells_->size()), -1);
  near_begin_.assign(std::size_t(rows) + 1, 0);
  loose_begin_ = near_begin_;
  std::vector<Corner> corners;
  for (int j = 1; j + 1 < rows; ++j) {
    corners.clear();
    for (const int row : {j - 1, j})
      for (int n = cells_->row_begin[std::size_t(row)]; n < cells_->row_begin[std::size_t(row) + 1];
           ++n)
        for (const int east : {0, 1})
          corners.push_back({cells_->column[std::size_t(n)] + east, n, 2 * (j - row) + east});
    for (int k = cells_->known_begin[std::size_t(j)]; k < cells_->known_begin[std::size_t(j) + 1];
         ++k)
      corners.push_back({cells_->known[std::size_t(k)].column, -1, 0});
    std::ranges::sort(corners, {}, &Corner::column);
    for (const Corner& c : corners) {
      if (c.column == 0 || c.column + 1 == columns) continue;
      if (int(near_.size()) == near_begin_[std::size_t(j)] || near_.back().column != c.column)
        near_.push_back({.column = c.column, .inverse = T(!is_known(*cells_, c.column, j))});
      if (c.cell < 0) continue;
      near_.back().regular &= ~(1 << corner_towards_node(c.corner));
      corner_[4 * std::size_t(c.cell) + std::size_t(c.corner)] = int(near_.size()) - 1;
    }
    near_begin_[std::size_t(j) + 1] = int(near_.size());
    for (int n = near_begin_[std::size_t(j)]; n < near_begin_[std::size_t(j) + 1]; ++n)
      if (const NearRow<T>& row = near_[std::size_t(n)]; row.inverse == T(0) && row.regular != 0)
        loose_.push_back(row.column);
    loose_begin_[std::size_t(j) + 1] = int(loose_.size());
  }
  near_begin_[std::size_t(rows)] = int(near_.size());
  loose_begin_[std::size_t(rows)] = int(loose_.size());
}

template <class T>
void SpecialRows<T>::list_couplings() {
  const SpecialCells<T>& cells = *cells_;
  auto each = [&](auto&& visit) {
    for (int n = 0; n < cells.size(); ++n)
      for_corner_vertices(cells, n, [&](int v, int corner, int p) {
        if (const int node = unknown_corner(n, corner); node >= 0) visit(v, p, std::size_t(node));
      });
  };
  near_.push_back({});
  each([&](int, int, std::size_t node) { ++near_[node + 1].coupling_begin; });
  for (std::size_t n = 1; n < near_.size(); ++n)
    near_[n].coupling_begin += near_[n - 1].coupling_begin;
  coupling_.resize(std::size_t(near_.back().coupling_begin));
  slot_.assign(cells.vertex.size(), -1);
  std::vector<int> filled(near_.size(), 0);
  each([&](int v, int p, std::size_t node) {
    const int slot = near_[node].coupling_begin + filled[node]++;
    slot_[std::size_t(v)] = slot;
    coupling_[std::size_t(slot)].part = p;
  });
}

template <class T>
void SpecialRows<T>::add_stiffness(const Membrane<T>& membrane) {
  const SpecialCells<T>& cells = *cells_;
  for_special(cells, [&](int n, int i, int j) {
    const T mu = mu_at(membrane, i, j);
    for (int t = cells.triangle_begin[std::size_t(n)]; t < cells.triangle_begin[std::size_t(n) + 1];
         ++t) {
      const Triangle<T>& triangle = cells.triangle[std::size_t(t)];
      for (std::size_t a = 0; a < 3; ++a) {
        if (triangle.vertex[a] >= kFirstCrossing) continue;
        const int node = unknown_corner(n, triangle.vertex[a]);
        if (node < 0) continue;
        for (std::size_t b = 0; b < 3; ++b)
          if (triangle.vertex[b] < kFirstCrossing)
            near_[std::size_t(node)].k[stencil_place(triangle.vertex[a], triangle.vertex[b])] +=
                mu * triangle.area *
                (triangle.gx[a] * triangle.gx[b] + triangle.gy[a] * triangle.gy[b]);
      }
    }
  });
  for (int j = 1; j + 1 < membrane.ux.rows; ++j)
    for (int n = near_begin(j); n < near_begin(j + 1); ++n) {
      NearRow<T>& row = near_[std::size_t(n)];
      if (row.inverse == T(0)) continue;
      for (int q = 0; q < 4; ++q) {
        if (!(row.regular >> q & 1)) continue;
        const int own = corner_towards_node(q);
        const T mu = mu_at(membrane, row.column - (own & 1), j - (own >> 1));
        row.k[4] += mu;
        row.k[stencil_place(own, own ^ 1)] -= T(0.5) * mu;
        row.k[stencil_place(own, own ^ 2)] -= T(0.5) * mu;
      }
      row.inverse = T(1) / row.k[4];
    }
}

template <class T>
void SpecialRows<T>::linearise_regular(const Membrane<T>& m) {
  for (int j = 1; j + 1 < m.ux.rows; ++j)
    for (int n = near_begin(j); n < near_begin(j + 1); ++n) {
      NearRow<T>& row = near_[std::size_t(n)];
      std::fill_n(row.g, 9, T(0));
      if (!m.pressure || row.inverse == T(0)) continue;
      for (int q = 0; q < 4; ++q) {
        if (!(row.regular >> q & 1)) continue;
        const int own = corner_towards_node(q), i0 = row.column - (own & 1), j0 = j - (own >> 1);
        const int next = kNext[std::size_t(own)], previous = kPrevious[std::size_t(own)];
        const T half = T(0.5) * clamped(m, m.pressure.at(i0, j0), i0, j0);
        row.g[stencil_place(own, next)] += half;
        row.g[stencil_place(own, previous)] -= half;
        auto place = [&](int corner) {
          const int east = corner & 1, north = corner >> 1;
          return Vector2<T>{m.spacing * T(east) + m.ux.at(i0 + east, j0 + north),
                            m.spacing * T(north) + m.uy.at(i0 + east, j0 + north)};
        };
        const Vector2<T> to = place(next), from = place(previous);
        row.bx[q] = T(0.5) * (to.y - from.y);
        row.by[q] = T(-0.5) * (to.x - from.x);
      }
    }
}

template <class T>
void SpecialRows<T>::linearise_part(const Membrane<T>& m, int cell, int part, int j) {
  const SpecialCells<T>& cells = *cells_;
  const int i = cells.column[std::size_t(cell)];
  PartRow<T>& row = part_[std::size_t(part)];
  row = {.compliance = cells.area[std::size_t(part)] * compliance_at(m, i, j)};
  const T half = T(0.5) * clamped(m, m.listed[part], i, j);
  const int begin = cells.vertex_begin[std::size_t(part)],
            end = cells.vertex_begin[std::size_t(part) + 1];
  for (int v = begin; v < end; ++v) {
    const int slot = slot_[std::size_t(v)];
    if (slot < 0) continue;
    const int own = cells.vertex[std::size_t(v)].vertex;
    NearRow<T>& node = near_[std::size_t(corner(cell, own))];
    const PartVertex<T>& next = cells.vertex[std::size_t(v + 1 < end ? v + 1 : begin)];
    const PartVertex<T>& previous = cells.vertex[std::size_t(v > begin ? v - 1 : end - 1)];
    if (next.vertex < kFirstCrossing) node.g[stencil_place(own, next.vertex)] += half;
    if (previous.vertex < kFirstCrossing) node.g[stencil_place(own, previous.vertex)] -= half;
    const Vector2<T> to = at_vertex(cells, m.ux, m.uy, i, j, next.vertex),
                     from = at_vertex(cells, m.ux, m.uy, i, j, previous.vertex);
    const T bx = T(0.5) * ((next.y - previous.y) + (to.y - from.y));
    const T by = T(-0.5) * ((next.x - previous.x) + (to.x - from.x));
    row.bx[own] = bx;
    row.by[own] = by;
    coupling_[std::size_t(slot)].bx = bx;
    coupling_[std::size_t(slot)].by = by;
  }
}

/// The jump term of pressure_jump.h between parts, and between parts and regular cells.
template <class T>
void SpecialRows<T>::set_jumps(const Membrane<T>& m) {
  const SpecialCells<T>& cells = *cells_;
  jump_.assign(cells.neighbour.size(), T(0));
  if (m.pressure_jump == T(0)) return;
  constexpr int kEast[] = {0, 1, 0, -1}, kNorth[] = {-1, 0, 1, 0};
  auto set = [&](std::size_t p, int k, int i, int j) {
    const PartNeighbour& other = cells.neighbour[std::size_t(k)];
    const int begin = cells.vertex_begin[p], end = cells.vertex_begin[p + 1];
    const PartVertex<T>& from = cells.vertex[std::size_t(other.vertex)];
    const PartVertex<T>& to =
        cells.vertex[std::size_t(other.vertex + 1 < end ? other.vertex + 1 : begin)];
    const Vector2<T> u = at_vertex(cells, m.ux, m.uy, i, j, from.vertex),
                     v = at_vertex(cells, m.ux, m.uy, i, j, to.vertex);
    const T ex = (to.x - from.x) + (v.x - u.x), ey = (to.y - from.y) + (v.y - u.y);
    const int side = other.side;
    const T mu = mu_at(m, i, j) + mu_at(m, i + kEast[side], j + kNorth[side]);
    const T factor = other.part >= 0 ? T(kPartJump) : T(1);
    jump_[std::size_t(k)] = factor * T(0.125) * m.pressure_jump * (ex * ex + ey * ey) / mu;
    part_[p].jumps += jump_[std::size_t(k)];
  };
  for_special(cells, [&](int n, int i, int j) {
    for_parts(cells, n, [&](int p) {
      for (int k = cells.neighbour_begin[std::size_t(p)];
           k < cells.neighbour_begin[std::size_t(p) + 1]; ++k)
        set(std::size_t(p), k, i, j);
    });
  });
}

template <class T>
void SpecialRows<T>::linearise(const Membrane<T>& m) {
  if (!cells_) return;
  linearise_regular(m);
  if (!m.pressure) return;
  for_special(*cells_, [&](int n, int, int j) {
    for_parts(*cells_, n, [&](int p) { linearise_part(m, n, p, j); });
  });
  set_jumps(m);
}

template <class T>
std::size_t SpecialRows<T>::bytes() const {
  return (near_begin_.size() + corner_.size() + slot_.size()) * sizeof(int) +
         near_.size() * sizeof(NearRow<T>) + part_.size() * sizeof(PartRow<T>) +
         coupling_.size() * sizeof(PartCoupling<T>);
}

template class SpecialRows<float>;
template class SpecialRows<double>;

}  // namespace drumhead::kernels
