// SPDX-License-Identifier: MIT
#include <drumhead/grid/curve.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "crossings.h"
#include "quadrature.h"

namespace drumhead::grid {
namespace {

constexpr double kLengthTolerance = 1e-10;
// Equal parameters may deviate from equal relative arc length by this share of the chain.
constexpr double kMatchTolerance = 1e-4;
constexpr int kMostHalvings = 24;

Point mix(Point a, Point b, double t) { return (1.0 - t) * a + t * b; }

double gauss_length(const CubicBezier& curve, double t0, double t1) {
  double sum = 0.0;
  for_gauss_points(t0, t1,
                   [&](double t, double weight) { sum += weight * length(curve.derivative(t)); });
  return sum;
}

double adaptive_length(const CubicBezier& curve, double t0, double t1, double whole, double scale,
                       int depth) {
  const double middle = 0.5 * (t0 + t1);
  const double left = gauss_length(curve, t0, middle), right = gauss_length(curve, middle, t1);
  if (depth == 0 || std::abs(left + right - whole) <= kLengthTolerance * scale) return left + right;
  return adaptive_length(curve, t0, middle, left, scale, depth - 1) +
         adaptive_length(curve, middle, t1, right, scale, depth - 1);
}

double length_between(const CubicBezier& curve, double t0, double t1) {
  if (curve.constant_speed()) return (t1 - t0) * length(curve.control[3] - curve.control[0]);
  // Between turns of x and y the speed has no hidden corner: a curve that runs back and forth on
  // one line has, and the halves of an arc around one can agree with the whole by accident.
  std::vector<double> breaks{t0};
  add_turning_points(curve, breaks);
  std::erase_if(breaks, [&](double t) { return t < t0 || t >= t1; });
  breaks.push_back(t1);
  std::ranges::sort(breaks);
  double sum = 0.0;
  for (std::size_t n = 0; n + 1 < breaks.size(); ++n) {
    const double whole = gauss_length(curve, breaks[n], breaks[n + 1]);
    if (whole > 0.0)
      sum += adaptive_length(curve, breaks[n], breaks[n + 1], whole, whole, kMostHalvings);
  }
  return sum;
}

/// A chain with the arc length at which each segment begins, relative to the whole.
struct MeasuredChain {
  const std::vector<CubicBezier>& segments;
  std::vector<double> begin;
  double total = 0.0;

  explicit MeasuredChain(const std::vector<CubicBezier>& chain) : segments(chain) {
    for (const CubicBezier& segment : chain) {
      begin.push_back(total);
      total += length_between(segment, 0.0, 1.0);
    }
    begin.push_back(total);
    for (double& s : begin) s /= total;
  }

  /// Segment and parameter at relative arc length s.
  std::pair<std::size_t, double> at(double s) const {
    const auto after = std::upper_bound(begin.begin() + 1, begin.end() - 1, s);
    const std::size_t n = std::size_t(after - begin.begin()) - 1;
    const double wanted = (s - begin[n]) * total;
    double low = 0.0, high = 1.0;
    for (int step = 0; step < 50 && high - low > 1e-13; ++step) {
      const double middle = 0.5 * (low + high);
      (length_between(segments[n], 0.0, middle) < wanted ? low : high) = middle;
    }
    return {n, 0.5 * (low + high)};
  }

