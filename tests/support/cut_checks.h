// SPDX-License-Identifier: MIT
#pragma once
// Helpers of the tests of cut cells: curves in cell units on a lattice of unit cells, and sums over
// cuts that must not depend on how the curves were cut.
#include <set>
#include <utility>
#include <vector>

#include <drumhead/grid/cut_cells.h>

namespace drumhead::grid {

/// nx × ny cells of one pixel, node (0, 0) at the origin.
inline Lattice unit_lattice(int nx, int ny) {
  return {.nx = nx, .ny = ny, .side_px = double(nx > ny ? nx : ny)};
}

/// A chain of straight segments through the points, pinned unless `move` changes it.
inline std::vector<CubicBezier> polyline(const std::vector<Point>& points) {
  std::vector<CubicBezier> chain;
  for (std::size_t n = 0; n + 1 < points.size(); ++n)
    chain.push_back(straight(points[n], points[n + 1]));
  return chain;
}
inline CurvePair pinned(const std::vector<CubicBezier>& chain) {
  return {.name = "pin", .source = chain, .target = chain};
}
inline CurvePair pin(const std::vector<Point>& points) { return pinned(polyline(points)); }

/// Four Béziers near a circle, starting on its right.
inline std::vector<CubicBezier> round(Point centre, double radius) {
  constexpr double kHandle = 0.5522847498;
  const std::vector<Point> axes{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  std::vector<CubicBezier> chain;
  for (std::size_t n = 0; n < 4; ++n) {
    const Point a = axes[n], b = axes[(n + 1) % 4];
    chain.push_back({{{centre + radius * a, centre + radius * (a + kHandle * b),
                       centre + radius * (b + kHandle * a), centre + radius * b}}});
  }
  return chain;
}

/// (i, j) of every cut in order.
inline std::vector<std::pair<int, int>> cells_of(const CutCells& cuts) {
  std::vector<std::pair<int, int>> cells;
  for (std::size_t j = 0; j + 1 < cuts.row_begin.size(); ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k)
      cells.emplace_back(cuts.column[std::size_t(k)], int(j));
  return cells;
}

/// The pairs of cells that are linked, each in both orders.
using CellPair = std::pair<std::pair<int, int>, std::pair<int, int>>;
inline std::set<CellPair> links_of(const CutCells& cuts) {
  const auto cells = cells_of(cuts);
  std::set<CellPair> links;
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l)
      links.insert({cells[k], cells[std::size_t(cuts.link[std::size_t(l)])]});
  return links;
}

inline double total_length(const CutCells& cuts) {
  double sum = 0.0;
  for (const double len : cuts.length) sum += len;
  return sum;
}

/// Σ weight of one cut.
inline double weight_sum(const CutCells& cuts, std::size_t k) {
  double sum = 0.0;
  for (const double w : cuts.weight[k]) sum += w;
  return sum;
}

/// The point that a cut's weights average: Σ w X.
inline Point mean_point(const CutCells& cuts, std::size_t k, std::pair<int, int> cell) {
  Point sum;
  for (int n = 0; n < 4; ++n) {
    const Point corner{double(cell.first + (n & 1)), double(cell.second + (n >> 1))};
    sum = sum + cuts.weight[k][std::size_t(n)] * corner;
  }
  return sum;
}

}  // namespace drumhead::grid
