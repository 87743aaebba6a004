// SPDX-License-Identifier: MIT
#pragma once
// What made the warped picture, drawn over it: the deformed lattice, the warped source curves and
// their targets.
#include <drumhead/multigrid/warp.h>
#include <vector>

#include "canvas.h"
#include "svg_curves.h"

namespace drumhead::driver {

/// Lattice lines are thinned to at least 12 units and 1/48 of the longer side apart; the lattice's
/// edge is always there. Targets lie as wide cyan lines under the thin red of the warped sources,
/// pins are white: where the warp meets its target, red runs in the middle of cyan.
void draw_overlay(const multigrid::Solution& solution, const std::vector<SvgCurve>& curves,
                  Canvas& canvas);

/// Appends a chain's points, each carried by `place`, to the canvas's path, dense enough to follow
/// every cell.
template <class Place>
void add_chain(const std::vector<grid::CubicBezier>& chain, double cell_px, Canvas& canvas,
               const Place& place) {
  bool first = true;
  for (const grid::CubicBezier& piece : chain) {
    const double step = std::min(cell_px / 2, 3 / canvas.scale());
    const int points = std::clamp(int(std::ceil(grid::arc_length(piece) / step)), 1, 100000);
    for (int k = first ? 0 : 1; k <= points; ++k) {
      canvas.line_to(place(piece.at(double(k) / points)), first);
      first = false;
    }
  }
}

}  // namespace drumhead::driver
