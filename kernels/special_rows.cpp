// SPDX-License-Identifier: MIT
#include <drumhead/kernels/special.h>

#include <drumhead/kernels/model.h>

#include <algorithm>
#include <array>
#include <utility>

#include "soft_sweeps.h"
#include "special_state.h"

namespace drumhead::kernels {
namespace {

/// Place of vertex `other` of a cell, seen from its corner `own`: 0…3 in a NearRow, 4…7 in a
/// DiagonalRow, kOwn the node itself, kNone where it is no corner.
constexpr std::size_t kDiagonal = 4, kOwn = 8, kNone = 9;
std::size_t stencil_place(int own, int other) {
  constexpr std::size_t kPlace[4][5] = {{kOwn, 1, 3, 7, kNone},
                                        {0, kOwn, 6, 3, kNone},
                                        {2, 5, kOwn, 1, kNone},
                                        {4, 2, 0, kOwn, kNone}};
  return kPlace[own][std::min(other, kFirstCrossing)];
}

/// Corners of a cell that follow and precede one in the sense 00, 10, 11, 01, and their
/// stencil_place.
constexpr int kNext[4] = {1, 3, 0, 2}, kPrevious[4] = {2, 0, 3, 1};
constexpr std::size_t kNextPlace[4] = {1, 3, 2, 0}, kPreviousPlace[4] = {3, 0, 1, 2};

constexpr std::array<int, 4> kEast{0, 1, 0, -1}, kNorth{-1, 0, 1, 0};  // by PartNeighbour::side

}  // namespace

template <class T>
SpecialRows<T>::SpecialRows(const SpecialCells<T>& cells, const Membrane<T>& membrane)
    : cells_(&cells), part_(std::size_t(cells.parts())) {
  list_near_nodes(membrane.ux.columns, membrane.ux.rows);
  list_diagonals();
  near_.resize(near_node_.size());
  add_stiffness(membrane);
  list_visits();
  if (isotropic(membrane.law.model))
    list_fringe(membrane.ux.rows);
  else
    list_couplings();
  if (membrane.pressure && membrane.part_jump != T(0)) set_own_jumps(membrane);
  soft_ = SoftRows<T>(*this, membrane);
}

template <class T>
DiagonalRow<T>* SpecialRows<T>::diagonals_of(int near) {
  const int n = near_node(near).diagonal;
  return n >= 0 ? &diagonal_[std::size_t(n)] : nullptr;
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
        NearRow<T>& row = near_[std::size_t(node)];
        DiagonalRow<T>* const diagonals = diagonals_of(node);
        for (std::size_t b = 0; b < 3; ++b) {
          if (triangle.vertex[b] >= kFirstCrossing) continue;
          const std::size_t place = stencil_place(triangle.vertex[a], triangle.vertex[b]);
          const T k = mu * triangle.area *
                      (triangle.gx[a] * triangle.gx[b] + triangle.gy[a] * triangle.gy[b]);
          if (place == kOwn)
            row.own += k;
          else if (place < kDiagonal)
            row.k[place] += k;
          else if (diagonals)
            diagonals->k[place - kDiagonal] += k;
        }
      }
    }
  });
  for (int j = 1; j + 1 < membrane.ux.rows; ++j) {
    const HeldNode<T>* held = cells.held.data() + cells.held_begin[std::size_t(j)];
    const HeldNode<T>* const held_end = cells.held.data() + cells.held_begin[std::size_t(j) + 1];
    for (int n = near_begin(j); n < near_begin(j + 1); ++n) {
      const NearNode& node = near_node(n);
      NearRow<T>& row = near_[std::size_t(n)];
      row.place = row_place(membrane.ux, node.column);
      row.west = row_place(membrane.ux, node.column - 1);
      for (int q = 0; q < 4; ++q) {
        const int own = corner_towards_node(q);
        if (membrane.pressure)
          row.part[q] = -1 - row_place(membrane.pressure, node.column - (own & 1));
        if (!(node.regular >> q & 1)) continue;
        const T mu = mu_at(membrane, node.column - (own & 1), j - (own >> 1));
        row.own += mu;
        row.k[stencil_place(own, own ^ 1)] -= T(0.5) * mu;
        row.k[stencil_place(own, own ^ 2)] -= T(0.5) * mu;
      }
      while (held != held_end && held->place < node.column) ++held;
      if (held != held_end && held->place == node.column) row.own += held->stiffness;
      row.inverse = T(1) / row.own;
    }
  }
}

