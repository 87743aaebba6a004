// SPDX-License-Identifier: MIT
// Cut cells of smooth and of awkward curves. (Those of the study scenes are compared with the
// oracle's cutting elsewhere.)
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/cut_checks.h"
#include "support/refusal.h"

namespace drumhead::grid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Cells = std::vector<std::pair<int, int>>;

/// Curves of every kind that stay away from the fixed boundary of a 12 × 9 lattice.
std::vector<CurvePair> inner_curves() {
  const CubicBezier bow{{{{1.3, 2.2}, {9.1, 8.7}, {2.4, 9.4}, {10.6, 1.7}}}};
  const CubicBezier loop{{{{3.1, 3.3}, {14.2, 7.9}, {-2.3, 7.7}, {8.9, 2.1}}}};
  return {pinned({bow}),
          pinned({loop}),
          pinned(round({6.1, 4.4}, 2.7)),
          pin({{1.5, 1.5}, {10.5, 7.2}, {2.2, 6.9}}),
          pin({{2.0, 1.5}, {2.0, 7.5}}),   // on a grid line
          pin({{1.5, 3.0}, {10.5, 3.0}}),  // on another
          pin({{2.0, 2.0}, {7.0, 7.0}}),   // through corners
          pin({{3.2, 3.2}, {3.7, 3.4}})};  // inside a cell
}

CutCells cut_one(const CurvePair& curve) { return cut({curve}, unit_lattice(12, 9), kInfinity); }

TEST(GridCutCells, LengthsAddUpToTheArcLength) {
  for (const CurvePair& curve : inner_curves()) {
    const double whole = arc_length(curve.source);
    EXPECT_NEAR(total_length(cut_one(curve)), whole, 1e-9 * whole);
  }
}

TEST(GridCutCells, WeightsAreMeansOfABilinearPartitionOfOne) {
  for (const CurvePair& curve : inner_curves()) {
    const CutCells cuts = cut_one(curve);
    for (std::size_t k = 0; k < cuts.column.size(); ++k) {
      EXPECT_NEAR(weight_sum(cuts, k), 1.0, 1e-12);
      for (const double w : cuts.weight[k]) {
        EXPECT_GE(w, -1e-12);
        EXPECT_LE(w, 1.0 + 1e-12);
      }
    }
  }
}

// The mean of the target under an affine map is the map of the mean, and the weights know the mean.
TEST(GridCutCells, TheWantedDisplacementOfAnAffineMapIsThatOfTheMeanPoint) {
  const auto map = [](Point p) { return Point{1.5 * p.x - 0.3 * p.y + 2.0, 0.7 * p.y - 1.0}; };
  for (CurvePair curve : inner_curves()) {
    for (CubicBezier& segment : curve.target)
      for (Point& p : segment.control) p = map(p);
    const CutCells cuts = cut_one(curve);
    const Cells cells = cells_of(cuts);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const Point mean = mean_point(cuts, k, cells[k]);
      EXPECT_NEAR(cuts.wanted[k].x, (map(mean) - mean).x, 1e-9);
      EXPECT_NEAR(cuts.wanted[k].y, (map(mean) - mean).y, 1e-9);
    }
  }
}

/// A Bézier whose control points often lie on grid lines and nodes, so that it touches, follows and
/// ends on them.
CubicBezier awkward(std::mt19937& random) {
  CubicBezier curve;
  for (Point& p : curve.control) {
    const auto coordinate = [&](unsigned cells) {
      const double whole = 1.0 + double(random() % (cells - 1));
      const double part = random() % 2 ? 0.0 : double(random() % 1000) / 1000.0;
      return std::min(whole + part, cells - 1.0);
    };
    p.x = coordinate(12);
    p.y = coordinate(9);
  }
  return curve;
}

TEST(GridCutCells, EveryCellThatAnAwkwardCurveVisitsIsCut) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 1000; ++trial) {
    const CubicBezier curve = awkward(random);
    if (arc_length(curve) == 0.0) continue;
    const Cells cells = cells_of(cut_one(pinned({curve})));
    for (int n = 0; n < 100; ++n) {
      const Point p = curve.at(n / 100.0);
      const Point in_cell{p.x - std::floor(p.x), p.y - std::floor(p.y)};
      const auto near = [](double x) { return std::min(x, 1.0 - x) < 2e-3; };
      if (near(in_cell.x) || near(in_cell.y)) continue;
      const std::pair cell{int(p.x), int(p.y)};
      ASSERT_EQ(std::ranges::count(cells, cell), 1) << "trial " << trial << ", point " << n;
    }
  }
}

