// SPDX-License-Identifier: MIT
#include "point_warps.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/LU>

namespace drumhead::bench {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

Complex complex(grid::Point p) { return {p.x, p.y}; }

/// Adds the points of one curve.
class Sampler {
 public:
  Sampler(double spacing, PointPairs& points) : spacing_(spacing), points_(points) {}

  void add(const grid::CurvePair& curve) {
    const std::vector<grid::SegmentPair> segments = grid::matched(curve);
    // Arc length at places (segment, t) close enough for t to be linear in it between them.
    std::vector<Place> places{{0, 0.0, 0.0}};
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const grid::CubicBezier& source = segments[s].source;
      const double length = grid::arc_length(source);
      const int parts = 1 + int(kPartsPerSpacing * length / spacing_);
      for (int k = 1; k <= parts; ++k) {
        const double t0 = double(k - 1) / parts, t1 = double(k) / parts;
        const double part = parts == 1 ? length : grid::arc_length(source.piece(t0, t1));
        places.push_back({s, t1, places.back().length + part});
      }
    }
    const double whole = places.back().length;
    const int intervals = std::max(1, int(std::ceil(whole / spacing_ - 1e-6)));
    std::size_t at = 1;
    for (int k = 0; k <= intervals; ++k) {
      const double length = whole * k / intervals;
      while (at + 1 < places.size() && places[at].length < length) ++at;
      const Place &a = places[at - 1], &b = places[at];
      const double share = b.length > a.length
                               ? std::clamp((length - a.length) / (b.length - a.length), 0.0, 1.0)
                               : 0.0;
      const double t0 = a.segment == b.segment ? a.t : 0.0, t = t0 + share * (b.t - t0);
      add(complex(segments[b.segment].source.at(t)), complex(segments[b.segment].target.at(t)));
    }
  }

  void add(Complex from, Complex to) {
    for (const Complex p : points_.from)
      if (std::abs(from - p) < 1e-3 * spacing_) return;
    points_.from.push_back(from);
    points_.to.push_back(to);
  }

 private:
  static constexpr double kPartsPerSpacing = 8.0;
  struct Place {
    std::size_t segment;
    double t, length;
  };
  double spacing_;
  PointPairs& points_;
};

/// Points by coordinate, for whole-array expressions.
struct Columns {
  explicit Columns(const std::vector<Complex>& points)
      : x(Index(points.size())), y(Index(points.size())) {
    for (Index k = 0; k < x.size(); ++k) {
      x[k] = points[std::size_t(k)].real();
      y[k] = points[std::size_t(k)].imag();
    }
  }
  ArrayXd squared_distance(Complex v) const {
    return (x - v.real()).square() + (y - v.imag()).square();
  }
  Complex weighted(const ArrayXd& w) const { return {(w * x).sum(), (w * y).sum()}; }
  ArrayXd x, y;
};

/// The pairs for methods of weights 1/r².
struct WeightedPairs {
  explicit WeightedPairs(const PointPairs& points) : p(points.from), q(points.to) {}
  /// Weights of sum 1; at a point itself, that point alone.
  ArrayXd weights(Complex v) const {
    ArrayXd w = p.squared_distance(v);
    Index nearest = 0;
    if (w.minCoeff(&nearest) == 0.0) {
      w.setZero();
      w[nearest] = 1.0;
      return w;
    }
    w = w.inverse();
    return w / w.sum();
  }
  Columns p, q;
};

/// r² ln r from r².
ArrayXd thin_plate(const ArrayXd& squared) {
  constexpr double kLeast = 1e-300;  // its logarithm is finite, and 0 times that is 0
  return 0.5 * squared * squared.max(kLeast).log();
}

}  // namespace

PointPairs points_on(const std::vector<grid::CurvePair>& curves, double spacing) {
  PointPairs points;
  Sampler sampler(spacing, points);
  for (const grid::CurvePair& curve : curves) sampler.add(curve);
  return points;
}