template <class T>
void SpecialRows<T>::linearise_regular(const Membrane<T>& m) {
  for (DiagonalRow<T>& row : diagonal_) std::ranges::fill(row.g, T(0));
  for (int j = 1; j + 1 < m.ux.rows; ++j)
    for (int n = near_begin(j); n < near_begin(j + 1); ++n) {
      const NearNode& node = near_node(n);
      NearRow<T>& row = near_[std::size_t(n)];
      std::ranges::fill(row.g, T(0));
      if (!m.pressure) continue;
      const int i = node.column;
      auto at = [&](int x, int y) { return Vector2<T>{m.ux.at(x, y), m.uy.at(x, y)}; };
      const Vector2<T> u[4] = {at(i - 1, j), at(i + 1, j), at(i, j - 1), at(i, j + 1)};
      // Without branches, which nothing foretells; what special cells have here is written later.
      for (int q = 0; q < 4; ++q) {
        const int own = corner_towards_node(q), i0 = i - (own & 1), j0 = j - (own >> 1);
        const T regular = T(node.regular >> q & 1);
        const T half = regular * (T(0.5) * clamped(m, m.pressure.at(i0, j0), i0, j0));
        row.g[kNextPlace[own]] += half;
        row.g[kPreviousPlace[own]] -= half;
        auto place = [&](std::size_t neighbour, int corner) {
          return Vector2<T>{m.spacing * T(corner & 1) + u[neighbour].x,
                            m.spacing * T(corner >> 1) + u[neighbour].y};
        };
        const Vector2<T> to = place(kNextPlace[own], kNext[own]),
                         from = place(kPreviousPlace[own], kPrevious[own]);
        row.bx[q] = regular * (T(0.5) * (to.y - from.y));
        row.by[q] = regular * (T(-0.5) * (to.x - from.x));
      }
    }
}

template <class T>
void SpecialRows<T>::linearise_part(const Membrane<T>& m, const CellState<T>& u, int cell, int part,
                                    int j) {
  const SpecialCells<T>& cells = *cells_;
  const int i = cells.column[std::size_t(cell)];
  PartRow<T>& row = part_[std::size_t(part)];
  row = {.compliance = cells.area[std::size_t(part)] * compliance_at(m, i, j), .column = i};
  const T half = T(0.5) * clamped(m, m.listed[part], i, j);
  const int begin = cells.vertex_begin[std::size_t(part)],
            end = cells.vertex_begin[std::size_t(part) + 1];
  for (int v = begin; v < end; ++v) {
    const int own = cells.vertex[std::size_t(v)].vertex;
    const int near = own < kFirstCrossing ? unknown_corner(cell, own) : -1;
    if (near < 0) continue;
    NearRow<T>& node = near_[std::size_t(near)];
    const PartVertex<T>& next = cells.vertex[std::size_t(v + 1 < end ? v + 1 : begin)];
    const PartVertex<T>& previous = cells.vertex[std::size_t(v > begin ? v - 1 : end - 1)];
    // Without branches, which nothing foretells.
    DiagonalRow<T>* const diagonals = diagonals_of(near);
    T nowhere[4] = {};
    T* const g[3] = {node.g, diagonals ? diagonals->g : nowhere, nowhere};
    auto at = [&](int other) -> T& {
      const std::size_t place = stencil_place(own, other);
      return g[place / 4][place % 4];
    };
    at(next.vertex) += half;
    at(previous.vertex) -= half;
    const Vector2<T> to = u(next.vertex), from = u(previous.vertex);
    const T bx = T(0.5) * ((next.y - previous.y) + (to.y - from.y));
    const T by = T(-0.5) * ((next.x - previous.x) + (to.x - from.x));
    row.bx[own] = bx;
    row.by[own] = by;
    if (const int q = quadrant(own); node.part[q] == part) {
      node.bx[q] = bx;
      node.by[q] = by;
    } else {
      auto at = further_.begin() + further_begin_[std::size_t(near)];
      while (at->part != part) ++at;
      *at = {part, bx, by};
    }
  }
}

/// gamma h²/(mu_a + mu_b), where kappa differs times the lesser by the greater: pressures jump
/// where kappa does.
template <class T>
void SpecialRows<T>::set_own_jumps(const Membrane<T>& m) {
  const SpecialCells<T>& cells = *cells_;
  own_jump_.assign(cells.neighbour.size(), T(0));
  for_special(cells, [&](int n, int i, int j) {
    for_parts(cells, n, [&](int p) {
      for (int k = cells.neighbour_begin[std::size_t(p)];
           k < cells.neighbour_begin[std::size_t(p) + 1]; ++k) {
        const PartNeighbour& other = cells.neighbour[std::size_t(k)];
        if (other.part < 0) continue;
        const int i2 = i + kEast[std::size_t(other.side)], j2 = j + kNorth[std::size_t(other.side)];
        const auto [stiff, soft] = std::minmax({compliance_at(m, i, j), compliance_at(m, i2, j2)});
        const T alike = stiff == soft ? T(1) : stiff / soft;
        own_jump_[std::size_t(k)] =
            alike * m.part_jump * m.spacing * m.spacing / (mu_at(m, i, j) + mu_at(m, i2, j2));
      }
    });
  });
}

/// Makes room for the equations' own jumps, and for the jump term of pressure_jump.h between parts,
/// and between parts and regular cells.
template <class T>
void SpecialRows<T>::clear_jumps(const Membrane<T>& m) {
  jump_.assign(cells_->neighbour.size(), T(0));
  has_border_jumps_ = m.pressure_jump != T(0);
  has_jumps_ = has_border_jumps_ || !own_jump_.empty();
  part_jumps_.assign(has_jumps_ ? part_.size() : 0, {});
  if (has_border_jumps_ && border_begin_.empty()) list_borders();
}

