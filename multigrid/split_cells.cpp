// SPDX-License-Identifier: MIT
#include "split_cells.h"

#include <cassert>

namespace drumhead::multigrid {
namespace {

/// Rest position and displacement of the nodes of special cells, in picture pixels.
class Nodes {
 public:
  Nodes(const grid::ConformingCells& cells, const std::vector<grid::Point>& curve,
        const Solution& solution)
      : cells_(cells), curve_(curve), solution_(solution) {}

  kernels::Position rest(int c, int j, int code) const {
    const grid::Lattice& lattice = solution_.lattice;
    const int held = code < 4 ? cells_.cell_corner[std::size_t(c)][std::size_t(code)] : 0;
    if (held < 0) {  // exactly where the bilinear cells have it
      const grid::Point at = lattice.rest_px(column(c, code), j + (code >> 1));
      return {at.x, at.y};
    }
    const grid::Point at = lattice.origin_px + lattice.cell_px * cells_.rest(c, j, code);
    return {at.x, at.y};
  }
  kernels::Position displacement(int c, int j, int code) const {
    if (code >= 4) {
      const grid::Point d = curve_[std::size_t(code - 4)];
      return {d.x, d.y};
    }
    const std::size_t n =
        std::size_t(j + (code >> 1)) * std::size_t(cells_.nx + 1) + std::size_t(column(c, code));
    return {solution_.u_px[n], solution_.v_px[n]};
  }

 private:
  int column(int c, int code) const { return cells_.cell_column[std::size_t(c)] + (code & 1); }

  const grid::ConformingCells& cells_;
  const std::vector<grid::Point>& curve_;
  const Solution& solution_;
};

}  // namespace

void set_split_cells(const grid::ConformingCells& cells,
                     const std::vector<grid::Point>& curve_displacement_px, Solution& solution) {
  assert(curve_displacement_px.size() == cells.curve_node.size());
  const Nodes nodes(cells, curve_displacement_px, solution);
  SplitCells& split = solution.split;
  split = {cells.cell_begin, cells.cell_column, {0}, {}, {}};
  split.triangle.reserve(cells.triangle.size());
  for (int j = 0; j < cells.ny; ++j)
    for (int c = cells.cell_begin[std::size_t(j)]; c < cells.cell_begin[std::size_t(j) + 1]; ++c) {
      for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1];
           ++p) {
        const int* code = &cells.part_node[std::size_t(cells.part_node_begin[std::size_t(p)])];
        for (int t = cells.part_triangle_begin[std::size_t(p)];
             t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
          kernels::MapTriangle triangle;
          for (std::size_t k = 0; k < 3; ++k) {
            const int n = code[cells.triangle[std::size_t(t)].node[k]];
            triangle.rest[k] = nodes.rest(c, j, n);
            triangle.displacement[k] = nodes.displacement(c, j, n);
          }
          split.triangle.push_back(triangle);
        }
      }
      split.triangle_begin.push_back(int(split.triangle.size()));
    }
  // All cells around a moved node are split, so that its own displacement is not needed any more.
  const kernels::LatticeMapView map = map_of(solution);
  for (int j = 0; j <= cells.ny; ++j)
    for (int k = cells.node_begin[std::size_t(j)]; k < cells.node_begin[std::size_t(j) + 1]; ++k) {
      const int i = cells.node_column[std::size_t(k)];
      if (cells.node[std::size_t(k)].rest == grid::Point{double(i), double(j)}) continue;
      const grid::Point rest = solution.lattice.rest_px(i, j);
      const kernels::Position to = kernels::forward_position(map, {rest.x, rest.y});
      const std::size_t n = std::size_t(j) * std::size_t(cells.nx + 1) + std::size_t(i);
      solution.u_px[n] = to.x - rest.x;
      solution.v_px[n] = to.y - rest.y;
    }
}

kernels::LatticeMapView map_of(const Solution& solution) {
  const grid::Lattice& lattice = solution.lattice;
  return {.u = solution.u_px.data(),
          .v = solution.v_px.data(),
          .nx = lattice.nx,
          .ny = lattice.ny,
          .cell_px = lattice.cell_px,
          .origin_px = {lattice.origin_px.x, lattice.origin_px.y},
          .split = solution.split.view()};
}

}  // namespace drumhead::multigrid