PointPairs points_on(const std::vector<grid::CurvePair>& curves, const grid::Lattice& lattice,
                     double spacing) {
  PointPairs points = points_on(curves, spacing);
  const double left = lattice.origin_px.x, right = left + lattice.cell_px * lattice.nx;
  const double top = lattice.origin_px.y, bottom = top + lattice.cell_px * lattice.ny;
  const grid::Point corner[] = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
  Sampler sampler(spacing, points);
  for (int side = 0; side < 4; ++side) {
    const grid::CubicBezier edge = grid::straight(corner[side], corner[(side + 1) % 4]);
    sampler.add({.name = "edge", .source = {edge}, .target = {edge}});
  }
  return points;
}

PointWarp thin_plate_spline(const PointPairs& points) {
  // Lengths in units of the largest coordinate, so that all columns are of one size.
  double unit = 1.0;
  for (const Complex p : points.from) unit = std::max(unit, std::abs(p));
  std::vector<Complex> from = points.from;
  for (Complex& p : from) p /= unit;
  const auto centres = std::make_shared<const Columns>(from);
  const Index n = centres->x.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + 3, n + 3);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + 3, 2);
  for (Index k = 0; k < n; ++k) {
    const Complex p = from[std::size_t(k)], q = points.to[std::size_t(k)];
    matrix.col(k).head(n) = thin_plate(centres->squared_distance(p)).matrix();
    matrix.col(k).tail(3) << 1.0, p.real(), p.imag();
    matrix.row(k).tail(3) << 1.0, p.real(), p.imag();
    right.row(k) << q.real(), q.imag();
  }
  const Eigen::MatrixXd weights = matrix.partialPivLu().solve(right);
  return [centres, weights, unit, n](Complex v) {
    v /= unit;
    const ArrayXd base = thin_plate(centres->squared_distance(v));
    const auto value = [&](Index axis) {
      const auto w = weights.col(axis);
      return (base * w.head(n).array()).sum() + w[n] + w[n + 1] * v.real() + w[n + 2] * v.imag();
    };
    return Complex(value(0), value(1));
  };
}

PointWarp moving_least_squares(const PointPairs& points, Fit fit) {
  const auto pairs = std::make_shared<const WeightedPairs>(points);
  return [pairs, fit](Complex v) {
    const ArrayXd w = pairs->weights(v);
    const Columns &p = pairs->p, &q = pairs->q;
    const Complex p_mean = p.weighted(w), q_mean = q.weighted(w);
    const ArrayXd px = p.x - p_mean.real(), py = p.y - p_mean.imag();
    const ArrayXd qx = q.x - q_mean.real(), qy = q.y - q_mean.imag();
    const Complex a((w * (qx * px + qy * py)).sum(), (w * (qy * px - qx * py)).sum());
    const double size = fit == Fit::rigid ? std::abs(a) : (w * (px.square() + py.square())).sum();
    // At a point itself all weight is there, and nothing says how to turn.
    return size > 0.0 ? q_mean + (v - p_mean) * a / size : q_mean;
  };
}

PointWarp shepard(const PointPairs& points) {
  const auto pairs = std::make_shared<const WeightedPairs>(points);
  return [pairs](Complex v) {
    const ArrayXd w = pairs->weights(v);
    return v + pairs->q.weighted(w) - pairs->p.weighted(w);
  };
}

void evaluate(const PointWarp& warp, const grid::Lattice& lattice, std::vector<double>& u,
              std::vector<double>& v) {
  u.clear();
  v.clear();
  for (int j = 0; j <= lattice.ny; ++j)
    for (int i = 0; i <= lattice.nx; ++i) {
      const Complex rest(lattice.origin_px.x + lattice.cell_px * i,
                         lattice.origin_px.y + lattice.cell_px * j);
      const Complex moved = warp(rest) - rest;
      u.push_back(moved.real());
      v.push_back(moved.imag());
    }
}

}  // namespace drumhead::bench
