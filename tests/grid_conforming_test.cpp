// SPDX-License-Identifier: MIT
// Cells that conform to curves: hand-made cases, and the properties of thousands of random scenes.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "support/conform_checks.h"
#include "support/random_curves.h"

namespace drumhead::grid {
namespace {

/// How often a closed polygon winds around a point.
int winding(const CurvePair& curve, Point at) {
  int turns = 0;
  for (const CubicBezier& segment : curve.source) {
    constexpr int kPieces = 200;
    Point a = segment.at(0.0) - at;
    for (int n = 1; n <= kPieces; ++n) {
      const Point b = segment.at(double(n) / kPieces) - at;
      if ((a.y <= 0.0) != (b.y <= 0.0) && (cross(a, b) > 0.0) == (b.y > 0.0))
        turns += b.y > 0.0 ? 1 : -1;
      a = b;
    }
  }
  return turns;
}

TEST(GridConforming, StraightThroughTheMiddleOfACellSplitsItIntoTwoQuads) {
  const ConformingCells cells = conform({pin({{0.0, 1.5}, {3.0, 1.5}})}, unit_lattice(3, 3));
  EXPECT_EQ(cells.cells(), 3);
  EXPECT_EQ(cells.parts(), 6);
  EXPECT_EQ(cells.curve_node.size(), 4u);
  EXPECT_TRUE(cells.node.empty());
  for (const double area : cells.part_area) EXPECT_NEAR(area, 0.5, 1e-15);
}

TEST(GridConforming, RandomScenesAreTiledByPositiveTriangles) {
  int simplified = 0, special = 0;
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    const int nx = 5 + int(seed % 9), ny = 5 + int(seed / 9 % 7);
    RandomCurves random(seed, nx, ny);
    for (const double snap : {0.1, 0.25}) {
      const ConformingCells cells =
          conform(random.scene(false), unit_lattice(nx, ny), {.snap = snap});
      ASSERT_EQ(wrong_triangles(cells), "") << "seed " << seed << " snap " << snap;
      ASSERT_EQ(wrong_tiling(cells), "") << "seed " << seed << " snap " << snap;
      simplified += int(cells.simplified_cells.size());
      special += cells.cells();
    }
  }
  EXPECT_LT(simplified, 0.01 * special);  // 0.3 %
}

TEST(GridConforming, EveryPartLiesOnOneSideOfEveryClosedCurve) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const int nx = 6 + int(seed % 9), ny = 6 + int(seed / 9 % 7);
    RandomCurves random(seed, nx, ny);
    const std::vector<CurvePair> curves = random.scene(true);
    const ConformingCells cells = conform(curves, unit_lattice(nx, ny));
    for_parts(cells, [&](int c, int j, int p) {
      std::vector<std::vector<int>> sides;
      for (const int code : codes_of(cells, p)) {
        if (code >= 4 || cells.cell_corner[std::size_t(c)][std::size_t(code)] >= 0) continue;
        const Point at = cells.rest(c, j, code);
        // A node of the fixed boundary may have taken over a curve that passes close by.
        if (at.x == 0.0 || at.y == 0.0 || at.x == nx || at.y == ny) continue;
        sides.emplace_back();
        for (const CurvePair& curve : curves) sides.back().push_back(winding(curve, at));
        ASSERT_EQ(sides.back(), sides.front())
            << "seed " << seed << " cell " << at.x << " " << at.y;
      }
    });
  }
}

bool same(const ConformingCells& a, const ConformingCells& b) {
  auto close = [](const HeldNode& one, const HeldNode& other) {
    return length(one.wanted - other.wanted) < 1e-5 && length(one.rest - other.rest) < 1e-5;
  };
  return a.cell_begin == b.cell_begin && a.cell_column == b.cell_column &&
         a.part_node == b.part_node && a.node_column == b.node_column &&
         std::ranges::equal(a.node, b.node, close) &&
         std::ranges::equal(a.curve_node, b.curve_node, close);
}

// Where curves touch lines or run along them, rounding decides.
TEST(GridConforming, LevelsAreWhatTheCurvesGiveOnEachLattice) {
  constexpr int kLevels = 3, kScenes = 400;
  int different = 0;
  for (unsigned seed = 1; seed <= kScenes; ++seed) {
    const int nx = 9 + int(seed % 9), ny = 9 + int(seed / 9 % 7);
    RandomCurves random(seed, nx, ny);
    const std::vector<CurvePair> curves = random.scene(false);
    Lattice lattice = unit_lattice(nx, ny);
    const std::vector<ConformingCells> levels = conform_levels(curves, lattice, kLevels);
    ASSERT_EQ(levels.size(), std::size_t(kLevels));
    for (const ConformingCells& level : levels) {
      different += !same(level, conform(curves, lattice));
      ASSERT_EQ(wrong_triangles(level), "") << "seed " << seed;
      ASSERT_EQ(wrong_tiling(level), "") << "seed " << seed;
      lattice = coarsened(lattice);
    }
  }
  std::printf("%d of %d lattices differ\n", different, kLevels * kScenes);
  EXPECT_LE(different, 0.01 * kLevels * kScenes);
}

}  // namespace
}  // namespace drumhead::grid
