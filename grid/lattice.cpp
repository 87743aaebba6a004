// SPDX-License-Identifier: MIT
#include <drumhead/grid/lattice.h>

#include <drumhead/kernels/refuse.h>
#include <algorithm>
#include <cmath>

namespace drumhead::grid {
namespace {

constexpr int kMostCells = 16384;
// A side within this many cells of a whole number of cells is taken as whole.
constexpr double kWhole = 1e-6;

using kernels::refuse;

/// The power of two whose multiples coarsen well and cost at most a sixteenth more cells.
int coarsening_step(int nx, int ny) {
  int step = 1;
  while (step < 64 && 32 * step <= std::min(nx, ny)) step *= 2;
  return step;
}

int round_up(int n, int step) { return (n + step - 1) / step * step; }

}  // namespace

Lattice make_lattice(double width_px, double height_px, const LatticeOptions& options) {
  if (!(width_px > 0.0) || !std::isfinite(width_px))
    refuse("width", width_px, "positive and finite");
  if (!(height_px > 0.0) || !std::isfinite(height_px))
    refuse("height", height_px, "positive and finite");
  if (!(options.margin >= 0.0) || !std::isfinite(options.margin))
    refuse("margin", options.margin, "at least 0 and finite");
  if (!(options.cell_px >= 0.0) || !std::isfinite(options.cell_px))
    refuse("cell size", options.cell_px, "at least 0 and finite");
  if (options.cell_px == 0.0 && (options.cells < 1 || options.cells > kMostCells))
    refuse("cells", options.cells, "1…16384");

  Lattice lattice;
  lattice.side_px = std::max(width_px, height_px);
  lattice.cell_px = options.cell_px > 0.0 ? options.cell_px : lattice.side_px / options.cells;
  const double across = lattice.side_px / lattice.cell_px * (1.0 + 2.0 * options.margin);
  if (across > 2.0 * kMostCells) refuse("cells with the margin", across, "at most 32768");

  auto cells = [&](double px) {
    return std::max(1, int(std::ceil(px / lattice.cell_px - kWhole)));
  };
  const int inner_x = cells(width_px), inner_y = cells(height_px);
  const int margin = int(std::ceil(options.margin * lattice.side_px / lattice.cell_px - kWhole));
  lattice.nx = inner_x + 2 * margin;
  lattice.ny = inner_y + 2 * margin;
  int before_x = margin, before_y = margin;
  if (margin > 0) {
    const int step = coarsening_step(lattice.nx, lattice.ny);
    const int nx = round_up(lattice.nx, step), ny = round_up(lattice.ny, step);
    before_x += (nx - lattice.nx) / 2;
    before_y += (ny - lattice.ny) / 2;
    lattice.nx = nx;
    lattice.ny = ny;
  }
  lattice.origin_px = {-before_x * lattice.cell_px, -before_y * lattice.cell_px};
  return lattice;
}

}  // namespace drumhead::grid
