// SPDX-License-Identifier: MIT
#include "overlay.h"

#include <algorithm>
#include <cmath>

#include "render.h"

namespace drumhead::driver {
namespace {

constexpr double kLineGap = 12;          // units
constexpr double kLineShare = 1.0 / 48;  // of the longer side

constexpr Colour kLattice{1, 1, 1, 0.6}, kShade{0, 0, 0, 0.35};
constexpr Colour kTarget{0, 0.85, 1, 1}, kSource{0.95, 0.1, 0.1, 1}, kPin{1, 1, 1, 1};

void draw_lattice(const multigrid::Solution& solution, Canvas& canvas) {
  const grid::Lattice& lattice = solution.lattice;
  const kernels::LatticeMapView map = map_of(solution);
  // Straight from node to node, but for lines that curves may bend between nodes.
  const int pieces = solution.split.column.empty() ? 1 : 4;
  const auto point = [&](double x, double y) {
    const grid::Point rest = lattice.origin_px + lattice.cell_px * grid::Point{x, y};
    const kernels::Position p = kernels::forward_position(map, {rest.x, rest.y});
    return grid::Point{p.x, p.y};
  };
  const double side = std::max(canvas.columns(), canvas.rows());
  const double gap = std::max(kLineGap * canvas.unit(), kLineShare * side) / canvas.scale();
  const int stride = std::max(1, int(std::ceil(gap / lattice.cell_px - 1e-9)));
  const auto drawn = [&](int k, int last) { return k % stride == 0 || k == last; };
  for (int j = 0; j <= lattice.ny; ++j) {
    if (!drawn(j, lattice.ny)) continue;
    for (int k = 0; k <= lattice.nx * pieces; ++k)
      canvas.line_to(point(double(k) / pieces, j), k == 0);
  }
  for (int i = 0; i <= lattice.nx; ++i) {
    if (!drawn(i, lattice.nx)) continue;
    for (int k = 0; k <= lattice.ny * pieces; ++k)
      canvas.line_to(point(i, double(k) / pieces), k == 0);
  }
  canvas.stroke(kShade, 2.4, true);
  canvas.stroke(kLattice, 1.0);
}

}  // namespace

void draw_overlay(const multigrid::Solution& solution, const std::vector<SvgCurve>& curves,
                  Canvas& canvas) {
  const double cell_px = solution.lattice.cell_px;
  const kernels::LatticeMapView map = map_of(solution);
  draw_lattice(solution, canvas);
  for (const SvgCurve& curve : curves) {
    add_chain(curve.pair.target, cell_px, canvas, [](grid::Point p) { return p; });
    canvas.stroke(kShade, 8.5, true);
    canvas.stroke(curve.pin ? kPin : kTarget, curve.pin ? 4.0 : 6.5);
  }
  for (const SvgCurve& curve : curves) {
    if (curve.pin) continue;
    add_chain(curve.pair.source, cell_px, canvas, [&](grid::Point rest) {
      const kernels::Position p = kernels::forward_position(map, {rest.x, rest.y});
      return grid::Point{p.x, p.y};
    });
    canvas.stroke(kSource, 2.0);
  }
}

}  // namespace drumhead::driver
