// SPDX-License-Identifier: MIT
#include <drumhead/kernels/resample.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "resample_boxes.h"
#include "resample_check.h"
#include "resample_filter.h"
#include "resample_footprint.h"
#include "resample_inverse.h"
#include "resample_pyramid.h"
#include "resample_threads.h"

namespace drumhead::kernels {
namespace {

// Inverts the rectangle tile by tile and hands each to use(tile, a, b), (a, b) its first pixel's
// place in the rectangle.
template <class Use>
void for_each_tile(const LatticeMapView& map, const BoxTree& tree, const ImageTarget& rectangle,
                   int threads, const Use& use) {
  constexpr int kSide = TileMap::kSide;
  if (rectangle.width <= 0 || rectangle.height <= 0) return;
  const int columns = (rectangle.width + kSide - 1) / kSide;
  const int rows = (rectangle.height + kSide - 1) / kSide;
  std::vector<TileMap> scratch(std::size_t(std::min(thread_count(threads), columns * rows)));
  for_each_task(columns * rows, int(scratch.size()), [&](int k, int thread) {
    const int a = k % columns * kSide, b = k / columns * kSide;
    TileMap& tile = scratch[std::size_t(thread)];
    tile.left = rectangle.left + a;
    tile.top = rectangle.top + b;
    tile.width = std::min(kSide, rectangle.width - a);
    tile.height = std::min(kSide, rectangle.height - b);
    invert_tile(map, tree, tile);
    use(tile, a, b);
  });
}

// What becomes of the unit vectors in a triangle: ∂(warped)/∂(rest).
std::array<Position, 2> unit_edges(const MapTriangle& triangle) {
  const auto between = [](Position a, Position b) { return Position{b.x - a.x, b.y - a.y}; };
  const Position p = between(triangle.rest[0], triangle.rest[1]);
  const Position q = between(triangle.rest[0], triangle.rest[2]);
  const Position e = between(warped_corner(triangle, 0), warped_corner(triangle, 1));
  const Position f = between(warped_corner(triangle, 0), warped_corner(triangle, 2));
  const double area = p.x * q.y - p.y * q.x;
  return {Position{(e.x * q.y - f.x * p.y) / area, (e.y * q.y - f.y * p.y) / area},
          Position{(f.x * p.x - e.x * q.x) / area, (f.y * p.x - e.y * q.x) / area}};
}

// The displacement's derivatives by rest at the corners of a cell bound the footprints in it.
bool needs_pyramid(const LatticeMapView& map, const FilterBounds& bounds) {
  const auto warped_edge = [&](int i, int j, int k, int l) {
    const Position a = warped_node(map, i, j), b = warped_node(map, k, l);
    return Position{(b.x - a.x) / map.cell_px, (b.y - a.y) / map.cell_px};
  };
  const auto too_small = [&](Position e, Position f) {  // edges warped from the unit square's
    const double J = e.x * f.y - e.y * f.x;
    if (!(J > 1e-8)) return true;
    const float inverse[4] = {float(f.y / J), float(-f.x / J), float(-e.y / J), float(e.x / J)};
    return footprint(inverse, bounds.anisotropy).least > kBlendFrom * bounds.detail;
  };
  for (int j = 0; j < map.ny; ++j) {
    for (int i = 0; i < map.nx; ++i) {
      if (const int c = map.split.find(i, j); c >= 0) {
        for (int n = map.split.triangle_begin[c]; n < map.split.triangle_begin[c + 1]; ++n) {
          const auto [e, f] = unit_edges(map.split.triangle[n]);
          if (too_small(e, f)) return true;
        }
        continue;
      }
      for (int corner = 0; corner < 4; ++corner) {
        const int s = corner % 2, t = corner / 2;
        const Position e = warped_edge(i, j + t, i + 1, j + t);
        const Position f = warped_edge(i + s, j, i + s, j + 1);
        if (too_small(e, f)) return true;
      }
    }
  }
  return false;
}

}  // namespace

struct Resampler::State {
  LatticeMapView map;
  FilterBounds bounds;
  int threads;
  BoxTree tree;
  Pyramid pyramid;
};

Resampler::Resampler(const ImageView& source, const LatticeMapView& map,
                     const ResampleOptions& options) {
  check(map);
  check(source);
  check(options);
  const FilterBounds bounds{float(options.detail), float(options.anisotropy)};
  state_ = std::make_unique<State>(
      State{map, bounds, options.threads, BoxTree(map), Pyramid(source, options.border)});
  if (needs_pyramid(map, bounds)) state_->pyramid.build(options.threads);
}

Resampler::~Resampler() = default;
Resampler::Resampler(Resampler&&) noexcept = default;
Resampler& Resampler::operator=(Resampler&&) noexcept = default;

void Resampler::render(const ImageTarget& out) const {
  check(out, state_->pyramid.level(0).channels);
  for_each_tile(state_->map, state_->tree, out, state_->threads,
                [&](const TileMap& tile, int a, int b) {
                  float* first = out.data + b * out.row_stride + std::ptrdiff_t(a) * out.channels;
                  filter_tile(state_->pyramid, state_->bounds, tile, first, out.row_stride);
                });
}

void backward_map(const LatticeMapView& map, const BackwardMapTarget& out, int threads) {
  check(map);
  check_rectangle(out.width, out.height, out.row_stride, 1);
  check_threads(threads);
  const BoxTree tree(map);
  const ImageTarget rectangle{nullptr, out.width, out.height, 0, 0, out.left, out.top};
  for_each_tile(map, tree, rectangle, threads, [&](const TileMap& tile, int a, int b) {
    for (int y = 0; y < tile.height; ++y) {
      const std::ptrdiff_t to = (b + y) * out.row_stride + a;
      const int from = y * TileMap::kSide;
      if (out.source) std::copy_n(tile.source + from, tile.width, out.source + to);
      if (out.side) std::copy_n(tile.side + from, tile.width, out.side + to);
      if (!out.jacobian) continue;
      for (int x = 0; x < tile.width; ++x) {
        std::copy_n(tile.jacobian[from + x], 4, out.jacobian[to + x]);
      }
    }
  });
}

namespace {

// The displacement at a rest position by the triangle near cell (i, j) that holds it, the one that
// misses it least if none does; how far inside it is, as the least barycentric coordinate.
struct InTriangle {
  double inside = -std::numeric_limits<double>::infinity();
  Position displacement;
};
// A point that is so deep in a triangle, as a share of its height, is in no other one.
constexpr double kClearly = 1e-6;

/// Takes a triangle of special cell c that `rest` is deeper in than in `best`.
void find_deepest(const SplitCellsView& split, int c, Position rest, InTriangle& best) {
  for (int n = split.triangle_begin[c]; n < split.triangle_begin[c + 1]; ++n) {
    const MapTriangle& triangle = split.triangle[n];
    const Position *r = triangle.rest, *d = triangle.displacement;
    const Position p{r[1].x - r[0].x, r[1].y - r[0].y}, q{r[2].x - r[0].x, r[2].y - r[0].y};
    const Position h{rest.x - r[0].x, rest.y - r[0].y};
    const double area = p.x * q.y - p.y * q.x;
    const double s = (h.x * q.y - h.y * q.x) / area, t = (p.x * h.y - p.y * h.x) / area;
    const double inside = std::min(std::min(s, t), 1.0 - s - t);
    if (!(inside > best.inside)) continue;
    best.inside = inside;
    best.displacement = {d[0].x + s * (d[1].x - d[0].x) + t * (d[2].x - d[0].x),
                         d[0].y + s * (d[1].y - d[0].y) + t * (d[2].y - d[0].y)};
    if (inside > kClearly) return;
  }
}

/// Of special cell `own` at (i, j), −1 where that is bilinear, and the special cells around it.
InTriangle nearest_triangle(const LatticeMapView& map, int own, int i, int j, Position rest) {
  InTriangle best;
  const SplitCellsView& split = map.split;
  if (own >= 0) find_deepest(split, own, rest, best);
  if (best.inside > kClearly) return best;
  best = {};
  for (int row = std::max(0, j - 1); row <= std::min(map.ny - 1, j + 1); ++row) {
    const int *begin = split.column + split.row_begin[row],
              *end = split.column + split.row_begin[row + 1];
    for (const int* at = std::lower_bound(begin, end, i - 1); at != end && *at <= i + 1; ++at)
      find_deepest(split, int(at - split.column), rest, best);
  }
  return best;
}

Position position_in(const LatticeMapView& map, Position rest_px) {
  const double s = (rest_px.x - map.origin_px.x) / map.cell_px;
  const double t = (rest_px.y - map.origin_px.y) / map.cell_px;
  if (!(s >= 0.0 && s <= map.nx && t >= 0.0 && t <= map.ny)) return rest_px;
  const int i = std::min(int(s), map.nx - 1), j = std::min(int(t), map.ny - 1);
  if (map.split.row_begin) {
    const int own = map.split.find(i, j);
    const InTriangle best = nearest_triangle(map, own, i, j, rest_px);
    // Where cell (i, j) is bilinear the point may still lie in a triangle of the next one.
    if (best.inside >= -1e-9 || own >= 0)
      return {rest_px.x + best.displacement.x, rest_px.y + best.displacement.y};
  }
  const double fs = s - i, ft = t - j;
  const std::size_t n0 = std::size_t(j) * std::size_t(map.nx + 1) + std::size_t(i);
  const std::size_t n1 = n0 + std::size_t(map.nx + 1);
  const auto blend = [&](const double* d) {
    const double near = d[n0] + fs * (d[n0 + 1] - d[n0]);
    const double far = d[n1] + fs * (d[n1 + 1] - d[n1]);
    return near + ft * (far - near);
  };
  return {rest_px.x + blend(map.u), rest_px.y + blend(map.v)};
}

}  // namespace

Position forward_position(const LatticeMapView& map, Position rest_px) {
  check(map);
  return position_in(map, rest_px);
}

void forward_map(const LatticeMapView& map, const ForwardMapTarget& out, int threads) {
  check(map);
  check(out);
  check_threads(threads);
  for_each_task(out.height, threads, [&](int b, int) {
    Position* row = out.output + b * out.row_stride;
    for (int a = 0; a < out.width; ++a) {
      row[a] = position_in(map, {out.left + a + 0.5, out.top + b + 0.5});
    }
  });
}

}  // namespace drumhead::kernels
