// SPDX-License-Identifier: MIT
#include "curve_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace drumhead::driver {
namespace {

bool names(const CurveOverride& table, const std::string& curve) {
  return curve == table.name || curve.starts_with(table.name + "#");
}

/// Parameters where a coordinate of the curve is extreme: the ends and the roots of the derivative
/// 3 (a (1−t)² + 2 b t (1−t) + c t²) of one coordinate.
void add_extremes(double p0, double p1, double p2, double p3, std::vector<double>& at) {
  const double a = p1 - p0, b = p2 - p1, c = p3 - p2;
  const double square = a - 2 * b + c, linear = 2 * (b - a);
  const auto add = [&](double t) {
    if (t > 0 && t < 1) at.push_back(t);  // false for what is not finite
  };
  const double root = std::sqrt(linear * linear - 4 * square * a);
  const double half = -0.5 * (linear + std::copysign(root, linear));
  add(half / square);
  add(a / half);
}

/// How far p lies outside, in pixels; 0 inside.
double outside(const grid::Lattice& lattice, grid::Point p) {
  const grid::Point low = lattice.rest_px(0, 0), high = lattice.rest_px(lattice.nx, lattice.ny);
  return std::max({0.0, low.x - p.x, p.x - high.x, low.y - p.y, p.y - high.y});
}

void check_inside(const grid::Lattice& lattice, const SvgCurve& curve) {
  grid::Point worst{};
  double distance = 1e-6 * lattice.cell_px;
  for (const grid::CubicBezier& piece : curve.pair.source) {
    const auto& p = piece.control;
    std::vector<double> at{0.0, 1.0};
    add_extremes(p[0].x, p[1].x, p[2].x, p[3].x, at);
    add_extremes(p[0].y, p[1].y, p[2].y, p[3].y, at);
    for (const double t : at) {
      const grid::Point point = piece.at(t);
      if (outside(lattice, point) > distance) {
        distance = outside(lattice, point);
        worst = point;
      }
    }
  }
  if (distance <= 1e-6 * lattice.cell_px) return;
  const grid::Point low = lattice.rest_px(0, 0), high = lattice.rest_px(lattice.nx, lattice.ny);
  char text[240];
  std::snprintf(
      text, sizeof text,
      ": leaves the lattice at (%.1f, %.1f) px; it must stay within x %.1f to %.1f and y %.1f "
      "to %.1f px (see --margin)",
      worst.x, worst.y, low.x, high.x, low.y, high.y);
  throw std::invalid_argument(curve.place + text);
}

}  // namespace

std::vector<grid::CurvePair> apply_settings(const Options& options,
                                            const std::vector<SvgCurve>& curves) {
  std::vector<grid::CurvePair> pairs;
  for (const SvgCurve& curve : curves) {
    pairs.push_back(curve.pair);
    if (!curve.pin) pairs.back().weight = options.weight;
  }
  for (const CurveOverride& table : options.overrides) {
    bool found = false;
    for (grid::CurvePair& pair : pairs) {
      if (!names(table, pair.name)) continue;
      found = true;
      if (table.weight) pair.weight = *table.weight;
      if (table.turn_degrees) pair.turn_degrees = *table.turn_degrees;
    }
    if (!found) {
      throw std::invalid_argument(table.place + ": [[curve]] '" + table.name +
                                  "': " + options.curves.string() + " has no curve of this name");
    }
  }
  return pairs;
}

void check_inside(const grid::Lattice& lattice, const std::vector<SvgCurve>& curves) {
  for (const SvgCurve& curve : curves) check_inside(lattice, curve);
}

}  // namespace drumhead::driver
