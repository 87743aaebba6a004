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

Motion motion(const std::vector<grid::SegmentPair>& segments, double turn_degrees) {
  // Polylines of thousands of chords need no more than their middles.
  const int samples = segments.size() < 64 ? 8 : 1;
  Motion m;
  double total = 0.0;
  auto sample = [&](auto&& visit) {
    for (const grid::SegmentPair& pair : segments)
      for (int n = 0; n < samples; ++n) {
        const double t = (n + 0.5) / samples;
        visit(pair.source.at(t), pair.target.at(t), grid::length(pair.source.derivative(t)));
      }
  };
  sample([&](Point s, Point t, double ds) {
    m.source = m.source + ds * s;
    m.target = m.target + ds * t;
    total += ds;
  });
  m.source = (1.0 / total) * m.source;
  m.target = (1.0 / total) * m.target;
  double along = 0.0, across = 0.0;
  sample([&](Point s, Point t, double ds) {
    along += ds * grid::dot(s - m.source, t - m.target);
    across += ds * grid::cross(s - m.source, t - m.target);
  });
  m.angle = std::atan2(across, along);
  if (turn_degrees != 0.0) {
    const double full = 2.0 * std::numbers::pi, wanted = turn_degrees / 360.0 * full;
    m.angle += full * std::round((wanted - m.angle) / full);
  }
  return m;
}

}  // namespace

double turning_angle(const grid::CurvePair& curve) {
  return motion(grid::matched(curve), curve.turn_degrees).angle;
}

double largest_turn(const std::vector<grid::CurvePair>& curves) {
  double largest = 0.0;
  for (const grid::CurvePair& curve : curves)
    largest = std::max(largest, std::abs(turning_angle(curve)));
  return largest;
}

std::vector<grid::CurvePair> partway(const std::vector<grid::CurvePair>& curves, double t) {
  std::vector<grid::CurvePair> out;
  for (const grid::CurvePair& curve : curves) {
    grid::CurvePair part{curve.name, {}, {}, curve.weight, curve.turn_degrees};
    const std::vector<grid::SegmentPair> segments = grid::matched(curve);
    const Motion m = motion(segments, curve.turn_degrees);
    const Point centre = (1.0 - t) * m.source + t * m.target;
    for (const grid::SegmentPair& pair : segments) {
      part.source.push_back(pair.source);
      grid::CubicBezier target;
      for (std::size_t n = 0; n < 4; ++n) {
        // Seen from the turned source, the target's own shape grows linearly.
        const Point s = pair.source.control[n] - m.source;
        const Point shape = turned(pair.target.control[n] - m.target, -m.angle);
        target.control[n] = centre + turned((1.0 - t) * s + t * shape, t * m.angle);
      }
      part.target.push_back(target);
    }
    out.push_back(std::move(part));
  }
  return out;
}

}  // namespace drumhead::multigrid
