// SPDX-License-Identifier: MIT
#include "load_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumhead::multigrid {
namespace {

using grid::Point;

/// A rotation about the origin.
struct Turning {
  explicit Turning(double angle) : c(std::cos(angle)), s(std::sin(angle)) {}
  Point operator()(Point p) const { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
  double c, s;
};

std::vector<grid::CurvePair> one_to_one(std::vector<grid::CurvePair> curves) {
  for (grid::CurvePair& curve : curves) {
    if (grid::one_to_one(curve)) continue;
    const std::vector<grid::SegmentPair> pairs = grid::matched(curve);
    curve.source.clear();
    curve.target.clear();
    for (const grid::SegmentPair& pair : pairs) {
      curve.source.push_back(pair.source);
      curve.target.push_back(pair.target);
    }
  }
  return curves;
}

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

LoadPath::LoadPath(const std::vector<grid::CurvePair>& curves)
    : curves_(one_to_one(curves)), part_(curves_) {
  for (const grid::CurvePair& curve : curves_) motions_.push_back(motion(curve));
}

const std::vector<grid::CurvePair>& LoadPath::at(double t) {
  if (t == 1.0) return curves_;
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    const Motion& m = motions_[k];
    const Point centre = (1.0 - t) * m.source + t * m.target;
    const Turning back(-m.angle), forth(t * m.angle);
    for (std::size_t n = 0; n < curves_[k].source.size(); ++n) {
      const grid::CubicBezier &from = curves_[k].source[n], &to = curves_[k].target[n];
      for (std::size_t c = 0; c < 4; ++c) {
        // Seen from the turned source, the target's own shape grows linearly.
        const Point s = from.control[c] - m.source, shape = back(to.control[c] - m.target);
        part_[k].target[n].control[c] = centre + forth((1.0 - t) * s + t * shape);
      }
    }
  }
  return part_;
}

}  // namespace drumhead::multigrid