TEST(GridCutCells, AwkwardCurvesLoseNoMoreThanTheirShortStays) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 1000; ++trial) {
    const CubicBezier curve = awkward(random);
    const double whole = arc_length(curve);
    if (whole == 0.0) continue;
    const double found = total_length(cut_one(pinned({curve})));
    ASSERT_LE(found, whole * (1.0 + 1e-6)) << "trial " << trial;
    ASSERT_GE(found, whole * (1.0 - 1e-6) - 4e-3) << "trial " << trial;
  }
}

TEST(GridCutCells, CutsAreSortedByRowThenColumn) {
  const Cells cells = cells_of(cut(inner_curves(), unit_lattice(12, 9), kInfinity));
  for (std::size_t k = 0; k + 1 < cells.size(); ++k) {
    const auto [i, j] = cells[k];
    const auto [next_i, next_j] = cells[k + 1];
    EXPECT_TRUE(j < next_j || (j == next_j && i < next_i));
  }
}

TEST(GridCutCells, LengthsAreInCellsWhateverAPixelIs) {
  const std::vector<Point> points{{15, 25}, {105, 72}};
  const Lattice lattice{.nx = 12, .ny = 9, .cell_px = 10.0, .origin_px = {-5, 5}, .side_px = 120};
  EXPECT_NEAR(total_length(cut({pin(points)}, lattice, kInfinity)), std::hypot(9.0, 4.7), 1e-9);
}

TEST(GridCutCells, APointOnAGridLineBelongsToTheCellOfLargerIndex) {
  EXPECT_EQ(cells_of(cut_one(pin({{2.0, 1.5}, {2.0, 3.5}}))), (Cells{{2, 1}, {2, 2}, {2, 3}}));
  EXPECT_EQ(cells_of(cut_one(pin({{1.5, 3.0}, {3.5, 3.0}}))), (Cells{{1, 3}, {2, 3}, {3, 3}}));
}

TEST(GridCutCells, ACurveWithin1e9OfAGridLineLiesOnIt) {
  for (const double x : {2.0 - 5e-10, 2.0 + 5e-10}) {
    const CutCells cuts = cut_one(pin({{x, 1.5}, {x, 3.5}}));
    EXPECT_EQ(cells_of(cuts), (Cells{{2, 1}, {2, 2}, {2, 3}}));
  }
}

TEST(GridCutCells, ACurveThatWaversAboutAGridLineIsCutOnce) {
  const double tiny = 5e-10;
  const CurvePair curve = pin({{2.0 - tiny, 1.5}, {2.0 + tiny, 1.8}, {2.0 - tiny, 2.5}});
  EXPECT_EQ(cells_of(cut_one(curve)), (Cells{{2, 1}, {2, 2}}));
}

TEST(GridCutCells, ACurveThatInflectsOnAGridLineCrossesIt) {
  // y = 3 + 2 (3 t − 6 t² + 4 t³) has no slope where it passes 4.
  const CubicBezier level{{{{2.5, 3.0}, {2.5, 5.0}, {2.5, 3.0}, {2.5, 5.0}}}};
  const CutCells cuts = cut_one(pinned({level}));
  EXPECT_EQ(cells_of(cuts), (Cells{{2, 3}, {2, 4}}));
  for (const double len : cuts.length) EXPECT_NEAR(len, 1.0, 1e-9);
}

TEST(GridCutCells, ACurveThatTouchesAGridLineStaysOnItsSide) {
  // y = 3.2 + 3.2 t (1 − t) reaches 4 and turns back.
  const CubicBezier arch{{{{2.5, 3.2}, {2.6, 4.0 + 0.8 / 3}, {2.8, 4.0 + 0.8 / 3}, {2.9, 3.2}}}};
  ASSERT_NEAR(arch.at(0.5).y, 4.0, 1e-12);
  EXPECT_EQ(cells_of(cut_one(pinned({arch}))), (Cells{{2, 3}}));
}

TEST(GridCutCells, ACurveThroughCornersMeetsOnlyTheCellsOnItsWay) {
  const CutCells cuts = cut_one(pin({{2.0, 2.0}, {5.0, 5.0}}));
  EXPECT_EQ(cells_of(cuts), (Cells{{2, 2}, {3, 3}, {4, 4}}));
  for (const double len : cuts.length) EXPECT_NEAR(len, std::sqrt(2.0), 1e-12);
}

TEST(GridCutCells, ACurveThatEndsInACornerDoesNotEnterTheNextCell) {
  EXPECT_EQ(cells_of(cut_one(pin({{2.5, 2.5}, {4.0, 4.0}}))), (Cells{{2, 2}, {3, 3}}));
  EXPECT_EQ(cells_of(cut_one(pin({{4.0, 4.0}, {2.5, 2.5}}))), (Cells{{2, 2}, {3, 3}}));
  EXPECT_EQ(cells_of(cut_one(pin({{2.5, 2.5}, {3.0, 2.5}}))), (Cells{{2, 2}}));
}