/// The jump of pressure_jump.h across the piece of side that part p of cell (i, j) shares with
/// `other`.
template <class T>
T SpecialRows<T>::coarse_jump(const Membrane<T>& m, const CellState<T>& u, std::size_t p,
                              const PartNeighbour& other, int i, int j) const {
  const SpecialCells<T>& cells = *cells_;
  const int begin = cells.vertex_begin[p], end = cells.vertex_begin[p + 1];
  const PartVertex<T>& from = cells.vertex[std::size_t(other.vertex)];
  const PartVertex<T>& to =
      cells.vertex[std::size_t(other.vertex + 1 < end ? other.vertex + 1 : begin)];
  const Vector2<T> v = u(from.vertex), w = u(to.vertex);
  const T ex = (to.x - from.x) + (w.x - v.x), ey = (to.y - from.y) + (w.y - v.y);
  const std::size_t side = std::size_t(other.side);
  const T mu = mu_at(m, i, j) + mu_at(m, i + kEast[side], j + kNorth[side]);
  return T(0.125) * m.pressure_jump * (ex * ex + ey * ey) / mu;
}

template <class T>
void SpecialRows<T>::set_jumps(const Membrane<T>& m, const CellState<T>& u, std::size_t p, int i,
                               int j) {
  const SpecialCells<T>& cells = *cells_;
  PartJumps<T>& row = part_jumps_[p];
  std::ranges::fill(row.part, int(p));
  bool met[4] = {};
  for (int k = cells.neighbour_begin[p]; k < cells.neighbour_begin[p + 1]; ++k) {
    const PartNeighbour& other = cells.neighbour[std::size_t(k)];
    const int side = other.side;
    T jump = own_jump(k);
    if (has_border_jumps_) jump += coarse_jump(m, u, p, other, i, j);
    jump_[std::size_t(k)] = jump;
    part_[p].jumps += jump;
    row.more |= met[side];
    if (std::exchange(met[side], true)) continue;
    row.jump[side] = jump;
    if (other.part >= 0 || has_border_jumps_) row.part[side] = other.part;
  }
}

template <class T>
void SpecialRows<T>::set_steps(const Membrane<T>& m) {
  // As in relax_volume: s stays positive where all has collapsed, or all corners are known.
  const T floor = T(1e-6) * m.spacing * m.spacing / (T(4) * m.mu.value);
  for (const CellVisit<T>& visit : visit_)
    for (int p = visit.part_begin; p < visit.part_end; ++p) {
      PartRow<T>& row = part_[std::size_t(p)];
      T s = (row.compliance + row.jumps) + floor;
      for (int c = 0; c < 4; ++c)
        s += (row.bx[c] * row.bx[c] + row.by[c] * row.by[c]) * visit.inverse[c];
      if (soft()) s += curve_weight(*soft(), p);
      row.inverse = T(1) / s;
    }
}

template <class T>
void SpecialRows<T>::linearise(const Membrane<T>& m) {
  if (!cells_) return;
  if (isotropic(m.law.model)) return linearise_isotropic(m);
  linearise_regular(m);
  soft_.linearise(*this, m);
  if (!m.pressure) return;
  clear_jumps(m);
  for_special(*cells_, [&](int n, int i, int j) {
    const CellState<T> u(*cells_, m.ux, m.uy, i, j);
    for_parts(*cells_, n, [&](int p) {
      linearise_part(m, u, n, p, j);
      if (has_jumps_) set_jumps(m, u, std::size_t(p), i, j);
    });
  });
  for (BorderJump<T>& border : border_) border.jump = jump(border.neighbour);
  set_steps(m);
}

template <class T>
std::size_t SpecialRows<T>::bytes() const {
  std::size_t indices = corner_.size();
  for (const auto* list :
       {&near_begin_, &known_, &known_begin_, &loose_, &loose_begin_, &near_half_,
        &near_half_begin_, &visit_begin_, &border_begin_, &further_begin_})
    indices += list->size();
  return indices * sizeof(int) + near_.size() * (sizeof(NearNode) + sizeof(NearRow<T>)) +
         diagonal_.size() * sizeof(DiagonalRow<T>) + visit_.size() * sizeof(CellVisit<T>) +
         part_.size() * sizeof(PartRow<T>) + (jump_.size() + own_jump_.size()) * sizeof(T) +
         part_jumps_.size() * sizeof(PartJumps<T>) + border_.size() * sizeof(BorderJump<T>) +
         further_.size() * sizeof(PartCoupling<T>) + block_.size() * sizeof(BlockRow<T>) +
         fringe_.size() * sizeof(FringeCell) + tangent_.size() * sizeof(T) + soft_.bytes();
}

template class SpecialRows<float>;
template class SpecialRows<double>;

}  // namespace drumhead::kernels
