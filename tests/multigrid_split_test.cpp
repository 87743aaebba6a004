// SPDX-License-Identifier: MIT
// Solutions on conforming cells as they are rendered and judged: the forward mesh of quads and
// triangles, its inverse, gaps along curves and folds.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <drumhead/multigrid/warp.h>

#include "support/random_curves.h"
#include "support/warped_lattice.h"

// Private headers of multigrid.
#include "analysis.h"
#include "split_cells.h"

namespace drumhead::multigrid {
namespace {

using grid::Point;
using Map = std::function<Point(Point)>;

constexpr double kCell = 9.7;
const Point kOrigin{-7.3, -11.9};

/// What the cells make of a map that is given at their nodes.
Solution interpolated(const std::vector<grid::CurvePair>& curves, const grid::Lattice& lattice,
                      const Map& to) {
  const grid::ConformingCells cells = grid::conform(curves, lattice);
  Solution solution;
  solution.lattice = lattice;
  auto displacement = [&](Point cells_at) {
    const Point rest = lattice.origin_px + lattice.cell_px * cells_at;
    return to(rest) - rest;
  };
  for (int j = 0; j <= lattice.ny; ++j)
    for (int i = 0; i <= lattice.nx; ++i) {
      const int held = cells.find_node(i, j);
      const Point at = held < 0 ? Point{double(i), double(j)} : cells.node[std::size_t(held)].rest;
      solution.u_px.push_back(displacement(at).x);
      solution.v_px.push_back(displacement(at).y);
    }
  std::vector<Point> curve;
  for (const grid::HeldNode& node : cells.curve_node) curve.push_back(displacement(node.rest));
  set_split_cells(cells, curve, solution);
  return solution;
}

grid::Lattice lattice(int nx, int ny) {
  return {.nx = nx, .ny = ny, .cell_px = kCell, .origin_px = kOrigin, .side_px = kCell * nx};
}

/// Curves given in cells, moved to the lattice's place.
std::vector<grid::CurvePair> placed(std::vector<grid::CurvePair> curves) {
  for (grid::CurvePair& curve : curves)
    for (auto* chain : {&curve.source, &curve.target})
      for (grid::CubicBezier& segment : *chain)
        for (Point& p : segment.control) p = kOrigin + kCell * p;
  return curves;
}

tests::BackwardMap backward(const Solution& solution, int width, int height) {
  const std::size_t n = std::size_t(width) * std::size_t(height);
  tests::BackwardMap map{width,
                         height,
                         0,
                         0,
                         std::vector<kernels::Position>(n),
                         std::vector<float>(4 * n),
                         std::vector<signed char>(n)};
  kernels::backward_map(map_of(solution),
                        {map.source.data(), reinterpret_cast<float(*)[4]>(map.jacobian.data()),
                         map.side.data(), width, height, width, 0, 0});
  return map;
}

TEST(MultigridSplit, IdentityOnSplitCellsReturnsThePictureBitForBit) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    grid::RandomCurves random(seed, 17, 13);
    const Solution solution =
        interpolated(placed(random.scene(false)), lattice(17, 13), [](Point p) { return p; });
    ASSERT_FALSE(solution.split.triangle.empty());
    tests::Picture picture = tests::noise(150, 101, 3, seed), out(150, 101, 3);
    kernels::Resampler(picture.view(), map_of(solution), {}).render(out.target());
    EXPECT_EQ(std::memcmp(picture.data.data(), out.data.data(), 4 * out.data.size()), 0) << seed;
  }
}

TEST(MultigridSplit, AnAffineMapIsExactInTrianglesAndQuads) {
  const Map affine = [](Point p) {
    return Point{0.9 * p.x - 0.2 * p.y + 3.0, 0.3 * p.x + 0.9 * p.y - 5.0};
  };
  const double det = 0.9 * 0.9 + 0.2 * 0.3;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    grid::RandomCurves random(seed, 17, 13);
    const Solution solution = interpolated(placed(random.scene(false)), lattice(17, 13), affine);
    const tests::BackwardMap map = backward(solution, 140, 100);
    int inside = 0;
    for (int b = 0; b < 100; ++b)
      for (int a = 0; a < 140; ++a) {
        const std::size_t k = map.index(a, b);
        // Beyond the lattice's warped edge a pixel may be taken to lie on it.
        const Point from{(0.9 * (a - 2.5) + 0.2 * (b + 5.5)) / det,
                         (-0.3 * (a - 2.5) + 0.9 * (b + 5.5)) / det};
        const Point at = solution.lattice.to_cells(from);
        if (at.x < 0.01 || at.y < 0.01 || at.x > 16.99 || at.y > 12.99) continue;
        ASSERT_EQ(map.side[k], 1);
        ++inside;
        const Point to = affine({map.source[k].x, map.source[k].y});
        ASSERT_NEAR(to.x, a + 0.5, 1e-9);
        ASSERT_NEAR(to.y, b + 0.5, 1e-9);
        ASSERT_NEAR(map.jacobian[4 * k + 0], 0.9 / det, 1e-5);
        ASSERT_NEAR(map.jacobian[4 * k + 1], 0.2 / det, 1e-5);
        ASSERT_NEAR(map.jacobian[4 * k + 2], -0.3 / det, 1e-5);
        ASSERT_NEAR(map.jacobian[4 * k + 3], 0.9 / det, 1e-5);
      }
    EXPECT_GT(inside, 8000);
    const FoldReport folds = find_folds(solution);
    EXPECT_EQ(folds.folded_cells, 0);
    EXPECT_NEAR(folds.min_J, det, 1e-9);
    EXPECT_NEAR(folds.min_corner_J, det, 1e-9);
  }
}