  /// The piece between two relative arc lengths, which lies in one segment.
  CubicBezier piece(double s0, double s1) const {
    const auto [n, t] = at(0.5 * (s0 + s1));
    auto parameter = [&, n = n](double s) {
      if (s <= begin[n] + 1e-12) return 0.0;
      if (s >= begin[n + 1] - 1e-12) return 1.0;
      const auto [m, value] = at(s);
      return m == n ? value : (m < n ? 0.0 : 1.0);
    };
    return segments[n].piece(parameter(s0), parameter(s1));
  }
};

/// How far half the parameter is from half the arc length, as a share of the piece.
double unevenness(const CubicBezier& piece) {
  const double whole = length_between(piece, 0.0, 1.0);
  return whole > 0.0 ? std::abs(length_between(piece, 0.0, 0.5) / whole - 0.5) : 0.0;
}

void match_by_length(const MeasuredChain& source, const MeasuredChain& target, double s0, double s1,
                     int depth, std::vector<SegmentPair>& out) {
  const SegmentPair pair{source.piece(s0, s1), target.piece(s0, s1)};
  const double uneven = std::max(unevenness(pair.source), unevenness(pair.target)) * (s1 - s0);
  if (depth == 0 || uneven < kMatchTolerance) {
    out.push_back(pair);
    return;
  }
  const double middle = 0.5 * (s0 + s1);
  match_by_length(source, target, s0, middle, depth - 1, out);
  match_by_length(source, target, middle, s1, depth - 1, out);
}

void check_chain(const std::string& name, const char* side, const std::vector<CubicBezier>& chain) {
  if (chain.empty()) throw std::invalid_argument("curve '" + name + "': the " + side + " is empty");
  const auto finite = [](const CubicBezier& segment) {
    const auto& p = segment.control;
    return (0.0 * p[0] + 0.0 * p[1]) + (0.0 * p[2] + 0.0 * p[3]) == Point{};
  };
  if (!std::ranges::all_of(chain, finite))
    throw std::invalid_argument("curve '" + name + "': the " + side +
                                " has a point that is not finite");
  const bool has_length = std::ranges::any_of(chain, [](const CubicBezier& segment) {
    return std::ranges::any_of(segment.control,
                               [&](const Point& p) { return !(p == segment.control[0]); });
  });
  if (!has_length)
    throw std::invalid_argument("curve '" + name + "': the " + side + " has no length");
}

}  // namespace

Point CubicBezier::at(double t) const {
  const double s = 1.0 - t;
  return s * s * s * control[0] + 3.0 * s * s * t * control[1] + 3.0 * s * t * t * control[2] +
         t * t * t * control[3];
}

Point CubicBezier::derivative(double t) const {
  const double s = 1.0 - t;
  return 3.0 * s * s * (control[1] - control[0]) + 6.0 * s * t * (control[2] - control[1]) +
         3.0 * t * t * (control[3] - control[2]);
}

bool CubicBezier::constant_speed() const {
  const auto size = [](Point p) { return std::max(std::abs(p.x), std::abs(p.y)); };
  const Point a = control[1] - control[0], b = control[2] - control[1], c = control[3] - control[2];
  double largest = 0.0;  // of the coordinates, whose rounding the differences carry
  for (const Point& p : control) largest = std::max(largest, size(p));
  const double tiny = 1e-13 * (size(a) + size(b) + size(c)) + 1e-15 * largest;
  return size(b - a) <= tiny && size(c - b) <= tiny;
}

CubicBezier CubicBezier::piece(double t0, double t1) const {
  // Blossom: control point n takes t1 as n of its three arguments.
  auto blossom = [&](double a, double b, double c) {
    const Point p01 = mix(control[0], control[1], a), p12 = mix(control[1], control[2], a),
                p23 = mix(control[2], control[3], a);
    return mix(mix(p01, p12, b), mix(p12, p23, b), c);
  };
  return {{blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1), blossom(t1, t1, t1)}};
}

CubicBezier straight(Point a, Point b) {
  return {{a, mix(a, b, 1.0 / 3.0), mix(a, b, 2.0 / 3.0), b}};
}

double arc_length(const CubicBezier& curve) { return length_between(curve, 0.0, 1.0); }

double arc_length(const std::vector<CubicBezier>& chain) {
  double sum = 0.0;
  for (const CubicBezier& segment : chain) sum += arc_length(segment);
  return sum;
}

void check(const CurvePair& pair) {
  check_chain(pair.name, "source", pair.source);
  check_chain(pair.name, "target", pair.target);
}

std::vector<SegmentPair> matched(const CurvePair& pair) {
  check(pair);
  std::vector<SegmentPair> out;
  if (one_to_one(pair)) {
    out.reserve(pair.source.size());
    for (std::size_t n = 0; n < pair.source.size(); ++n)
      out.push_back({pair.source[n], pair.target[n]});
    return out;
  }
  const MeasuredChain source(pair.source), target(pair.target);
  std::vector<double> breaks = source.begin;
  breaks.insert(breaks.end(), target.begin.begin(), target.begin.end());
  std::ranges::sort(breaks);
  for (std::size_t n = 0; n + 1 < breaks.size(); ++n)
    if (breaks[n + 1] - breaks[n] > 1e-9)
      match_by_length(source, target, breaks[n], breaks[n + 1], 12, out);
  return out;
}

}  // namespace drumhead::grid