TEST(GridCutCells, ACurveInsideACellHasOneCutWithoutLinks) {
  const CutCells cuts = cut_one(pin({{3.2, 3.2}, {3.7, 3.4}, {3.3, 3.9}}));
  EXPECT_EQ(cells_of(cuts), (Cells{{3, 3}}));
  EXPECT_TRUE(cuts.link.empty());
}

TEST(GridCutCells, AStayShorterThanAThousandthIsDropped) {
  EXPECT_EQ(cut_one(pin({{3.5, 3.5}, {3.5009, 3.5}})).size(), 0);
  EXPECT_EQ(cut_one(pin({{3.5, 3.5}, {3.5011, 3.5}})).size(), 1);
  const CutCells cuts = cut_one(pin({{2.5, 2.5}, {3.0005, 2.5}}));
  EXPECT_EQ(cells_of(cuts), (Cells{{2, 2}}));
}

TEST(GridCutCells, TheFixedBoundaryAloneMakesNoRow) {
  for (const auto& points :
       std::vector<std::vector<Point>>{{{0, 1}, {0, 8}},
                                       {{12, 1}, {12, 8}},
                                       {{1, 0}, {11, 0}},
                                       {{1, 9}, {11, 9}},
                                       {{0, 0}, {12, 0}, {12, 9}, {0, 9}, {0, 0}}})
    EXPECT_EQ(cut_one(pin(points)).size(), 0);
}

TEST(GridCutCells, NodesOnTheFixedBoundaryHaveNoWeight) {
  const CutCells cuts =
      cut_one(pin({{0.5, 0.5}, {11.5, 0.5}, {11.5, 8.5}, {0.5, 8.5}, {0.5, 0.5}}));
  const Cells cells = cells_of(cuts);
  ASSERT_EQ(cells.size(), 2u * 12 + 2 * 7);
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (int n = 0; n < 4; ++n) {
      const int x = cells[k].first + (n & 1), y = cells[k].second + (n >> 1);
      const bool fixed = x == 0 || x == 12 || y == 0 || y == 9;
      EXPECT_EQ(cuts.weight[k][std::size_t(n)] == 0.0, fixed) << x << ' ' << y;
    }
}

TEST(GridCutCells, ARowThatTheBoundaryHoldsAllBut2PercentIsDropped) {
  // At (x, x) in the corner cell the only free node has the weight x².
  EXPECT_EQ(cut_one(pin({{0.13, 0.13}, {0.14, 0.14}})).size(), 0);
  EXPECT_EQ(cut_one(pin({{0.15, 0.15}, {0.16, 0.16}})).size(), 1);
}

TEST(GridCutCells, CurvesInOneCellShareItsRow) {
  const CurvePair a = pin({{3.1, 3.5}, {3.9, 3.5}}), b = pin({{3.5, 3.1}, {3.5, 3.5}});
  const CutCells cuts = cut({a, b}, unit_lattice(12, 9), kInfinity);
  ASSERT_EQ(cells_of(cuts), (Cells{{3, 3}}));
  EXPECT_NEAR(cuts.length[0], 0.8 + 0.4, 1e-12);
  const Point mean = mean_point(cuts, 0, {3, 3});
  EXPECT_NEAR(mean.x, (0.8 * 3.5 + 0.4 * 3.5) / 1.2, 1e-12);
  EXPECT_NEAR(mean.y, (0.8 * 3.5 + 0.4 * 3.3) / 1.2, 1e-12);
}

TEST(GridCutCells, CellsThatFollowOneAnotherAreLinkedBothWays) {
  const CutCells cuts = cut_one(pin({{2.5, 2.5}, {4.5, 2.5}, {4.5, 3.5}}));
  const std::pair a{2, 2}, b{3, 2}, c{4, 2}, d{4, 3};
  EXPECT_EQ(links_of(cuts), (std::set<CellPair>{{a, b}, {b, a}, {b, c}, {c, b}, {c, d}, {d, c}}));
}

TEST(GridCutCells, AClosedCurvesCutsFormARing) {
  const CutCells cuts = cut_one(pinned(round({6.1, 4.4}, 2.7)));
  ASSERT_GT(cuts.size(), 8);
  for (std::size_t k = 0; k < cuts.column.size(); ++k)
    EXPECT_EQ(cuts.link_begin[k + 1] - cuts.link_begin[k], 2) << cuts.column[k];
}

