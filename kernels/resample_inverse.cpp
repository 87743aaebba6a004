// SPDX-License-Identifier: MIT
#include "resample_inverse.h"

#include <algorithm>
#include <cmath>

namespace drumhead::kernels {
namespace {

// A point whose (s, t) leaves the unit square by at most kInside counts as inside, so that rounding
// cannot open a gap on an edge that two cells share. Where J is near 0 rounding is worse: a point
// that no cell holds goes to the cell that misses it least, by at most kNear.
constexpr double kInside = 1e-9, kNear = 1e-3;
constexpr float kNowhere = 1.0f;  // more than any miss that is accepted

double cross(Position a, Position b) { return a.x * b.y - a.y * b.x; }

// The bilinear map of a cell: displacement d(s, t) = d00 + s de + t df + st g, position rest + d.
struct Cell {
  Position x00, e, f, g;  // warped corner, edges and twist
  Position d00, de, df;   // displacements
  double cell_px = 1.0;
  double ef = 0.0, At = 0.0, As = 0.0;
  bool upright = false;  // J > 0 at the four corners, hence everywhere
  std::int32_t index = 0;
  Box box;
};

Cell make_cell(const LatticeMapView& map, int i, int j) {
  Cell cell;
  const std::size_t n00 = std::size_t(j) * std::size_t(map.nx + 1) + std::size_t(i);
  const std::size_t n01 = n00 + std::size_t(map.nx + 1);
  const double *u = map.u, *v = map.v;
  cell.cell_px = map.cell_px;
  cell.index = std::int32_t(j) * map.nx + i;
  cell.d00 = {u[n00], v[n00]};
  cell.de = {u[n00 + 1] - u[n00], v[n00 + 1] - v[n00]};
  cell.df = {u[n01] - u[n00], v[n01] - v[n00]};
  cell.g = {(u[n01 + 1] - u[n01]) - cell.de.x, (v[n01 + 1] - v[n01]) - cell.de.y};
  cell.x00 = warped_node(map, i, j);
  cell.e = {map.cell_px + cell.de.x, cell.de.y};
  cell.f = {cell.df.x, map.cell_px + cell.df.y};
  cell.ef = cross(cell.e, cell.f);
  cell.At = cross(cell.f, cell.g);
  cell.As = cross(cell.g, cell.e);
  // J = (e + t g)×(f + s g) = e×f − s A_s − t A_t: linear, so its corners bound it.
  const double J10 = cell.ef - cell.As, J01 = cell.ef - cell.At;
  cell.upright = cell.ef > 0.0 && J10 > 0.0 && J01 > 0.0 && J10 - cell.At > 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    cell.box.add(warped_node(map, i + corner % 2, j + corner / 2));
  }
  return cell;
}

bool is_finite(const Cell& cell) {
  // Any corner that is not finite makes one of these NaN or infinite.
  return std::isfinite(cell.x00.x + cell.x00.y + cell.e.x + cell.e.y + cell.f.x + cell.f.y +
                       cell.g.x + cell.g.y);
}

// The root of A z² − q z + C = 0 at which q − 2 A z = root (= ±√D).
inline double stable_root(double A, double q, double C, double root, double sign) {
  const bool same = q * sign >= 0.0;
  return (same ? 2.0 * C : q - root) / (same ? q + root : 2.0 * A);
}

// (s, t) under n pixels of a row from (a, b) on, at the points where J has the given sign, and how
// far it misses the unit square; NaN where there is no such point.
void invert_row(const Cell& cell, double sign, int a, int b, int n, double* s, double* t,
                double* miss) {
  const double hy = (b + 0.5) - cell.x00.y, hx0 = (a + 0.5) - cell.x00.x;
  for (int k = 0; k < n; ++k) {
    const Position h{hx0 + k, hy};
    const double gh = cross(cell.g, h), Ct = cross(cell.e, h), Cs = cross(h, cell.f);
    const double qt = cell.ef - gh, qs = cell.ef + gh;
    const double four_AC = 4.0 * cell.At * Ct, D = qt * qt - four_AC;
    // On a fold line D is 0 up to rounding; a clearly negative D has no preimage.
    const double slack = 1e-14 * (qt * qt + std::abs(four_AC));
    const double root = sign * std::sqrt(std::max(D, 0.0));
    s[k] = stable_root(cell.As, qs, Cs, root, sign);
    t[k] = stable_root(cell.At, qt, Ct, root, sign);
    const double over = std::max(std::max(-s[k], s[k] - 1.0), std::max(-t[k], t[k] - 1.0));
    const bool exists = D >= -slack && s[k] == s[k] && t[k] == t[k];
    miss[k] = exists ? over : kNowhere;
  }
}

bool better(float miss, signed char side, std::int32_t index, const TileMap& tile, int pixel) {
  if (miss != tile.miss[pixel]) return miss < tile.miss[pixel];
  if (side != tile.side[pixel]) return side > tile.side[pixel];
  return index > tile.cell[pixel];
}

// Source = x − d(s, t), which is exact where the displacement is 0; Jacobian = (∂x/∂rest)⁻¹.
void accept(const Cell& cell, double s, double t, Position x, TileMap& tile, int pixel) {
  s = std::clamp(s, 0.0, 1.0);
  t = std::clamp(t, 0.0, 1.0);
  tile.source[pixel] = {x.x - (cell.d00.x + s * cell.de.x + t * cell.df.x + s * t * cell.g.x),
                        x.y - (cell.d00.y + s * cell.de.y + t * cell.df.y + s * t * cell.g.y)};
  const Position e{cell.e.x + t * cell.g.x, cell.e.y + t * cell.g.y};
  const Position f{cell.f.x + s * cell.g.x, cell.f.y + s * cell.g.y};
  // At J = 0 the Jacobian is infinite; 1e-8 is far beyond any filter and keeps its square finite.
  const double floor = 1e-8 * cell.cell_px * cell.cell_px;
  double det = cross(e, f);
  if (std::abs(det) < floor) det = std::copysign(floor, det);
  const double scale = cell.cell_px;
  float* jacobian = tile.jacobian[pixel];
  jacobian[0] = float(scale * f.y / det);
  jacobian[1] = float(-scale * f.x / det);
  jacobian[2] = float(-scale * e.y / det);
  jacobian[3] = float(scale * e.x / det);
}

// Pixels of the tile whose centres a box may hold: a has its centre in [x0, x1] for a in
// [⌈x0 − ½⌉, ⌊x1 − ½⌋], with room for near misses.
struct Window {
  int a0, a1, b0, b1;
};
Window window_of(const Box& box, double cell_px, const TileMap& tile) {
  const double room = 0.5 + kNear * cell_px;
  const auto first = [&](double x, int from, int n) {
    return int(std::clamp(std::ceil(x - room) - from, 0.0, double(n)));
  };
  const auto end = [&](double x, int from, int n) {
    return int(std::clamp(std::floor(x - 1.0 + room) - from + 1.0, 0.0, double(n)));
  };
  return {first(box.x0, tile.left, tile.width), end(box.x1, tile.left, tile.width),
          first(box.y0, tile.top, tile.height), end(box.y1, tile.top, tile.height)};
}

// Whether a point under a pixel is the best so far; if it is, its rank is noted.
bool take(double miss, signed char side, std::int32_t index, Position x, const Box& lattice,
          TileMap& tile, int pixel) {
  if (!(miss <= kNear)) return false;
  const float rank = miss <= kInside ? 0.0f : float(miss);
  if (!better(rank, side, index, tile, pixel)) return false;
  if (rank > 0.0f && !lattice.holds(x)) return false;
  tile.miss[pixel] = rank;
  tile.side[pixel] = side;
  tile.cell[pixel] = index;
  return true;
}

void rasterise(const Cell& cell, double sign, const Box& lattice, TileMap& tile) {
  const Window w = window_of(cell.box, cell.cell_px, tile);
  double s[TileMap::kSide], t[TileMap::kSide], miss[TileMap::kSide];
  for (int b = w.b0; b < w.b1; ++b) {
    invert_row(cell, sign, tile.left + w.a0, tile.top + b, w.a1 - w.a0, s, t, miss);
    for (int a = w.a0; a < w.a1; ++a) {
      const int k = a - w.a0, pixel = b * TileMap::kSide + a;
      const Position x{tile.left + a + 0.5, tile.top + b + 0.5};
      const signed char side = sign > 0.0 ? 1 : -1;
      if (take(miss[k], side, cell.index, x, lattice, tile, pixel))
        accept(cell, s[k], t[k], x, tile, pixel);
    }
  }
}

Position difference(Position a, Position b) { return {a.x - b.x, a.y - b.y}; }

// A triangle of a cell: x = x0 + s e + t f, displacement d0 + s de + t df, s, t ≥ 0, s + t ≤ 1.
void rasterise(const MapTriangle& triangle, const LatticeMapView& map, std::int32_t index,
               const Box& lattice, TileMap& tile) {
  const Position x0 = warped_corner(triangle, 0), d0 = triangle.displacement[0];
  const Position e = difference(warped_corner(triangle, 1), x0);
  const Position f = difference(warped_corner(triangle, 2), x0);
  const Position de = difference(triangle.displacement[1], d0);
  const Position df = difference(triangle.displacement[2], d0);
  const Position re = difference(triangle.rest[1], triangle.rest[0]);
  const Position rf = difference(triangle.rest[2], triangle.rest[0]);
  const double area = cross(e, f), floor = 1e-8 * cross(re, rf);
  if (!std::isfinite(area + x0.x + x0.y) || area == 0.0) return;
  const double det = std::abs(area) < floor ? std::copysign(floor, area) : area;
  const float jacobian[4] = {
      float((re.x * f.y - rf.x * e.y) / det), float((rf.x * e.x - re.x * f.x) / det),
      float((re.y * f.y - rf.y * e.y) / det), float((rf.y * e.x - re.y * f.x) / det)};
  Box box;
  for (int k = 0; k < 3; ++k) box.add(warped_corner(triangle, k));
  const Window w = window_of(box, map.cell_px, tile);
  for (int b = w.b0; b < w.b1; ++b) {
    for (int a = w.a0; a < w.a1; ++a) {
      const Position x{tile.left + a + 0.5, tile.top + b + 0.5}, h = difference(x, x0);
      double s = cross(h, f) / area, t = cross(e, h) / area;
      const int pixel = b * TileMap::kSide + a;
      const double miss = std::max(std::max(-s, -t), s + t - 1.0);
      if (!take(miss, area > 0.0 ? 1 : -1, index, x, lattice, tile, pixel)) continue;
      s = std::clamp(s, 0.0, 1.0);
      t = std::clamp(t, 0.0, 1.0 - s);
      tile.source[pixel] = {x.x - (d0.x + s * de.x + t * df.x), x.y - (d0.y + s * de.y + t * df.y)};
      std::copy_n(jacobian, 4, tile.jacobian[pixel]);
    }
  }
}

}  // namespace

