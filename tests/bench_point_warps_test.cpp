// SPDX-License-Identifier: MIT
// The warps from pairs of points that bench/ compares the membrane with: what their formulas
// promise.
#include "../bench/point_warps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace drumhead {
namespace {

using bench::Complex;
using bench::Fit;
using bench::PointPairs;
using bench::PointWarp;

/// Points of a square of 100 px, carried by `to`.
template <class Map>
PointPairs scattered(int count, const Map& to) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> place(0.0, 100.0);
  PointPairs points;
  for (int k = 0; k < count; ++k) {
    const double x = place(generator), y = place(generator);
    points.from.emplace_back(x, y);
    points.to.push_back(to(points.from.back()));
  }
  return points;
}

PointPairs bent() {
  return scattered(40, [](Complex p) {
    return p + 9.0 * Complex(std::sin(.08 * p.imag()), std::cos(.05 * p.real()));
  });
}

std::vector<PointWarp> all_warps(const PointPairs& points) {
  return {bench::thin_plate_spline(points), bench::moving_least_squares(points, Fit::rigid),
          bench::moving_least_squares(points, Fit::similarity), bench::shepard(points)};
}

/// Largest difference from `to` away from the points.
template <class Map>
double miss(const PointWarp& warp, const Map& to) {
  double worst = 0.0;
  for (const Complex v : {Complex(3, 4), Complex(50, 51), Complex(-20, 130), Complex(97, 2)})
    worst = std::max(worst, std::abs(warp(v) - to(v)));
  return worst;
}

TEST(PointWarps, MeetTheirPoints) {
  const PointPairs points = bent();
  for (const PointWarp& warp : all_warps(points))
    for (std::size_t k = 0; k < points.from.size(); ++k)
      EXPECT_LT(std::abs(warp(points.from[k]) - points.to[k]), 1e-9);
}

TEST(PointWarps, AThinPlateIsNotBentByAnAffineMap) {
  const auto affine = [](Complex p) { return Complex(2, 1) * p + .3 * std::conj(p) - 7.0; };
  EXPECT_LT(miss(bench::thin_plate_spline(scattered(25, affine)), affine), 1e-8);
}

TEST(PointWarps, LeastSquaresReproduceWhatTheyFit) {
  const auto turn = [](Complex p) { return std::polar(1.0, 2.0) * p + Complex(5, -3); };
  const auto similarity = [&](Complex p) { return 1.7 * turn(p); };
  const auto fitted = [](const auto& map, Fit fit) {
    return bench::moving_least_squares(scattered(25, map), fit);
  };
  EXPECT_LT(miss(fitted(turn, Fit::rigid), turn), 1e-9);
  EXPECT_LT(miss(fitted(similarity, Fit::similarity), similarity), 1e-9);
  EXPECT_GT(miss(fitted(similarity, Fit::rigid), similarity), 1.0);  // it cannot change sizes
}

TEST(PointWarps, ShepardReproducesATranslation) {
  const auto shift = [](Complex p) { return p + Complex(5, -3); };
  EXPECT_LT(miss(bench::shepard(scattered(25, shift)), shift), 1e-9);
}

TEST(PointWarps, AThinPlateIsBiharmonicBetweenItsPoints) {
  PointPairs points;  // far enough from the origin for differences
  for (const Complex p :
       {Complex(0, 0), Complex(40, 0), Complex(0, 50), Complex(60, 60), Complex(80, 10)}) {
    points.from.push_back(p);
    points.to.push_back(p + Complex(p.imag() > 20 ? 10 : -4, p.real() > 50 ? 5 : 2));
  }
  const PointWarp warp = bench::thin_plate_spline(points);
  const auto laplacian = [&](Complex v) {
    return warp(v + 1.0) + warp(v - 1.0) + warp(v + Complex(0, 1)) + warp(v - Complex(0, 1)) -
           4.0 * warp(v);
  };
  const Complex v(25, 22);
  const Complex bending = laplacian(v + 2.0) + laplacian(v - 2.0) + laplacian(v + Complex(0, 2)) +
                          laplacian(v - Complex(0, 2)) - 4.0 * laplacian(v);
  EXPECT_GT(std::abs(laplacian(v)), 1e-3);  // it is bent there
  EXPECT_LT(std::abs(bending), 1e-2 * std::abs(laplacian(v)));
}

TEST(PointWarps, CurvesGivePointsAtEqualArcLength) {
  grid::CurvePair square{.name = "square"};
  const grid::Point corner[] = {{0, 0}, {30, 0}, {30, 30}, {0, 30}};
  for (int k = 0; k < 4; ++k) {
    square.source.push_back(grid::straight(corner[k], corner[(k + 1) % 4]));
    square.target.push_back(grid::straight(2.0 * corner[k], 2.0 * corner[(k + 1) % 4]));
  }
  const PointPairs points = bench::points_on({square}, 5.0);
  ASSERT_EQ(points.from.size(), 24u);  // closed: the first point once
  for (std::size_t k = 0; k < 24; ++k) {
    EXPECT_NEAR(std::abs(points.from[(k + 1) % 24] - points.from[k]), 5.0, 1e-9);
    EXPECT_NEAR(std::abs(points.to[k] - 2.0 * points.from[k]), 0.0, 1e-9);
  }
  const grid::CubicBezier uneven{{{{0, 0}, {0, 0}, {0, 0}, {60, 0}}}};  // its speed grows as t²
  const PointPairs line =
      bench::points_on({{.name = "a", .source = {uneven}, .target = {uneven}}}, 6.0);
  ASSERT_EQ(line.from.size(), 11u);
  for (std::size_t k = 1; k < 10; ++k) EXPECT_NEAR(line.from[k].real(), 6.0 * double(k), .15);
}

TEST(PointWarps, TheLatticesEdgeIsHeld) {
  const grid::Lattice lattice{.nx = 4, .ny = 2, .cell_px = 10.0, .origin_px = {-5, 0}};
  const PointPairs points = bench::points_on({}, lattice, 10.0);
  EXPECT_EQ(points.from.size(), 12u);
  EXPECT_EQ(points.from, points.to);
  std::vector<double> u, v;
  bench::evaluate([](Complex p) { return p * Complex(0, 1); }, lattice, u, v);
  ASSERT_EQ(u.size(), 15u);
  EXPECT_EQ(u[1 * 5 + 3], -10.0 - 25.0);  // node (3, 1) rests at (25, 10)
  EXPECT_EQ(v[1 * 5 + 3], 25.0 - 10.0);
}

}  // namespace
}  // namespace drumhead
