// SPDX-License-Identifier: MIT
// Transfers between a level that conforms to curves and its coarser one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "conforming.h"
#include "conforming_visits.h"

namespace drumhead::multigrid {
namespace {

/// The triangle of a special cell that holds a point, the nearest one if none does: its vertices
/// and the point's barycentric coordinates.
struct InTriangle {
  std::array<int, 3> code{};
  std::array<double, 3> weight{};
  double least = -std::numeric_limits<double>::infinity();  ///< of the weights: > 0 inside
};
InTriangle find_triangle(const grid::ConformingCells& cells, int c, int j, grid::Point at) {
  constexpr double kInside = 1e-6;  // in no other triangle then
  InTriangle found;
  for_parts(cells, c, [&](int p) {
    if (found.least > kInside) return;
    for_triangles(cells, p, [&](const grid::PartTriangle& triangle, std::array<int, 3> code) {
      if (found.least > kInside) return;
      std::array<double, 3> weight{};
      for (std::size_t a = 0; a < 3; ++a) {
        weight[a] = grid::dot(triangle.gradient[a], at - cells.rest(c, j, code[(a + 1) % 3]));
        if (!(weight[a] > found.least)) return;
      }
      found = {code, weight, *std::ranges::min_element(weight)};
    });
  });
  return found;
}

/// Begins of rows from the numbers of entries in them, which stand one place further.
void add_up(std::vector<int>& counts) {
  std::partial_sum(counts.begin(), counts.end(), counts.begin());
}

template <class T>
void list_pairs(const grid::ConformingCells& fine, const grid::ConformingCells& coarse,
                kernels::SpecialTransfer<T>& transfer) {
  transfer.pair_begin.assign(1, 0);
  transfer.pair.reserve(2 * fine.part_area.size());
  for (int j = 0; j < fine.ny; ++j) {
    const int J = j / 2;
    InRow parents(coarse.cell_begin, coarse.cell_column, J);
    for (int c = fine.cell_begin[std::size_t(j)]; c < fine.cell_begin[std::size_t(j) + 1]; ++c) {
      const int I = fine.cell_column[std::size_t(c)] / 2, parent = parents.find(I);
      for_parts(fine, c, [&](int p) {
        const grid::Point centre = 0.5 * fine.part_centre[std::size_t(p)];
        transfer.pair.push_back({p, parent < 0 ? ~I : coarse.part_at(parent, J, centre)});
      });
    }
    InRow special(fine.cell_begin, fine.cell_column, j);
    for (int c = coarse.cell_begin[std::size_t(J)]; c < coarse.cell_begin[std::size_t(J) + 1];
         ++c) {
      const int I = coarse.cell_column[std::size_t(c)];
      for (int i = 2 * I; i < std::min(2 * I + 2, fine.nx); ++i)
        if (special.find(i) < 0)
          transfer.pair.push_back({~i, coarse.part_at(c, J, {0.5 * (i + 0.5), 0.5 * (j + 0.5)})});
    }
    transfer.pair_begin.push_back(int(transfer.pair.size()));
  }
}

/// The place of node (i, j), number `held` of those that curves hold, in special coarse cell c, or
/// beside it.
InTriangle place_node(const grid::ConformingCells& fine, int i, int j, int held,
                      const grid::ConformingCells& coarse, int c, int I, int J) {
  if (held >= 0) return find_triangle(coarse, c, J, 0.5 * fine.node[std::size_t(held)].rest);
  const int corner = (i > 2 * I ? 1 : 0) + (j > 2 * J ? 2 : 0);
  if (i % 2 == 0 && j % 2 == 0 && coarse.cell_corner[std::size_t(c)][std::size_t(corner)] < 0)
    return {{corner, corner, corner}, {1.0, 0.0, 0.0}, 0.0};
  return find_triangle(coarse, c, J, {0.5 * i, 0.5 * j});
}

/// The inner nodes of a fine row in special coarse cells.
void place_row(const grid::ConformingCells& fine, int j, const grid::ConformingCells& coarse,
               std::vector<PlacedNode>& nodes) {
  struct Cells {  // of a coarse row, from the one on that the node may lie in
    int J, at, end;
  };
  std::array<Cells, 2> rows{};
  std::size_t count = 0;
  for (int J = (j - 1) / 2; J <= std::min(j / 2, coarse.ny - 1); ++J)
    rows[count++] = {J, coarse.cell_begin[std::size_t(J)], coarse.cell_begin[std::size_t(J) + 1]};
  auto west = [&](int c) { return 2 * coarse.cell_column[std::size_t(c)]; };
  InRow held_nodes(fine.node_begin, fine.node_column, j);
  for (int i = 1;; ++i) {
    int next = fine.nx;
    for (Cells& row : std::span(rows).first(count)) {
      while (row.at < row.end && west(row.at) + 2 < i) ++row.at;
      if (row.at < row.end) next = std::min(next, std::max(i, west(row.at)));
    }
    i = next;
    if (i == fine.nx) return;
    const int held = held_nodes.find(i);
    // Where corners have moved, a node between two cells lies in that which it is deepest in.
    double deepest = 0.0;
    bool placed = false;
    for (const Cells& row : std::span(rows).first(count))
      for (int c = row.at; c < row.end && west(c) <= i; ++c) {
        const int I = west(c) / 2;
        const InTriangle in = place_node(fine, i, j, held, coarse, c, I, row.J);
        if (placed && !(in.least > deepest)) continue;
        if (!placed) nodes.emplace_back();
        nodes.back() = {i, j, I, row.J, in.code, in.weight};
        deepest = in.least;
        placed = true;
      }
  }
}

/// Weights of soft coarse curve nodes in a fine lattice node.
template <class T>
void list_curve_nodes(const PlacedNode& node, const grid::ConformingCells& coarse,
                      kernels::SpecialTransfer<T>& transfer) {
  for (std::size_t a = 0; a < 3; ++a) {
    const int curve = node.code[a] - kernels::kFirstCrossing;
    if (curve >= 0 && !std::isinf(coarse.curve_node[std::size_t(curve)].stiffness))
      transfer.of_node.push_back({node.i, curve, T(node.weight[a])});
  }
}

template <class T>
void list_nodes(const std::vector<PlacedNode>& nodes, const grid::ConformingCells& fine,
                const grid::ConformingCells& coarse, kernels::SpecialTransfer<T>& transfer) {
  transfer.node_begin.assign(std::size_t(fine.ny) + 2, 0);
  transfer.of_node_begin = transfer.node_begin;
  for (const PlacedNode& node : nodes) {
    const int held = fine.find_node(node.i, node.j);
    if (held >= 0 && std::isinf(fine.node[std::size_t(held)].stiffness)) continue;
    const std::size_t curves = transfer.of_node.size();
    list_curve_nodes(node, coarse, transfer);
    transfer.of_node_begin[std::size_t(node.j) + 1] += int(transfer.of_node.size() - curves);
    const double x = 0.5 * node.i - node.I, y = 0.5 * node.j - node.J;
    std::array<double, 4> beyond{-(1 - x) * (1 - y), -x * (1 - y), -(1 - x) * y, -x * y};
    for (std::size_t a = 0; a < 3; ++a)
      if (node.code[a] < kernels::kFirstCrossing)
        beyond[std::size_t(node.code[a])] += node.weight[a];
    // A coarse row takes residuals from the three fine rows around it only; a node on it, beside a
    // moved corner, has little weight in other rows.
    if (node.j % 2 == 0) std::fill_n(beyond.begin() + (node.j == 2 * node.J ? 2 : 0), 2, 0.0);
    if (std::ranges::all_of(beyond, [](double w) { return std::abs(w) < 1e-9; })) continue;
    typename kernels::SpecialTransfer<T>::Node& out = transfer.node.emplace_back();
    out.fine = node.i;
    out.column = node.I;
    out.row = node.J;
    std::ranges::transform(beyond, out.weight, [](double w) { return T(w); });
    ++transfer.node_begin[std::size_t(node.j) + 1];
  }
  add_up(transfer.node_begin);
  add_up(transfer.of_node_begin);
  if (transfer.of_node.empty()) transfer.of_node_begin.clear();
}

/// Where a point of the finer level, in coarse cells, lies: of the cells around it the special one
/// that it is deepest in; cell −1: none is special.
struct CoarsePlace {
  int cell = -1, I = 0, J = 0;
  InTriangle in;
};
CoarsePlace find_place(const grid::ConformingCells& cells, grid::Point at) {
  constexpr double kReach = 0.3;  // beyond what moved corners leave out of a cell
  auto index = [](double x, int count) { return std::clamp(int(std::floor(x)), 0, count - 1); };
  CoarsePlace place{-1, index(at.x, cells.nx), index(at.y, cells.ny), {}};
  for (int J = index(at.y - kReach, cells.ny); J <= index(at.y + kReach, cells.ny); ++J)
    for (int I = index(at.x - kReach, cells.nx); I <= index(at.x + kReach, cells.nx); ++I) {
      const int c = cells.find_cell(I, J);
      if (c < 0) continue;
      const InTriangle in = find_triangle(cells, c, J, at);
      if (in.least > place.in.least) place = {c, I, J, in};
    }
  return place;
}

std::array<double, 4> bilinear(double x, double y) {
  return {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
}

/// Weights of coarse nodes in the fine nodes of soft curves.
template <class T>
void list_curves(const grid::ConformingCells& fine, const grid::ConformingCells& coarse,
                 kernels::SpecialTransfer<T>& transfer) {
  struct Row {
    int j;
    typename kernels::SpecialTransfer<T>::OfCurve entry;
  };
  std::vector<Row> rows;
  for (std::size_t n = 0; n < fine.curve_node.size(); ++n) {
    if (std::isinf(fine.curve_node[n].stiffness)) continue;
    const grid::Point at = 0.5 * fine.curve_node[n].rest;
    const CoarsePlace place = find_place(coarse, at);
    const int row = fine.curve_cell[n][1];
    auto add_corner = [&](int code, double weight) {
      const int i = place.I + (code & 1), j = place.J + (code >> 1);
      if (weight != 0.0 && !is_known(coarse, i, j))
        rows.push_back({row, {int(n), i, j, T(weight)}});
    };
    if (place.cell < 0) {
      const std::array<double, 4> weight = bilinear(at.x - place.I, at.y - place.J);
      for (int c = 0; c < 4; ++c) add_corner(c, weight[std::size_t(c)]);
      continue;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const int code = place.in.code[a], curve = code - kernels::kFirstCrossing;
      if (curve < 0)
        add_corner(code, place.in.weight[a]);
      else if (!std::isinf(coarse.curve_node[std::size_t(curve)].stiffness))
        rows.push_back({row, {int(n), curve, -1, T(place.in.weight[a])}});
    }
  }
  if (rows.empty()) return;
  std::ranges::stable_sort(rows, {}, &Row::j);
  transfer.of_curve_begin.assign(std::size_t(fine.ny) + 2, 0);
  for (const Row& entry : rows) {
    transfer.of_curve.push_back(entry.entry);
    ++transfer.of_curve_begin[std::size_t(entry.j) + 1];
  }
  add_up(transfer.of_curve_begin);
}

}  // namespace

template <class T>
void join_levels(const grid::ConformingCells& coarse, ConformingLevel<T>& level) {
  const grid::ConformingCells& fine = level.geometry;
  level.placed.reserve(5 * coarse.cell_column.size());
  for (int j = 1; j < fine.ny; ++j) place_row(fine, j, coarse, level.placed);
  list_pairs(fine, coarse, level.to_coarse);
  list_nodes(level.placed, fine, coarse, level.to_coarse);
  list_curves(fine, coarse, level.to_coarse);
}

template <class T>
void restrict_parts(const ConformingLevel<T>& fine, const kernels::Plane<const T>& fine_pressure,
                    T area, ConformingLevel<T>& coarse) {
  std::vector<T> covered(coarse.pressure.size(), T(0));
  std::ranges::fill(coarse.pressure, T(0));
  for (int j = 0; j < fine.geometry.ny; ++j)
    for (int k = fine.to_coarse.pair_begin[std::size_t(j)];
         k < fine.to_coarse.pair_begin[std::size_t(j) + 1]; ++k) {
      const auto [from, to] = fine.to_coarse.pair[std::size_t(k)];
      if (to < 0) continue;
      const T weight = from >= 0 ? fine.cells.area[std::size_t(from)] : area;
      const T value = from >= 0 ? fine.pressure[std::size_t(from)] : fine_pressure.at(~from, j);
      coarse.pressure[std::size_t(to)] += weight * value;
      covered[std::size_t(to)] += weight;
    }
  // A coarse part that covers no centre of a fine one takes the mean over its cell.
  for_special(coarse.geometry, [&](int c, int i, int j) {
    T sum = T(0);
    int count = 0;
    for (int y = 2 * j; y < std::min(2 * j + 2, fine.geometry.ny); ++y)
      for (int x = 2 * i; x < std::min(2 * i + 2, fine.geometry.nx); ++x, ++count)
        sum += fine_pressure.at(x, y);
    for_parts(coarse.geometry, c, [&](int p) {
      T& value = coarse.pressure[std::size_t(p)];
      value = covered[std::size_t(p)] > T(0) ? value / covered[std::size_t(p)] : sum / T(count);
    });
  });
}

template <class T>
void prolong_parts(const ConformingLevel<T>& coarse, const kernels::Plane<const T>& coarse_pressure,
                   ConformingLevel<T>& fine, const kernels::Plane<T>& fine_pressure) {
  for (int j = 0; j < fine.geometry.ny; ++j)
    for (int k = fine.to_coarse.pair_begin[std::size_t(j)];
         k < fine.to_coarse.pair_begin[std::size_t(j) + 1]; ++k) {
      const auto [to, from] = fine.to_coarse.pair[std::size_t(k)];
      const T value =
          from >= 0 ? coarse.pressure[std::size_t(from)] : coarse_pressure.at(~from, j / 2);
      (to >= 0 ? fine.pressure[std::size_t(to)] : fine_pressure.at(~to, j)) = value;
    }
}

/// Of a vertex of special cell (i, j).
template <class T>
grid::Point displacement(const ConformingLevel<T>& level, const kernels::Plane<const T>& x,
                         const kernels::Plane<const T>& y, int i, int j, int code) {
  if (code < kernels::kFirstCrossing)
    return {double(x.at(i + (code & 1), j + (code >> 1))),
            double(y.at(i + (code & 1), j + (code >> 1)))};
  const kernels::HeldNode<T>& node =
      level.cells.crossing[std::size_t(code - kernels::kFirstCrossing)];
  return {double(node.ux()), double(node.uy())};
}

/// How far a node that wants `wanted` is off at a point of another level.
template <class T>
grid::Point off_target(const ConformingLevel<T>& from, const kernels::Plane<const T>& x,
                       const kernels::Plane<const T>& y, grid::Point at, grid::Point wanted) {
  const CoarsePlace place = find_place(from.geometry, at);
  grid::Point u{0.0, 0.0}, off{0.0, 0.0};
  double held = 0.0;
  auto add = [&](double weight, int code) {
    u = u + weight * displacement(from, x, y, place.I, place.J, code);
    const int corner = code < kernels::kFirstCrossing && place.cell >= 0
                           ? from.geometry.cell_corner[std::size_t(place.cell)][std::size_t(code)]
                           : -1;
    if (code < kernels::kFirstCrossing && corner < 0) return;
    const kernels::HeldNode<T>& node =
        corner >= 0 ? from.cells.held[std::size_t(corner)]
                    : from.cells.crossing[std::size_t(code - kernels::kFirstCrossing)];
    off = off + weight * grid::Point{double(node.off_x), double(node.off_y)};
    held += weight;
  };
  const std::array<double, 4> weight = bilinear(at.x - place.I, at.y - place.J);
  for (std::size_t a = 0; a < 3 && place.cell >= 0; ++a) add(place.in.weight[a], place.in.code[a]);
  for (std::size_t c = 0; c < 4 && place.cell < 0; ++c) add(weight[c], int(c));
  return held > 0.5 ? (1.0 / held) * off : u - wanted;
}

template <class T>
void transfer_soft(const ConformingLevel<T>& from, const kernels::Plane<const T>& from_x,
                   const kernels::Plane<const T>& from_y, double scale, ConformingLevel<T>& to) {
  auto set = [&](const grid::HeldNode& node, kernels::HeldNode<T>& held) {
    if (held.known()) return;
    const grid::Point wanted{double(held.wanted_x), double(held.wanted_y)};
    const grid::Point off = off_target(from, from_x, from_y, scale * node.rest, wanted);
    held.off_x = T(off.x);
    held.off_y = T(off.y);
  };
  for (std::size_t n = 0; n < to.cells.held.size(); ++n) set(to.geometry.node[n], to.cells.held[n]);
  for (std::size_t n = 0; n < to.cells.crossing.size(); ++n)
    set(to.geometry.curve_node[n], to.cells.crossing[n]);
}

template <class T>
void prolong_special_nodes(const ConformingLevel<T>& coarse,
                           const kernels::Plane<const T>& coarse_x,
                           const kernels::Plane<const T>& coarse_y, const ConformingLevel<T>& fine,
                           const kernels::Plane<T>& x, const kernels::Plane<T>& y) {
  for (const PlacedNode& node : fine.placed) {
    double ux = 0.0, uy = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const grid::Point u = displacement(coarse, coarse_x, coarse_y, node.I, node.J, node.code[a]);
      ux += node.weight[a] * u.x;
      uy += node.weight[a] * u.y;
    }
    x.at(node.i, node.j) = T(ux);
    y.at(node.i, node.j) = T(uy);
  }
}

#define DRUMHEAD_INSTANTIATE(T)                                                                  \
  template void join_levels(const grid::ConformingCells&, ConformingLevel<T>&);                  \
  template void restrict_parts(const ConformingLevel<T>&, const kernels::Plane<const T>&, T,     \
                               ConformingLevel<T>&);                                             \
  template void prolong_parts(const ConformingLevel<T>&, const kernels::Plane<const T>&,         \
                              ConformingLevel<T>&, const kernels::Plane<T>&);                    \
  template void transfer_soft(const ConformingLevel<T>&, const kernels::Plane<const T>&,         \
                              const kernels::Plane<const T>&, double, ConformingLevel<T>&);      \
  template void prolong_special_nodes(const ConformingLevel<T>&, const kernels::Plane<const T>&, \
                                      const kernels::Plane<const T>&, const ConformingLevel<T>&, \
                                      const kernels::Plane<T>&, const kernels::Plane<T>&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::multigrid
