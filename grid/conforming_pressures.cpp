// SPDX-License-Identifier: MIT
#include "conforming_pressures.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace drumhead::grid {
namespace {

/// A piece of a cell's side between two nodes, and the part whose outline it belongs to.
struct Piece {
  std::int64_t from, to;
  int part, cell;
  friend auto operator<=>(const Piece&, const Piece&) = default;
};

/// Pieces of the sides of special cells. A piece between two held nodes may be a curve's and joins
/// nothing.
std::vector<Piece> open_pieces(const ConformingCells& cells) {
  std::vector<Piece> pieces;
  const std::int64_t nodes = std::int64_t(cells.nx + 1) * (cells.ny + 1);
  for (int j = 0; j < cells.ny; ++j)
    for (int c = cells.cell_begin[std::size_t(j)]; c < cells.cell_begin[std::size_t(j) + 1]; ++c)
      for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1];
           ++p) {
        auto number = [&](int code) {
          if (code >= 4) return nodes + code - 4;
          const int i = cells.cell_column[std::size_t(c)] + (code & 1);
          return std::int64_t(j + (code >> 1)) * (cells.nx + 1) + i;
        };
        auto held = [&](int code) {
          return code >= 4 || cells.cell_corner[std::size_t(c)][std::size_t(code)] >= 0;
        };
        const int first = cells.part_node_begin[std::size_t(p)],
                  end = cells.part_node_begin[std::size_t(p) + 1];
        for (int n = first; n < end; ++n) {
          const int a = cells.part_node[std::size_t(n)],
                    b = cells.part_node[std::size_t(n + 1 < end ? n + 1 : first)];
          if (held(a) && held(b)) continue;
          const auto [from, to] = std::minmax({number(a), number(b)});
          pieces.push_back({from, to, p, c});
        }
      }
  std::ranges::sort(pieces);
  return pieces;
}

}  // namespace

void share_pressures(ConformingCells& cells, double least_area) {
  const std::size_t parts = std::size_t(cells.parts());
  if (least_area == 0.0) {
    cells.part_pressure.resize(parts);
    std::iota(cells.part_pressure.begin(), cells.part_pressure.end(), 0);
    cells.pressures = cells.parts();
    return;
  }
  // Neighbours on the same side: parts of two cells with a common piece.
  std::vector<std::array<int, 2>> neighbours;
  const std::vector<Piece> pieces = open_pieces(cells);
  for (std::size_t n = 0; n + 1 < pieces.size(); ++n) {
    const Piece &a = pieces[n], &b = pieces[n + 1];
    if (a.from != b.from || a.to != b.to || a.cell == b.cell) continue;
    neighbours.push_back({a.part, b.part});
    neighbours.push_back({b.part, a.part});
  }
  std::ranges::sort(neighbours);
  std::vector<int> root(parts), order(parts);
  std::iota(root.begin(), root.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> area = cells.part_area;
  auto find = [&](int p) {
    while (root[std::size_t(p)] != p) p = root[std::size_t(p)];
    return p;
  };
  std::ranges::stable_sort(order, {}, [&](int p) { return cells.part_area[std::size_t(p)]; });
  for (const int p : order) {
    const int own = find(p);
    if (cells.part_area[std::size_t(p)] >= least_area) break;
    if (area[std::size_t(own)] >= least_area) continue;
    int largest = -1;
    for (auto n = std::ranges::lower_bound(neighbours, std::array<int, 2>{p, -1});
         n != neighbours.end() && (*n)[0] == p; ++n) {
      const int other = find((*n)[1]);
      if (other != own && (largest < 0 || area[std::size_t(other)] > area[std::size_t(largest)]))
        largest = other;
    }
    if (largest < 0) continue;
    root[std::size_t(own)] = largest;
    area[std::size_t(largest)] += area[std::size_t(own)];
  }
  cells.part_pressure.assign(parts, -1);
  cells.pressures = 0;
  for (std::size_t p = 0; p < parts; ++p) {
    int& pressure = cells.part_pressure[std::size_t(find(int(p)))];
    if (pressure < 0) pressure = cells.pressures++;
    cells.part_pressure[p] = pressure;
  }
}

int ConformingCells::part_at(int c, Point at) const {
  const int j = int(std::ranges::upper_bound(cell_begin, c) - cell_begin.begin()) - 1;
  int nearest = part_begin[std::size_t(c)];
  double best = -1e300;             // the least barycentric coordinate: how far inside the triangle
  constexpr double kInside = 1e-6;  // in no other triangle then
  for (int p = part_begin[std::size_t(c)]; p < part_begin[std::size_t(c) + 1]; ++p)
    for (int t = part_triangle_begin[std::size_t(p)]; t < part_triangle_begin[std::size_t(p) + 1];
         ++t) {
      const PartTriangle& tri = triangle[std::size_t(t)];
      double least = 1.0;
      for (std::size_t n = 0; n < 3 && least > best; ++n) {
        const int code = part_node[std::size_t(part_node_begin[std::size_t(p)] + tri.node[n])];
        least = std::min(least, 1.0 + dot(tri.gradient[n], at - rest(c, j, code)));
      }
      if (least <= best) continue;
      best = least;
      nearest = p;
      if (best > kInside) return p;
    }
  return nearest;
}

}  // namespace drumhead::grid
