// SPDX-License-Identifier: MIT
#pragma once
// Curve pairs (Setaluri et al. 2014, section 3): a source curve S(s) drawn on the picture and the
// target curve that the warp carries it to. Both are chains of cubic Béziers in picture pixels
// (continuous: 0 at the left and top edge, x right, y down). One pair of equal parameters (segment,
// t) gives one constraint point; `matched` makes the chains have equal numbers of segments when
// they have not.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace drumhead::grid {

/// A point or vector in picture pixels.
struct Point {
  double x = 0.0, y = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
};
inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
/// |a|
inline double length(Point a) { return std::sqrt(a.x * a.x + a.y * a.y); }

/// One cubic Bézier segment, t in [0, 1].
struct CubicBezier {
  std::array<Point, 4> control{};
  Point at(double t) const;
  Point derivative(double t) const;
  /// A straight segment run through at constant speed.
  bool constant_speed() const;
  /// The piece over [t0, t1] with its own parameter in [0, 1] (de Casteljau).
  CubicBezier piece(double t0, double t1) const;
  friend bool operator==(const CubicBezier&, const CubicBezier&) = default;
};

/// The straight segment a→b as a Bézier of constant speed.
CubicBezier straight(Point a, Point b);

/// Arc length to 1e-10 relative.
double arc_length(const CubicBezier& curve);
double arc_length(const std::vector<CubicBezier>& chain);

/// A source curve and where it goes.
struct CurvePair {
  std::string name;                 ///< named in errors and in the report
  std::vector<CubicBezier> source;  ///< connected chain on the picture, at least one segment
  std::vector<CubicBezier> target;  ///< its image; equal to `source` for a pin
  /// d: stiffness per length, in units of mu per longer picture side; infinity: exactly hard. > 0.
  double weight = std::numeric_limits<double>::infinity();
  double turn_degrees =
      0.0;  ///< clockwise turn intended by the user, for rotations beyond 180 degrees
  friend bool operator==(const CurvePair&, const CurvePair&) = default;
};

/// Two Béziers whose points at equal t correspond.
struct SegmentPair {
  CubicBezier source, target;
};

/// Throws std::invalid_argument naming the curve when a chain is empty, has no length or holds a
/// point that is not finite.
void check(const CurvePair& pair);

/// The pair as corresponding segments: one to one where both chains have the same number of
/// segments, by relative arc length otherwise (pieces are divided until equal t deviates from equal
/// relative arc length by less than 1e-4 of the chain). Throws as `check` does.
std::vector<SegmentPair> matched(const CurvePair& pair);

/// Whether both chains have the same number of segments.
inline bool one_to_one(const CurvePair& pair) { return pair.source.size() == pair.target.size(); }

/// Calls f(source, target) for the segments of `matched`, which are copied only where chains are
/// not one to one: a polyline may have thousands. Of a pair that `check` lets pass.
template <class F>
void for_matched(const CurvePair& pair, F&& f) {
  if (one_to_one(pair)) {
    for (std::size_t n = 0; n < pair.source.size(); ++n) f(pair.source[n], pair.target[n]);
  } else {
    for (const SegmentPair& segment : matched(pair)) f(segment.source, segment.target);
  }
}

}  // namespace drumhead::grid
