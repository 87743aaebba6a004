// SPDX-License-Identifier: MIT
#include "field_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "overlay.h"

namespace drumhead::driver {
namespace {

constexpr int kSquares = 24;          // across the longer side
constexpr int kBandPixels = 4 << 20;  // of the backward map that is held at a time
constexpr double kGreatest = 2.0;     // of |log₂ det J| on the scale

Colour blend(Colour a, Colour b, double t) {
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green),
          a.blue + t * (b.blue - a.blue)};
}

/// Under a canvas pixel: the rest position and its change from pixel to pixel, in picture pixels.
struct Point {
  kernels::Position rest;
  kernels::Position by_x, by_y;
  bool upright = true;
};

/// The deformed lattice in the pixels of a canvas.
multigrid::Solution scaled(const multigrid::Solution& solution, const Frame& frame, double scale) {
  multigrid::Solution result{.lattice = solution.lattice,
                             .u_px = solution.u_px,
                             .v_px = solution.v_px,
                             .split = solution.split};
  result.lattice.cell_px *= scale;
  grid::Point& origin = result.lattice.origin_px;
  origin = {(origin.x - frame.left) * scale, (origin.y - frame.top) * scale};
  for (double& u : result.u_px) u *= scale;
  for (double& v : result.v_px) v *= scale;
  for (kernels::MapTriangle& triangle : result.split.triangle) {
    for (kernels::Position& p : triangle.rest) {
      p = {(p.x - frame.left) * scale, (p.y - frame.top) * scale};
    }
    for (kernels::Position& d : triangle.displacement) d = {d.x * scale, d.y * scale};
  }
  return result;
}

/// Gives every pixel of the frame colour(point): the backward map of the warp at the canvas's
/// scale.
template <class Paint>
void paint(const multigrid::Solution& solution, int threads, Canvas& canvas,
           const ShareDone& progress, const Paint& colour) {
  const double scale = canvas.scale();
  const Frame& frame = canvas.frame();
  const multigrid::Solution on_canvas = scaled(solution, frame, scale);
  const kernels::LatticeMapView map = map_of(on_canvas);
  const int columns = canvas.columns(), step = std::max(1, kBandPixels / columns);
  std::vector<kernels::Position> source(std::size_t(columns) * std::size_t(step));
  const auto jacobian = std::make_unique<float[][4]>(source.size());
  std::vector<signed char> side(source.size());
  std::vector<Colour> row(std::size_t(columns), Colour{});
  for (int top = 0; top < canvas.rows(); top += step) {
    const int height = std::min(step, canvas.rows() - top);
    kernels::backward_map(map,
                          {.source = source.data(),
                           .jacobian = jacobian.get(),
                           .side = side.data(),
                           .width = columns,
                           .height = height,
                           .row_stride = columns,
                           .left = 0,
                           .top = top},
                          threads);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < columns; ++x) {
        const std::size_t k = std::size_t(y) * std::size_t(columns) + std::size_t(x);
        const float(&M)[4] = jacobian[k];
        row[std::size_t(x)] =
            colour(Point{{source[k].x / scale + frame.left, source[k].y / scale + frame.top},
                         {M[0] / scale, M[2] / scale},
                         {M[1] / scale, M[3] / scale},
                         side[k] >= 0});
      }
      canvas.set_row(top + y, row);
    }
    if (progress) progress(double(top + height) / canvas.rows());
  }
}

class Checkerboard {
 public:
  Checkerboard(int width, int height)
      : width_(width), height_(height), square_(double(std::max(width, height)) / kSquares) {}

  /// The mean over the pixel's parallelogram, by 4 × 4 points where it meets an edge of a square.
  Colour mean(const Point& point) const {
    constexpr int kPoints = 4;
    const double reach_x = (std::abs(point.by_x.x) + std::abs(point.by_y.x)) / 2;
    const double reach_y = (std::abs(point.by_x.y) + std::abs(point.by_y.y)) / 2;
    if (far_from_edge(point.rest.x, width_, reach_x) &&
        far_from_edge(point.rest.y, height_, reach_y)) {
      return at(point.rest);
    }
    Colour sum{0, 0, 0};
    for (int k = 0; k < kPoints * kPoints; ++k) {
      const double s = (k % kPoints + 0.5) / kPoints - 0.5, t = (k / kPoints + 0.5) / kPoints - 0.5;
      const Colour here = at({point.rest.x + s * point.by_x.x + t * point.by_y.x,
                              point.rest.y + s * point.by_x.y + t * point.by_y.y});
      const double share = 1.0 / (kPoints * kPoints);
      sum = {sum.red + share * here.red, sum.green + share * here.green,
             sum.blue + share * here.blue};
    }
    return sum;
  }

 private:
  bool far_from_edge(double x, int side, double reach) const {
    return std::abs(x - square_ * std::round(x / square_)) > reach && std::abs(x - side) > reach;
  }

  Colour at(kernels::Position p) const {
    const bool light = std::fmod(std::floor(p.x / square_) + std::floor(p.y / square_), 2.0) == 0.0;
    if (p.x < 0 || p.x > width_ || p.y < 0 || p.y > height_) {
      return light ? Colour{0.8, 0.8, 0.8} : Colour{0.6, 0.6, 0.6};
    }
    if (light) return {0.96, 0.96, 0.96};
    return {0.15 + 0.65 * p.x / width_, 0.35, 0.15 + 0.65 * p.y / height_};
  }

  const int width_, height_;
  const double square_;
};

constexpr Colour kFolded{0.05, 0.05, 0.05}, kRing{1, 0.85, 0}, kRim{0, 0, 0, 0.8};

