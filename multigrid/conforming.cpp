// SPDX-License-Identifier: MIT
#include "conforming.h"

#include <algorithm>
#include <numeric>

#include "conforming_visits.h"

namespace drumhead::multigrid {
namespace {

template <class T>
void add_cell(const grid::ConformingCells& from, int c, int i, int j, T spacing,
              kernels::SpecialCells<T>& to) {
  const double h = double(spacing), inverse = 1.0 / h;  // exact: a power of two
  to.column.push_back(i);
  for_parts(from, c, [&](int p) {
    for_triangles(from, p, [&](const grid::PartTriangle& triangle, std::array<int, 3> code) {
      kernels::Triangle<T>& out = to.triangle.emplace_back();
      out.area = T(triangle.area * h * h);
      for (std::size_t a = 0; a < 3; ++a) {
        out.vertex[a] = code[a];
        out.gx[a] = T(triangle.gradient[a].x * inverse);
        out.gy[a] = T(triangle.gradient[a].y * inverse);
      }
    });
    for (int n = from.part_node_begin[std::size_t(p)]; n < from.part_node_begin[std::size_t(p) + 1];
         ++n) {
      const int code = from.part_node[std::size_t(n)];
      const grid::Point rest = from.rest(c, j, code) - grid::Point{double(i), double(j)};
      to.vertex.push_back({code, T(rest.x * h), T(rest.y * h)});
    }
    to.vertex_begin.push_back(int(to.vertex.size()));
    to.area.push_back(T(from.part_area[std::size_t(p)] * h * h));
  });
  to.part_begin.push_back(int(to.area.size()));
  to.triangle_begin.push_back(int(to.triangle.size()));
}

/// visit(part, vertex of its boundary, code there, code at the next one)
template <class F>
void for_sides(const grid::ConformingCells& cells, int c, F&& visit) {
  for_parts(cells, c, [&](int p) {
    const int first = cells.part_node_begin[std::size_t(p)],
              end = cells.part_node_begin[std::size_t(p) + 1];
    for (int n = first; n < end; ++n)
      visit(p, n, cells.part_node[std::size_t(n)],
            cells.part_node[std::size_t(n + 1 < end ? n + 1 : first)]);
  });
}

// What lies beyond a side of a cell, besides special cells.
constexpr int kRegular = -1, kOutside = -2;
constexpr std::array<int, 4> kEast{0, 1, 0, -1}, kNorth{-1, 0, 1, 0};

/// The special cells beyond the sides (south, east, north, west) of special cell c at (i, j).
/// `below`, `above`: the rows there.
std::array<int, 4> cells_around(const grid::ConformingCells& cells, int c, int i, int j,
                                InRow& below, InRow& above) {
  auto beside = [&](int other) {
    return other >= cells.cell_begin[std::size_t(j)] &&
                   other < cells.cell_begin[std::size_t(j) + 1] &&
                   cells.cell_column[std::size_t(other)] == i + other - c
               ? other
               : kRegular;
  };
  return {j > 0 ? below.find(i) : kOutside, i + 1 < cells.nx ? beside(c + 1) : kOutside,
          j + 1 < cells.ny ? above.find(i) : kOutside, i > 0 ? beside(c - 1) : kOutside};
}

/// The side of special cell (i, j) that holds the piece a–b of a part's boundary: counter-clockwise
/// from corner to corner, or to or from a crossing on the side. −1: the piece is a chord's.
int side_of(const grid::ConformingCells& cells, int i, int j, int a, int b) {
  constexpr std::array<std::array<int, 4>, 4> kSide{
      {{-1, 0, -1, -1}, {-1, -1, -1, 1}, {3, -1, -1, -1}, {-1, -1, 2, -1}}};
  if (a < kernels::kFirstCrossing && b < kernels::kFirstCrossing)
    return kSide[std::size_t(a)][std::size_t(b)];
  const std::size_t n = std::size_t(std::max(a, b) - kernels::kFirstCrossing);
  switch (cells.curve_place[n]) {
    case grid::NodePlace::on_x_edge:
      return cells.curve_cell[n][1] == j ? 0 : 2;
    case grid::NodePlace::on_y_edge:
      return cells.curve_cell[n][0] == i ? 3 : 1;
    default:
      return -1;
  }
}

/// The part of special cell `other`, beyond a side, whose boundary has the piece a–b of that side.
int part_across(const grid::ConformingCells& cells, int other, int side, int a, int b) {
  constexpr std::array<int, 4> kMirrored{2, -1, -2, 1};  // what a corner's code has more there
  auto there = [&](int code) {
    return code < kernels::kFirstCrossing ? code + kMirrored[std::size_t(side)] : code;
  };
  int found = -1;
  for_sides(cells, other, [&, first = there(b), second = there(a)](int p, int, int from, int to) {
    if (from == first && to == second) found = p;
  });
  return found;
}

/// Sorts borders, given with their rows and by parts, by row and column.
template <class T>
void sort_borders(int rows, const std::vector<std::pair<int, kernels::PartBorder>>& borders,
                  kernels::SpecialCells<T>& to) {
  to.border_begin.assign(std::size_t(rows) + 1, 0);
  for (const auto& [row, border] : borders) ++to.border_begin[std::size_t(row) + 1];
  std::partial_sum(to.border_begin.begin(), to.border_begin.end(), to.border_begin.begin());
  to.border.resize(borders.size());
  std::vector<int> next = to.border_begin;
  for (const auto& [row, border] : borders)
    to.border[std::size_t(next[std::size_t(row)]++)] = border;
  for (std::size_t j = 0; j < std::size_t(rows); ++j)
    std::ranges::stable_sort(to.border.begin() + to.border_begin[j],
                             to.border.begin() + to.border_begin[j + 1], {},
                             &kernels::PartBorder::column);
}

/// What parts border on: regular cells, and parts with a common piece of a side. A piece between
/// two held nodes may be a curve's and joins no parts.
template <class T>
void list_neighbours(const grid::ConformingCells& from, kernels::SpecialCells<T>& to) {
  std::vector<std::pair<int, kernels::PartBorder>> borders;  // row of the regular cell
  to.neighbour_begin.assign(std::size_t(from.parts()) + 1, 0);
  to.neighbour.reserve(from.part_node.size());
  auto of_cell = [&](int c, int i, int j, const std::array<int, 4>& around) {
    auto held = [&](int code) {
      return code >= kernels::kFirstCrossing ||
             from.cell_corner[std::size_t(c)][std::size_t(code)] >= 0;
    };
    for_sides(from, c, [&](int p, int n, int a, int b) {
      const int side = side_of(from, i, j, a, b);
      if (side < 0 || around[std::size_t(side)] == kOutside) return;
      const bool corners = std::max(a, b) < kernels::kFirstCrossing;
      int other = -1;
      if (around[std::size_t(side)] == kRegular) {
        if (!corners) return;
        borders.push_back({j + kNorth[std::size_t(side)],
                           {i + kEast[std::size_t(side)], p, int(to.neighbour.size())}});
      } else {
        if (held(a) && held(b)) return;
        other = part_across(from, around[std::size_t(side)], side, a, b);
        if (other < 0) return;
      }
      to.neighbour.push_back({other, n, side});
      ++to.neighbour_begin[std::size_t(p) + 1];
    });
  };
  for (int j = 0; j < from.ny; ++j) {
    InRow below(from.cell_begin, from.cell_column, j - 1),
        above(from.cell_begin, from.cell_column, j + 1);
    for (int c = from.cell_begin[std::size_t(j)]; c < from.cell_begin[std::size_t(j) + 1]; ++c) {
      const int i = from.cell_column[std::size_t(c)];
      of_cell(c, i, j, cells_around(from, c, i, j, below, above));
    }
  }
  std::partial_sum(to.neighbour_begin.begin(), to.neighbour_begin.end(),
                   to.neighbour_begin.begin());
  sort_borders(from.ny, borders, to);
}

template <class T>
void set_targets(const grid::ConformingCells& from, T spacing, kernels::SpecialCells<T>& to) {
  const double h = double(spacing);
  auto set = [h](const grid::HeldNode& node, int place, kernels::HeldNode<T>& out) {
    out.place = place;
    out.wanted_x = T(node.wanted.x * h);
    out.wanted_y = T(node.wanted.y * h);
    out.stiffness = T(node.stiffness);
  };
  to.held.resize(from.node.size());
  to.crossing.resize(from.curve_node.size());
  to.held_begin = from.node_begin;
  for (std::size_t n = 0; n < from.node.size(); ++n)
    set(from.node[n], from.node_column[n], to.held[n]);
  for (std::size_t n = 0; n < from.curve_node.size(); ++n)
    set(from.curve_node[n], from.curve_cell[n][1], to.crossing[n]);
}

template <class T>
kernels::SpecialCells<T> special_cells(const grid::ConformingCells& from, T spacing) {
  kernels::SpecialCells<T> to;
  to.row_begin = from.cell_begin;
  for (auto* begin : {&to.part_begin, &to.triangle_begin, &to.vertex_begin}) {
    begin->reserve(from.part_area.size() + 1);
    begin->push_back(0);
  }
  to.column.reserve(from.cell_column.size());
  to.triangle.reserve(from.triangle.size());
  to.vertex.reserve(from.part_node.size());
  to.area.reserve(from.part_area.size());
  for_special(from, [&](int c, int i, int j) { add_cell(from, c, i, j, spacing, to); });
  set_targets(from, spacing, to);
  list_neighbours(from, to);
  return to;
}

}  // namespace

template <class T>
ConformingLevel<T>::ConformingLevel(grid::ConformingCells from, T spacing)
    : geometry(std::move(from)),
      cells(special_cells(geometry, spacing)),
      pressure(cells.area.size(), T(0)),
      regions(geometry, cells) {}

template <class T>
void ConformingLevel<T>::retarget(T spacing) {
  set_targets(geometry, spacing, cells);
}

template <class T>
void ConformingLevel<T>::clear(const kernels::Plane<T>& ux, const kernels::Plane<T>& uy) {
  std::ranges::fill(pressure, T(0));
  std::ranges::fill(shift, T(0));
  for (auto* nodes : {&cells.held, &cells.crossing})
    for (kernels::HeldNode<T>& node : *nodes) node.off_x = node.off_y = T(0);
  set_held(*this, ux, uy);
}

template <class T>
std::size_t ConformingLevel<T>::curve_unknowns() const {
  auto soft = [](const kernels::HeldNode<T>& node) { return !node.known(); };
  return std::ranges::any_of(cells.crossing, soft) ? 2 * cells.crossing.size() : 0;
}

template <class T>
std::size_t ConformingLevel<T>::bytes() const {
  return rows.bytes() + cells.triangle.size() * sizeof(kernels::Triangle<T>) +
         cells.vertex.size() * sizeof(kernels::PartVertex<T>) +
         (4 * pressure.size() + shift.size()) * sizeof(T);
}

template <class T>
std::size_t ConformingLevel<T>::transfer_bytes() const {
  return to_coarse.pair.size() * sizeof(typename kernels::SpecialTransfer<T>::Pair) +
         to_coarse.node.size() * sizeof(typename kernels::SpecialTransfer<T>::Node) +
         placed.size() * sizeof(PlacedNode);
}

template <class T>
void set_held(const ConformingLevel<T>& level, const kernels::Plane<T>& ux,
              const kernels::Plane<T>& uy) {
  const kernels::SpecialCells<T>& cells = level.cells;
  for (int j = 0; j < ux.rows; ++j)
    for (int k = cells.held_begin[std::size_t(j)]; k < cells.held_begin[std::size_t(j) + 1]; ++k) {
      const kernels::HeldNode<T>& node = cells.held[std::size_t(k)];
      ux.at(node.place, j) = node.ux();
      uy.at(node.place, j) = node.uy();
    }
}

template <class T>
void move_held(ConformingLevel<T>& level, const kernels::Unknowns<const T>& d, T step,
               const kernels::Plane<T>& ux, const kernels::Plane<T>& uy) {
  auto move = [step](kernels::HeldNode<T>& node, T dx, T dy) {
    node.off_x += step * dx;
    node.off_y += step * dy;
  };
  kernels::SpecialCells<T>& cells = level.cells;
  for (int j = 0; j < ux.rows; ++j)
    for (int k = cells.held_begin[std::size_t(j)]; k < cells.held_begin[std::size_t(j) + 1]; ++k)
      if (kernels::HeldNode<T>& node = cells.held[std::size_t(k)]; !node.known())
        move(node, d.x.at(node.place, j), d.y.at(node.place, j));
  for (int c = 0; c < d.curve_count / 2; ++c)
    move(cells.crossing[std::size_t(c)], d.curve[2 * c], d.curve[2 * c + 1]);
  set_held(level, ux, uy);
}

template <class T>
void set_part_means(const ConformingLevel<T>& level, const kernels::Plane<T>& pressure) {
  for_special(level.geometry, [&](int c, int i, int j) {
    T sum = T(0), area = T(0);
    for_parts(level.geometry, c, [&](int p) {
      sum += level.cells.area[std::size_t(p)] * level.pressure[std::size_t(p)];
      area += level.cells.area[std::size_t(p)];
    });
    pressure.at(i, j) = sum / area;
  });
}

template <class T>
void set_shift_means(const ConformingLevel<T>& level, grid::Field<T> (&shift)[4]) {
  const kernels::SpecialCells<T>& cells = level.cells;
  for_special(level.geometry, [&](int c, int i, int j) {
    T sum = T(0), area = T(0);
    for (int t = cells.triangle_begin[std::size_t(c)]; t < cells.triangle_begin[std::size_t(c) + 1];
         ++t) {
      sum += cells.triangle[std::size_t(t)].area * level.shift[std::size_t(t)];
      area += cells.triangle[std::size_t(t)].area;
    }
    for (grid::Field<T>& plane : shift) plane.view().at(i, j) = sum / area;
  });
}

template <class T>
void set_shifts(const grid::Field<T> (&shift)[4], ConformingLevel<T>& level) {
  const kernels::SpecialCells<T>& cells = level.cells;
  for_special(level.geometry, [&](int c, int i, int j) {
    T sum = T(0);
    for (const grid::Field<T>& plane : shift) sum += plane.view().at(i, j);
    std::fill(level.shift.begin() + cells.triangle_begin[std::size_t(c)],
              level.shift.begin() + cells.triangle_begin[std::size_t(c) + 1], T(0.25) * sum);
  });
}

#define DRUMHEAD_INSTANTIATE(T)                                                      \
  template struct ConformingLevel<T>;                                                \
  template void set_held(const ConformingLevel<T>&, const kernels::Plane<T>&,        \
                         const kernels::Plane<T>&);                                  \
  template void move_held(ConformingLevel<T>&, const kernels::Unknowns<const T>&, T, \
                          const kernels::Plane<T>&, const kernels::Plane<T>&);       \
  template void set_part_means(const ConformingLevel<T>&, const kernels::Plane<T>&); \
  template void set_shift_means(const ConformingLevel<T>&, grid::Field<T>(&)[4]);    \
  template void set_shifts(const grid::Field<T>(&)[4], ConformingLevel<T>&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::multigrid
