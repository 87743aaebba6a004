// SPDX-License-Identifier: MIT
#include "crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace drumhead::grid {
namespace {

using Cubic = std::array<double, 4>;  // Bernstein coefficients of one coordinate

double value(const Cubic& c, double t) {
  const double s = 1.0 - t;
  return s * s * s * c[0] + 3.0 * s * s * t * c[1] + 3.0 * s * t * t * c[2] + t * t * t * c[3];
}

/// Appends the roots of the derivative in (0, 1): between them the coordinate is monotone.
void add_turning_points(const Cubic& c, std::vector<double>& out) {
  const double a = c[1] - c[0], b = c[2] - c[1], d = c[3] - c[2];
  // a (1−t)² + 2 b t (1−t) + d t² = q2 t² + 2 q1 t + q0
  const double q2 = a - 2.0 * b + d, q1 = b - a, q0 = a;
  const double scale = std::max({std::abs(a), std::abs(b), std::abs(d)});
  auto add = [&](double t) {
    if (t > 0.0 && t < 1.0) out.push_back(t);
  };
  if (std::abs(q2) <= 1e-14 * scale) {
    if (q1 != 0.0) add(-q0 / (2.0 * q1));
    return;
  }
  const double square = q1 * q1 - q2 * q0;
  if (square < 0.0) return;
  const double root = std::sqrt(square);
  const double larger = q1 >= 0.0 ? -(q1 + root) : root - q1;
  add(larger / q2);
  if (larger != 0.0) add(q0 / larger);
}

/// The crossing of level between t0 and t1, where the coordinate is monotone: Newton kept in a
/// bracket.
double crossing(const Cubic& c, double level, double t0, double t1) {
  const bool rising = value(c, t1) > value(c, t0);
  double low = t0, high = t1, t = 0.5 * (t0 + t1);
  for (int step = 0; step < 80 && high - low > 1e-15; ++step) {
    const double f = value(c, t) - level;
    ((f < 0.0) == rising ? low : high) = t;
    const double s = 1.0 - t;
    const double slope =
        3.0 * (s * s * (c[1] - c[0]) + 2.0 * s * t * (c[2] - c[1]) + t * t * (c[3] - c[2]));
    const double next = slope != 0.0 ? t - f / slope : low;
    if (std::abs(next - t) < 1e-15) break;
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

void add_crossings(const Cubic& c, std::vector<double>& turning, std::vector<double>& out) {
  const auto [low, high] = std::minmax({c[0], c[1], c[2], c[3]});
  if (std::floor(low - kSnap) == std::floor(high + kSnap)) return;
  turning.assign({0.0, 1.0});
  add_turning_points(c, turning);
  std::ranges::sort(turning);
  for (std::size_t n = 0; n + 1 < turning.size(); ++n) {
    const double x0 = value(c, turning[n]), x1 = value(c, turning[n + 1]);
    // A turn on a line may be an inflection, where the curve passes through it without slope.
    if (n > 0 && std::abs(x0 - std::round(x0)) <= kSnap) out.push_back(turning[n]);
    const double first = std::ceil(std::min(x0, x1) + kSnap), last = std::max(x0, x1) - kSnap;
    for (double level = first; level < last; level += 1.0)
      out.push_back(crossing(c, level, turning[n], turning[n + 1]));
  }
}

}  // namespace

void find_crossings(const CubicBezier& curve, std::vector<double>& out) {
  thread_local std::vector<double> turning;
  out.clear();
  const auto& p = curve.control;
  add_crossings({p[0].x, p[1].x, p[2].x, p[3].x}, turning, out);
  add_crossings({p[0].y, p[1].y, p[2].y, p[3].y}, turning, out);
  std::ranges::sort(out);
}

int cell_index(double x, int n) {
  const double nearest = std::round(x);
  const double snapped = std::abs(x - nearest) < kSnap ? nearest : std::floor(x);
  return std::clamp(int(snapped), 0, n - 1);
}

void refuse_outside(const CurvePair& curve, Point cells, const Lattice& lattice) {
  const Point px = lattice.origin_px + lattice.cell_px * cells;
  const Point end = lattice.rest_px(lattice.nx, lattice.ny);
  auto text = [](Point p) { return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")"; };
  throw std::invalid_argument("curve '" + curve.name + "': the source leaves the lattice at " +
                              text(px) + " px; it reaches from " + text(lattice.origin_px) +
                              " to " + text(end));
}

void add_turning_points(const CubicBezier& curve, std::vector<double>& out) {
  const auto& p = curve.control;
  add_turning_points(Cubic{p[0].x, p[1].x, p[2].x, p[3].x}, out);
  add_turning_points(Cubic{p[0].y, p[1].y, p[2].y, p[3].y}, out);
}

}  // namespace drumhead::grid
