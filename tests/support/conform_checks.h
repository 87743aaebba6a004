// SPDX-License-Identifier: MIT
#pragma once
// Properties that every construction of conforming cells must have, each returning what is wrong
// with it, empty if nothing is.
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <drumhead/grid/conforming.h>

namespace drumhead::grid {

/// f(cell, row, part) for every part.
template <class F>
void for_parts(const ConformingCells& cells, F&& f) {
  for (int j = 0; j < cells.ny; ++j)
    for (int c = cells.cell_begin[std::size_t(j)]; c < cells.cell_begin[std::size_t(j) + 1]; ++c)
      for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1]; ++p)
        f(c, j, p);
}

inline std::vector<int> codes_of(const ConformingCells& cells, int part) {
  return {cells.part_node.begin() + cells.part_node_begin[std::size_t(part)],
          cells.part_node.begin() + cells.part_node_begin[std::size_t(part) + 1]};
}

/// j·(nx+1) + i of a lattice node, beyond them curve nodes.
inline std::int64_t node_number(const ConformingCells& cells, int c, int j, int code) {
  if (code >= 4) return std::int64_t(cells.nx + 1) * (cells.ny + 1) + code - 4;
  return std::int64_t(j + (code >> 1)) * (cells.nx + 1) + cells.cell_column[std::size_t(c)] +
         (code & 1);
}

/// Every triangle is positive, its gradients are those of its shape functions, and the triangles of
/// a part make up its outline.
inline std::string wrong_triangles(const ConformingCells& cells) {
  std::string wrong;
  for_parts(cells, [&](int c, int j, int p) {
    const std::vector<int> codes = codes_of(cells, p);
    if (int(codes.size()) > kMostPartNodes) wrong = "a part with too many nodes";
    auto at = [&](std::size_t n) { return cells.rest(c, j, codes[n]); };
    double outline = 0.0, sum = 0.0;
    for (std::size_t n = 0; n < codes.size(); ++n)
      outline += 0.5 * cross(at(n), at((n + 1) % codes.size()));
    for (int t = cells.part_triangle_begin[std::size_t(p)];
         t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
      const PartTriangle& tri = cells.triangle[std::size_t(t)];
      if (!(tri.area > 0.0)) wrong = "a triangle of area " + std::to_string(tri.area);
      sum += tri.area;
      for (std::size_t n = 0; n < 3; ++n)
        for (std::size_t m = 0; m < 3; ++m) {
          const double value = dot(tri.gradient[n], at(std::size_t(tri.node[m])) -
                                                        at(std::size_t(tri.node[(n + 1) % 3])));
          if (std::abs(value - (n == m ? 1.0 : 0.0)) > 1e-9) wrong = "a wrong gradient";
        }
    }
    if (std::abs(sum - outline) > 1e-12) wrong = "triangles that do not add up to their part";
    if (std::abs(sum - cells.part_area[std::size_t(p)]) > 1e-12) wrong = "a wrong area";
  });
  return wrong;
}

/// Special and regular cells together cover the lattice once: side by side, every piece of a side
/// has one part on each of its two sides, and the areas add up.
inline std::string wrong_tiling(const ConformingCells& cells) {
  std::map<std::pair<std::int64_t, std::int64_t>, int> pieces;
  double area = double(cells.nx) * cells.ny - cells.cells();
  for_parts(cells, [&](int c, int j, int p) {
    const std::vector<int> codes = codes_of(cells, p);
    for (std::size_t n = 0; n < codes.size(); ++n)
      ++pieces[{node_number(cells, c, j, codes[n]),
                node_number(cells, c, j, codes[(n + 1) % codes.size()])}];
    area += cells.part_area[std::size_t(p)];
  });
  if (std::abs(area - double(cells.nx) * cells.ny) > 1e-9)
    return "areas add up to " + std::to_string(area);
  const std::int64_t row = cells.nx + 1, nodes = row * (cells.ny + 1);
  auto at_rest = [&](std::int64_t n) {
    return cells.find_node(int(n % row), int(n / row)) < 0 ||
           cells.node[std::size_t(cells.find_node(int(n % row), int(n / row)))].rest ==
               Point{double(n % row), double(n / row)};
  };
  for (const auto& [piece, count] : pieces) {
    const auto [a, b] = piece;
    if (count != 1) return "a piece of a side with two parts on one side";
    if (pieces.contains({b, a})) continue;
    // The other side is a regular cell or the outside.
    auto on_edge = [&](std::int64_t n, int axis) {  // 0, 1: x = 0, nx; 2, 3: y = 0, ny
      const double limit[4] = {0.0, double(cells.nx), 0.0, double(cells.ny)};
      const Point at = n >= nodes ? cells.curve_node[std::size_t(n - nodes)].rest
                                  : Point{double(n % row), double(n / row)};
      return (axis < 2 ? at.x : at.y) == limit[axis];
    };
    bool outside = false;
    for (int axis = 0; axis < 4; ++axis) outside |= on_edge(a, axis) && on_edge(b, axis);
    if (outside) continue;
    if (a >= nodes || b >= nodes) return "a curve node that one cell does not know";
    if (std::abs(a - b) != 1 && std::abs(a - b) != row) return "a diagonal with one side only";
    if (!at_rest(a) || !at_rest(b)) return "a regular cell with a moved corner";
  }
  return {};
}

}  // namespace drumhead::grid