TEST(GridCutCells, WhereAClosedCurveStartsMakesNoDifference) {
  const auto chain = round({6.1, 4.4}, 2.7);
  const CutCells from_right = cut_one(pinned(chain));
  const CutCells from_left = cut_one(pinned({chain[2], chain[3], chain[0], chain[1]}));
  EXPECT_EQ(cells_of(from_left), cells_of(from_right));
  EXPECT_EQ(links_of(from_left), links_of(from_right));
  for (std::size_t k = 0; k < from_left.length.size(); ++k)
    EXPECT_NEAR(from_left.length[k], from_right.length[k], 1e-12);
}

TEST(GridCutCells, ReversingACurveMakesNoDifference) {
  const CutCells there = cut_one(pin({{1.5, 1.5}, {10.5, 7.2}, {2.2, 6.9}}));
  const CutCells back = cut_one(pin({{2.2, 6.9}, {10.5, 7.2}, {1.5, 1.5}}));
  ASSERT_EQ(cells_of(there), cells_of(back));
  EXPECT_EQ(links_of(there), links_of(back));
  for (std::size_t k = 0; k < there.length.size(); ++k)
    for (std::size_t n = 0; n < 4; ++n) EXPECT_NEAR(there.weight[k][n], back.weight[k][n], 1e-12);
}

TEST(GridCutCells, ASoftCurveHasItsStiffnessPerLength) {
  CurvePair curve = pin({{2.5, 2.5}, {5.5, 3.5}});
  curve.weight = 240.0;  // per longer side: 20 per cell of a lattice of 12
  const CutCells cuts = cut_one(curve);
  for (std::size_t k = 0; k < cuts.length.size(); ++k)
    EXPECT_NEAR(1.0 / cuts.compliance[k], 20.0 * cuts.length[k], 1e-9);
}

TEST(GridCutCells, AHardCurveHasNoCompliance) {
  for (const double compliance : cut_one(pin({{2.5, 2.5}, {5.5, 3.5}})).compliance)
    EXPECT_EQ(compliance, 0.0);
}

TEST(GridCutCells, TheLargestWeightCapsHardCurvesToo) {
  const CutCells cuts = cut({pin({{2.5, 2.5}, {5.5, 3.5}})}, unit_lattice(12, 9), 1200.0);
  for (std::size_t k = 0; k < cuts.length.size(); ++k)
    EXPECT_NEAR(1.0 / cuts.compliance[k], 100.0 * cuts.length[k], 1e-9);
}

TEST(GridCutCells, AHardCurveHardensTheSoftOnesInItsCell) {
  CurvePair soft = pin({{3.1, 3.5}, {3.9, 3.5}});
  soft.weight = 10.0;
  const CutCells cuts = cut({soft, pin({{3.5, 3.1}, {3.5, 3.5}})}, unit_lattice(12, 9), kInfinity);
  EXPECT_EQ(cuts.compliance, std::vector<double>{0.0});
}

TEST(GridCutCells, NoCurvesMakeNoCuts) {
  const CutCells cuts = cut({}, unit_lattice(12, 9), kInfinity);
  EXPECT_EQ(cuts.size(), 0);
  EXPECT_EQ(cuts.row_begin, std::vector<int>(10, 0));
}

TEST(GridCutCells, ASourceThatLeavesTheLatticeIsRefusedByNameAndPlace) {
  const Lattice lattice{.nx = 12, .ny = 9, .cell_px = 10.0, .origin_px = {-20, 0}, .side_px = 100};
  CurvePair curve = pin({{50, 50}, {130, 50}});
  curve.name = "brow";
  const std::string text = tests::refusal([&] { (void)cut({curve}, lattice, kInfinity); });
  EXPECT_TRUE(text.starts_with("curve 'brow': the source leaves the lattice at (")) << text;
  EXPECT_TRUE(text.ends_with("reaches from (-20.000000, 0.000000) to (100.000000, 90.000000)"))
      << text;
}

TEST(GridCutCells, EverySideIsGuarded) {
  for (const Point out : {Point{-0.5, 4}, Point{12.5, 4}, Point{4, -0.5}, Point{4, 9.5}})
    EXPECT_FALSE(tests::refusal([&] { (void)cut_one(pin({{5, 5}, out})); }).empty());
}

TEST(GridCutCells, ATargetMayLeaveTheLattice) {
  CurvePair curve = pin({{5, 5}, {7, 5}});
  curve.target = polyline({{50, 50}, {70, 50}});
  EXPECT_GT(cut_one(curve).size(), 0);
}

TEST(GridCutCells, AWeightThatIsNotPositiveIsRefused) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CurvePair curve = pin({{5, 5}, {7, 5}});
    curve.weight = bad;
    const std::string text = tests::refusal([&] { (void)cut_one(curve); });
    EXPECT_TRUE(text.starts_with("curve 'pin': weight = ")) << text;
    EXPECT_TRUE(text.ends_with("must be positive (infinity allowed)")) << text;
  }
}

}  // namespace
}  // namespace drumhead::grid