void invert_tile(const LatticeMapView& map, const BoxTree& tree, TileMap& tile) {
  for (int b = 0; b < tile.height; ++b) {
    for (int a = 0; a < tile.width; ++a) {
      const int pixel = b * TileMap::kSide + a;
      tile.source[pixel] = {tile.left + a + 0.5, tile.top + b + 0.5};
      const float identity[4] = {1.0f, 0.0f, 0.0f, 1.0f};
      std::copy_n(identity, 4, tile.jacobian[pixel]);
      tile.miss[pixel] = kNowhere;
      tile.side[pixel] = 0;
      tile.cell[pixel] = -1;
    }
  }
  const double room = kNear * map.cell_px;
  const Box pixels{tile.left + 0.5 - room, tile.top + 0.5 - room,
                   tile.left + tile.width - 0.5 + room, tile.top + tile.height - 0.5 + room};
  const Position o = map.origin_px;
  const Box lattice{o.x, o.y, o.x + map.cell_px * map.nx, o.y + map.cell_px * map.ny};
  tree.visit(pixels, [&](int i0, int j0) {
    for (int j = j0; j < std::min(j0 + BoxTree::kBlock, map.ny); ++j) {
      for (int i = i0; i < std::min(i0 + BoxTree::kBlock, map.nx); ++i) {
        if (const int c = map.split.find(i, j); c >= 0) {
          for (int n = map.split.triangle_begin[c]; n < map.split.triangle_begin[c + 1]; ++n)
            rasterise(map.split.triangle[n], map, std::int32_t(j) * map.nx + i, lattice, tile);
          continue;
        }
        const Cell cell = make_cell(map, i, j);
        if (!is_finite(cell) || !cell.box.meets(pixels)) continue;
        rasterise(cell, 1.0, lattice, tile);
        if (!cell.upright) rasterise(cell, -1.0, lattice, tile);
      }
    }
  });
}

}  // namespace drumhead::kernels
