// SPDX-License-Identifier: MIT
#include "jacobian.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumhead::driver {
namespace {

double cross(kernels::Position a, kernels::Position b) { return a.x * b.y - a.y * b.x; }

}  // namespace

/// The warped edges of a cell in units of its side; y runs downwards, so "north" is the top, row j.
JacobianField::Edges JacobianField::edges(int i, int j) const {
  const grid::Lattice& lattice = solution_.lattice;
  const std::size_t row = std::size_t(lattice.nx) + 1;
  const std::size_t k = std::size_t(j) * row + std::size_t(i);
  const auto edge = [&](std::size_t from, std::size_t to, double x, double y) {
    return kernels::Position{x + (solution_.u_px[to] - solution_.u_px[from]) / lattice.cell_px,
                             y + (solution_.v_px[to] - solution_.v_px[from]) / lattice.cell_px};
  };
  return {.south = edge(k + row, k + row + 1, 1, 0),
          .north = edge(k, k + 1, 1, 0),
          .west = edge(k, k + row, 0, 1),
          .east = edge(k + 1, k + row + 1, 0, 1)};
}

double JacobianField::at(kernels::Position rest_px) const {
  const grid::Lattice& lattice = solution_.lattice;
  const grid::Point cell = lattice.to_cells({rest_px.x, rest_px.y});
  if (!(cell.x >= 0 && cell.x <= lattice.nx && cell.y >= 0 && cell.y <= lattice.ny)) return 1.0;
  const Edges e =
      edges(std::min(int(cell.x), lattice.nx - 1), std::min(int(cell.y), lattice.ny - 1));
  const kernels::Position across{(e.north.x + e.south.x) / 2, (e.north.y + e.south.y) / 2};
  const kernels::Position down{(e.west.x + e.east.x) / 2, (e.west.y + e.east.y) / 2};
  return cross(across, down);
}

bool JacobianField::folded(int i, int j) const {
  const Edges e = edges(i, j);
  return std::ranges::any_of(std::array{cross(e.north, e.west), cross(e.north, e.east),
                                        cross(e.south, e.west), cross(e.south, e.east)},
                             [](double J) { return J < 0.0; });
}

}  // namespace drumhead::driver
