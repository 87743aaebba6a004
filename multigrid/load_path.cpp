// SPDX-License-Identifier: MIT
#include "load_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumhead::multigrid {
namespace {

using grid::Point;

Point turned(Point p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

/// Centroids and best rotation of a matched pair.
struct Motion {
  Point source, target;
  double angle = 0.0;
};

Motion motion(const grid::CurvePair& curve) {
  const Point begin = curve.source.front().control[0];
  Point source, target;
  double total = 0.0, along = 0.0, across = 0.0;
  const auto add = [&](double ds, Point s, Point moved) {
    source = source + ds * s;
    target = target + ds * moved;
    along += ds * grid::dot(s, moved);
    across += ds * grid::cross(s, moved);
    total += ds;
  };
  // Of polylines of hundreds of chords these are enough.
  const bool chords = std::max(curve.source.size(), curve.target.size()) >= 64;
  constexpr int kSamples = 8;
  grid::for_matched(curve, [&](const grid::CubicBezier& from, const grid::CubicBezier& to) {
    if (chords) {
      const Point a = from.control[0] - begin, b = from.control[3] - begin;
      add(grid::length(b - a), 0.5 * (a + b), 0.5 * (to.control[0] + to.control[3]));
      return;
    }
    for (int n = 0; n < kSamples; ++n) {
      const double t = (n + 0.5) / kSamples;
      add(grid::length(from.derivative(t)), from.at(t) - begin, to.at(t));
    }
  });
  // About the centroids.
  Motion m{(1.0 / total) * source, (1.0 / total) * target};
  m.angle = std::atan2(across - grid::cross(source, m.target), along - grid::dot(source, m.target));
  m.source = m.source + begin;
  if (curve.turn_degrees != 0.0) {
    const double full = 2.0 * std::numbers::pi, wanted = curve.turn_degrees / 360.0 * full;
    m.angle += full * std::round((wanted - m.angle) / full);
  }
  return m;
}

}  // namespace

double largest_turn(const std::vector<grid::CurvePair>& curves) {
  double largest = 0.0;
  for (const grid::CurvePair& curve : curves)
    largest = std::max(largest, std::abs(motion(curve).angle));
  return largest;
}

std::vector<grid::CurvePair> one_to_one(const std::vector<grid::CurvePair>& curves) {
  std::vector<grid::CurvePair> out = curves;
  for (grid::CurvePair& curve : out) {
    if (grid::one_to_one(curve)) continue;
    const std::vector<grid::SegmentPair> pairs = grid::matched(curve);
    curve.source.clear();
    curve.target.clear();
    for (const grid::SegmentPair& pair : pairs) {
      curve.source.push_back(pair.source);
      curve.target.push_back(pair.target);
    }
  }
  return out;
}

std::vector<grid::CurvePair> partway(const std::vector<grid::CurvePair>& curves, double t) {
  std::vector<grid::CurvePair> out;
  for (const grid::CurvePair& curve : curves) {
    grid::CurvePair part{curve.name, {}, {}, curve.weight, curve.turn_degrees};
    const Motion m = motion(curve);
    const Point centre = (1.0 - t) * m.source + t * m.target;
    grid::for_matched(curve, [&](const grid::CubicBezier& from, const grid::CubicBezier& to) {
      part.source.push_back(from);
      grid::CubicBezier target;
      for (std::size_t n = 0; n < 4; ++n) {
        // Seen from the turned source, the target's own shape grows linearly.
        const Point s = from.control[n] - m.source;
        const Point shape = turned(to.control[n] - m.target, -m.angle);
        target.control[n] = centre + turned((1.0 - t) * s + t * shape, t * m.angle);
      }
      part.target.push_back(target);
    });
    out.push_back(std::move(part));
  }
  return out;
}

}  // namespace drumhead::multigrid
