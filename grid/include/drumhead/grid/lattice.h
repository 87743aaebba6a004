// SPDX-License-Identifier: MIT
#pragma once
// The regular lattice over the picture and its margin (Setaluri et al. 2014, sections 3 and 3.2):
// nx × ny square cells of side cell_px; node (i, j) rests at origin_px + cell_px·(i, j). Nodes on
// the outer boundary never move.
#include <cstddef>

#include <drumhead/grid/curve.h>

namespace drumhead::grid {

struct LatticeOptions {
  int cells = 256;  ///< cells across the longer picture side, 1…16384; ignored if cell_px > 0
  double cell_px = 0.0;  ///< side of a cell in picture pixels; 0: from `cells`
  double margin = 0.1;   ///< margin on every side as a fraction of the longer picture side, ≥ 0
};

struct Lattice {
  int nx = 1, ny = 1;    ///< cells
  double cell_px = 1.0;  ///< h in picture pixels
  Point origin_px;       ///< rest position of node (0, 0)
  double side_px = 1.0;  ///< the longer picture side, the unit length of a curve's weight d
  friend bool operator==(const Lattice&, const Lattice&) = default;

  std::size_t nodes() const { return std::size_t(nx + 1) * std::size_t(ny + 1); }
  std::size_t cells() const { return std::size_t(nx) * std::size_t(ny); }
  /// Rest position of a node in picture pixels.
  Point rest_px(int i, int j) const {
    return {origin_px.x + cell_px * i, origin_px.y + cell_px * j};
  }
  /// Picture pixels → cell units with node (0, 0) at the origin.
  Point to_cells(Point px) const {
    return {(px.x - origin_px.x) / cell_px, (px.y - origin_px.y) / cell_px};
  }
};

/// Lattice over a picture of width × height pixels. A positive margin grows until the lattice
/// coarsens well; with margin 0 the lattice is the picture where its sides are whole numbers of
/// cells, and otherwise reaches less than one cell past the right and bottom edges. Throws
/// std::invalid_argument naming value and bound.
Lattice make_lattice(double width_px, double height_px, const LatticeOptions& options);

/// Cells of the next coarser lattice: half, an odd count rounded up (the last cell overhangs the
/// fixed edge).
inline int coarse_cells(int n) { return (n + 1) / 2; }

}  // namespace drumhead::grid