TEST(MultigridSplit, ForwardAndBackwardMapAreInverse) {
  const Map swirl = [](Point p) {
    return Point{p.x + 4.0 * std::sin(0.05 * p.y), p.y + 3.0 * std::sin(0.06 * p.x + 1.0)};
  };
  grid::RandomCurves random(4, 17, 13);
  for (int scene = 0; scene < 20; ++scene) {
    const Solution solution = interpolated(placed(random.scene(false)), lattice(17, 13), swirl);
    const tests::BackwardMap map = backward(solution, 140, 100);
    for (int b = 5; b < 95; ++b)
      for (int a = 5; a < 135; ++a) {
        const std::size_t k = map.index(a, b);
        if (map.side[k] == 0) continue;
        const kernels::Position to = kernels::forward_position(map_of(solution), map.source[k]);
        ASSERT_NEAR(to.x, a + 0.5, 1e-6) << scene;
        ASSERT_NEAR(to.y, b + 0.5, 1e-6) << scene;
      }
  }
}

/// Turned inside a circle, at rest outside: along the circle the map has a kink.
TEST(MultigridSplit, AKinkAlongACurveIsRenderedWhereItIs) {
  const Point centre = kOrigin + kCell * Point{8.6, 6.3};
  const double radius = 3.7 * kCell;
  const Map bulge = [&](Point p) {
    const double r = grid::length(p - centre);
    return r < radius ? p : centre + (2.0 - radius / r) * (p - centre);
  };
  grid::CurvePair circle = grid::pinned(grid::round({8.6, 6.3}, 3.7));
  const Solution split = interpolated(placed({circle}), lattice(17, 13), bulge);
  const Solution whole = interpolated({}, lattice(17, 13), bulge);
  auto worst = [&](const Solution& solution) {
    double distance = 0.0;
    for (int n = 0; n < 2000; ++n) {
      const double angle = 0.00314159 * n;
      for (const double r : {0.97 * radius, radius}) {
        const Point at = centre + r * Point{std::cos(angle), std::sin(angle)}, to = bulge(at);
        const kernels::Position p = kernels::forward_position(map_of(solution), {at.x, at.y});
        distance = std::max(distance, std::hypot(p.x - to.x, p.y - to.y));
      }
    }
    return distance;
  };
  EXPECT_GT(worst(whole), 0.15 * kCell);
  EXPECT_LT(worst(split), 0.07 * kCell);  // chord and arc: h²/8r

  const double gap = curve_gaps(split, placed({circle})).front().gap_max_px;
  EXPECT_LT(gap, 0.07 * kCell);
  EXPECT_LT(gap, 0.5 * curve_gaps(whole, placed({circle})).front().gap_max_px);
}

TEST(MultigridSplit, LatticePlacesOfMovedNodesReportTheirOwnDisplacement) {
  const Map affine = [](Point p) { return Point{1.5 * p.x, p.y - 0.25 * p.x}; };
  const Solution solution = interpolated(placed({grid::pin({{1.3, 2.2}, {9.8, 7.1}, {12.1, 3.3}})}),
                                         lattice(17, 13), affine);
  for (int j = 0; j <= 13; ++j)
    for (int i = 0; i <= 17; ++i) {
      const Point rest = solution.lattice.rest_px(i, j), to = affine(rest);
      const std::size_t n = std::size_t(j) * 18 + std::size_t(i);
      EXPECT_NEAR(solution.u_px[n], to.x - rest.x, 1e-9);
      EXPECT_NEAR(solution.v_px[n], to.y - rest.y, 1e-9);
    }
}

TEST(MultigridSplit, ATriangleTurnedOverOntoOthersIsCountedAndHiddenUnderThem) {
  const grid::Lattice square = lattice(5, 5);
  Solution solution = interpolated(placed({grid::pin({{1.5, 2.5}, {3.5, 2.5}})}), square,
                                   [](Point p) { return p; });
  const FoldReport before = find_folds(solution);
  EXPECT_EQ(before.folded_cells, 0);
  // One corner of one triangle is carried across the opposite side.
  kernels::MapTriangle& triangle = solution.split.triangle.front();
  const kernels::Position* r = triangle.rest;
  triangle.displacement[0] = {r[1].x + r[2].x - 2.0 * r[0].x, r[1].y + r[2].y - 2.0 * r[0].y};
  const FoldReport folds = find_folds(solution);
  EXPECT_EQ(folds.folded_cells, 1);
  EXPECT_NEAR(folds.min_corner_J, -1.0, 1e-9);
  const tests::BackwardMap map = backward(solution, 40, 36);
  int hidden = 0;
  for (std::size_t k = 0; k < map.side.size(); ++k) {
    hidden += map.side[k] < 0;
    // What it was carried over is seen, not it: only its own place shows its back, or nothing.
    const kernels::Position at = map.source[k];
    EXPECT_NEAR(at.x, double(k % 40) + 0.5, 1e-9);
    EXPECT_NEAR(at.y, double(k / 40) + 0.5, 1e-9);
  }
  EXPECT_EQ(hidden, 0);
}

}  // namespace
}  // namespace drumhead::multigrid