Colour colour_of(double det) {
  if (!(det > 0.0)) return kFolded;
  constexpr std::array kScale{Colour{0.03, 0.16, 0.5}, Colour{0.36, 0.62, 0.9},
                              Colour{0.97, 0.97, 0.97}, Colour{0.96, 0.6, 0.38},
                              Colour{0.58, 0.04, 0.1}};
  const double x = (std::clamp(std::log2(det) / kGreatest, -1.0, 1.0) + 1) * 2;
  const auto k = std::size_t(std::min(int(x), 3));
  return blend(kScale[k], kScale[k + 1], x - double(k));
}

/// det J of the cell that holds a rest position; 1 outside the lattice, where nothing moves.
double det_J(const multigrid::Solution& solution, kernels::Position rest_px) {
  const grid::Lattice& lattice = solution.lattice;
  const grid::Point cell = lattice.to_cells({rest_px.x, rest_px.y});
  if (!(cell.x >= 0 && cell.x <= lattice.nx && cell.y >= 0 && cell.y <= lattice.ny)) return 1.0;
  return multigrid::cell_J(solution, std::min(int(cell.x), lattice.nx - 1),
                           std::min(int(cell.y), lattice.ny - 1))
      .centre;
}

/// As the report counts them: J < 0 at any corner, and of those at the centre.
struct Folds {
  int cells = 0, turned_over = 0;
};

/// A ring at each place with folded cells; places closer than a ring's width share one.
Folds mark_folds(const multigrid::Solution& solution, Canvas& canvas) {
  constexpr double kRadius = 9.0;  // units
  const double radius = kRadius * canvas.unit() / canvas.scale();
  const kernels::LatticeMapView map = map_of(solution);
  const grid::Lattice& lattice = solution.lattice;
  std::vector<grid::Point> rings;
  Folds folds;
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const auto J = multigrid::cell_J(solution, i, j);
      if (!(J.least_corner < 0.0)) continue;
      ++folds.cells;
      folds.turned_over += J.centre < 0.0;
      const grid::Point rest = lattice.rest_px(i, j);
      const kernels::Position p = kernels::forward_position(
          map, {rest.x + lattice.cell_px / 2, rest.y + lattice.cell_px / 2});
      const grid::Point centre{p.x, p.y};
      const auto near = [&](grid::Point ring) { return grid::length(ring - centre) < 2 * radius; };
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::ranges::none_of(rings, near)) {
        rings.push_back(centre);
      }
    }
  }
  for (const grid::Point ring : rings) {
    constexpr int kChords = 48;
    for (int k = 0; k <= kChords; ++k) {
      const double angle = 2 * M_PI * k / kChords;
      canvas.line_to({ring.x + radius * std::cos(angle), ring.y + radius * std::sin(angle)},
                     k == 0);
    }
    canvas.stroke(kRim, 4.0, true);
    canvas.stroke(kRing, 2.2);
  }
  return folds;
}

void write_legend(double least, double greatest, const Folds& folds, Canvas& canvas) {
  constexpr double kLeft = 24, kTop = 8, kHeight = 18, kStep = 130, kSteps = 256;
  constexpr std::array kTicks{"1/4", "1/2", "1", "2", "4"};
  constexpr double kWidth = kStep * (kTicks.size() - 1);
  for (int k = 0; k < kSteps; ++k) {
    const double det = std::exp2(kGreatest * (2 * (k + 0.5) / kSteps - 1));
    canvas.fill_rectangle(kLeft + k * kWidth / kSteps, kTop, kWidth / kSteps + 0.5, kHeight,
                          colour_of(det));
  }
  for (std::size_t k = 0; k < kTicks.size(); ++k) {
    const double x = kLeft + kStep * double(k);
    canvas.fill_rectangle(x - 1, kTop + kHeight, 2, 4, {0.1, 0.1, 0.1});
    canvas.write_text(x, kTop + kHeight + 21, kTicks[k], true);
  }
  char text[160];
  std::snprintf(text, sizeof text, "det J (change of area): %.3g to %.3g, black below 0", least,
                greatest);
  canvas.write_text(kLeft, kTop + kHeight + 48, text);
  if (folds.cells > 0)
    std::snprintf(text, sizeof text, "rings: %d folded cells, %d of them turned over", folds.cells,
                  folds.turned_over);
  else
    std::snprintf(text, sizeof text, "no folded cells");
  canvas.write_text(kLeft, kTop + kHeight + 72, text);
}

}  // namespace

void draw_checkerboard(const multigrid::Solution& solution, int width, int height, int threads,
                       Canvas& canvas, const ShareDone& progress) {
  const Checkerboard board(width, height);
  paint(solution, threads, canvas, progress, [&](const Point& point) { return board.mean(point); });
}

void draw_jacobian(const multigrid::Solution& solution, const std::vector<SvgCurve>& curves,
                   int threads, Canvas& canvas, const ShareDone& progress) {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  paint(solution, threads, canvas, progress, [&](const Point& point) {
    const double det = det_J(solution, point.rest);
    least = std::min(least, det);
    greatest = std::max(greatest, det);
    return point.upright ? colour_of(det) : kFolded;
  });
  for (const SvgCurve& curve : curves) {
    add_chain(curve.pair.target, solution.lattice.cell_px, canvas, [](grid::Point p) { return p; });
    canvas.stroke({0.2, 0.2, 0.2, 0.7}, 1.2);
  }
  const Folds folds = mark_folds(solution, canvas);
  write_legend(least, greatest, folds, canvas);
}

}  // namespace drumhead::driver
