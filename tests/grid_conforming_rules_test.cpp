// SPDX-License-Identifier: MIT
// Each rule of the conforming cells on lattices that can be drawn on paper.
#include <limits>

#include <gtest/gtest.h>

#include "support/conform_checks.h"
#include "support/random_curves.h"
#include "support/refusal.h"

namespace drumhead::grid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CurvePair carried(CurvePair curve, Point by) {
  for (CubicBezier& segment : curve.target)
    for (Point& p : segment.control) p = p + by;
  return curve;
}
CurvePair bow() {
  return pinned({CubicBezier{{{{1.3, 2.2}, {9.1, 8.7}, {2.4, 9.4}, {10.6, 1.7}}}}});
}
CurvePair soft(CurvePair curve, double weight) {
  curve.weight = weight;
  return curve;
}
void expect_near(Point a, Point b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(GridConformingRules, ANodeWithinTheSnapMovesOntoTheCurveAndOthersStay) {
  const ConformingCells cells =
      conform({pin({{0.0, 2.2}, {4.0, 2.2}})}, unit_lattice(4, 4), {.snap = 0.25});
  ASSERT_EQ(cells.node.size(), 3u);
  for (int i = 1; i <= 3; ++i) {
    const int held = cells.find_node(i, 2);
    ASSERT_GE(held, 0);
    expect_near(cells.node[std::size_t(held)].rest, {double(i), 2.2}, 1e-12);
  }
  // Nodes of the outer boundary never move: curve nodes instead, at rest for ever.
  ASSERT_EQ(cells.curve_node.size(), 2u);
  for (const HeldNode& node : cells.curve_node) {
    EXPECT_NEAR(node.rest.y, 2.2, 1e-12);
    EXPECT_EQ(node.stiffness, kInfinity);
  }
  EXPECT_EQ(wrong_tiling(cells), "");
}

TEST(GridConformingRules, CrossingsFartherThanTheSnapBecomeCurveNodes) {
  const ConformingCells cells =
      conform({pin({{0.0, 2.3}, {4.0, 2.3}})}, unit_lattice(4, 4), {.snap = 0.25});
  EXPECT_TRUE(cells.node.empty());
  EXPECT_EQ(cells.curve_node.size(), 5u);
  for (const NodePlace place : cells.curve_place) EXPECT_EQ(place, NodePlace::on_y_edge);
}

TEST(GridConformingRules, ACurveOnALatticeLineLeavesAllCellsRegular) {
  const ConformingCells cells = conform({pin({{2.0, 1.0}, {2.0, 5.0}})}, unit_lattice(6, 6));
  EXPECT_EQ(cells.cells(), 0);
  EXPECT_EQ(cells.node.size(), 5u);
}

TEST(GridConformingRules, TwoCrossingsOfOneEdgeCancel) {
  // A bump of .1 over the line y = 2 in the middle of one edge.
  const ConformingCells cells = conform(
      {pin({{0.5, 1.5}, {2.3, 1.5}, {2.5, 2.1}, {2.7, 1.5}, {5.5, 1.5}})}, unit_lattice(6, 6));
  for (std::size_t k = 0; k < cells.curve_node.size(); ++k)
    EXPECT_NE(cells.curve_place[k], NodePlace::on_x_edge);
}

TEST(GridConformingRules, ATipMovesTheNearestInnerNode) {
  const ConformingCells cells = conform({pin({{1.6, 2.55}, {4.3, 2.55}})}, unit_lattice(6, 6));
  EXPECT_TRUE(cells.lost_tips.empty());
  const int left = cells.find_node(2, 3), right = cells.find_node(4, 3);
  ASSERT_GE(left, 0);
  ASSERT_GE(right, 0);
  expect_near(cells.node[std::size_t(left)].rest, {1.6, 2.55}, 1e-12);
  expect_near(cells.node[std::size_t(right)].rest, {4.3, 2.55}, 1e-12);
}

TEST(GridConformingRules, ASharpCornerIsANode) {
  const ConformingCells cells =
      conform({pin({{1.2, 1.3}, {4.4, 1.4}, {4.6, 4.7}})}, unit_lattice(6, 6));
  bool found = false;
  for (const HeldNode& node : cells.node) found |= length(node.rest - Point{4.4, 1.4}) < 1e-12;
  EXPECT_TRUE(found);
}

TEST(GridConformingRules, ACurveThatCrossesNothingHoldsOneNode) {
  for (const CurvePair& curve : {pinned(round({2.6, 3.3}, 0.2)), pinned(round({3.1, 2.9}, 0.05))}) {
    const ConformingCells cells = conform({carried(curve, {0.5, 0.25})}, unit_lattice(6, 6));
    ASSERT_EQ(cells.node.size(), 1u);
    EXPECT_TRUE(cells.curve_node.empty());
    expect_near(cells.node[0].wanted, {0.5, 0.25}, 1e-9);
  }
}

TEST(GridConformingRules, EveryNodeWantsWhatItsCurveWants) {
  const auto map = [](Point p) { return Point{1.3 * p.x - 0.4 * p.y, 0.2 * p.x + 0.9 * p.y + 1}; };
  for (CurvePair curve : {pinned(round({6.1, 4.4}, 2.7)), pin({{1.5, 1.5}, {10.5, 7.2}}), bow()}) {
    for (CubicBezier& segment : curve.target)
      for (Point& p : segment.control) p = map(p);
    const ConformingCells cells = conform({curve}, unit_lattice(12, 10));
    for (const auto* nodes : {&cells.node, &cells.curve_node})
      for (const HeldNode& node : *nodes)
        expect_near(node.rest + node.wanted, map(node.rest), 1e-9);
  }
}

TEST(GridConformingRules, CurvesThatCrossInACellMeetInANode) {
  const std::vector<CurvePair> curves{carried(pin({{0.7, 2.3}, {5.3, 2.7}}), {0.25, 0.0}),
                                      carried(pin({{2.4, 0.7}, {2.7, 5.3}}), {0.25, 0.0})};
  const ConformingCells cells = conform(curves, unit_lattice(6, 6));
  const auto inside = std::ranges::find(cells.curve_place, NodePlace::in_cell);
  ASSERT_NE(inside, cells.curve_place.end());
  const std::size_t k = std::size_t(inside - cells.curve_place.begin());
  EXPECT_EQ(cells.curve_cell[k], (std::array<int, 2>{2, 2}));
  expect_near(cells.curve_node[k].wanted, {0.25, 0.0}, 1e-12);
  const int c = cells.find_cell(2, 2);
  EXPECT_EQ(cells.part_begin[std::size_t(c) + 1] - cells.part_begin[std::size_t(c)], 4);
  EXPECT_TRUE(cells.conflicts.empty());
}

TEST(GridConformingRules, ContradictingTargetsGiveTheirMeanAndAreKept) {
  const CurvePair line = pin({{1.3, 2.4}, {4.6, 2.45}});
  const ConformingCells cells =
      conform({carried(line, {0.0, 0.5}), carried(line, {0.0, -0.1})}, unit_lattice(6, 5));
  for (const auto* nodes : {&cells.node, &cells.curve_node})
    for (const HeldNode& node : *nodes) expect_near(node.wanted, {0.0, 0.2}, 1e-12);
  ASSERT_EQ(cells.conflicts.size(), cells.node.size() + cells.curve_node.size());
  for (const HeldConflict& conflict : cells.conflicts) {
    EXPECT_NEAR(conflict.distance, 0.6, 1e-12);
    EXPECT_NE(conflict.curve, conflict.other_curve);
  }
}

TEST(GridConformingRules, AHardCurveRulesOverASoftOne) {
  const CurvePair line = pin({{1.3, 2.4}, {4.6, 2.45}});
  const ConformingCells cells = conform(
      {soft(carried(line, {0.0, 0.5}), 10.0), carried(line, {0.0, -0.1})}, unit_lattice(6, 5));
  for (const auto* nodes : {&cells.node, &cells.curve_node})
    for (const HeldNode& node : *nodes) {
      EXPECT_EQ(node.stiffness, kInfinity);
      expect_near(node.wanted, {0.0, -0.1}, 1e-12);
    }
}

TEST(GridConformingRules, DuplicatesDoNotContradictThemselves) {
  const CurvePair curve = carried(bow(), {1.0, 2.0});
  const ConformingCells one = conform({curve}, unit_lattice(12, 10)),
                        two = conform({curve, curve}, unit_lattice(12, 10));
  EXPECT_TRUE(two.conflicts.empty());
  EXPECT_EQ(one.parts(), two.parts());
  EXPECT_EQ(one.triangle.size(), two.triangle.size());
}

TEST(GridConformingRules, SpringsShareOutTheLengthOfASoftCurve) {
  const Lattice lattice{.nx = 12, .ny = 10, .cell_px = 8.0, .side_px = 96.0};
  CurvePair curve = soft(pinned(round({48.3, 40.1}, 21.0)), 60.0);
  const ConformingCells cells = conform({curve}, lattice);
  double sum = 0.0;
  for (const auto* nodes : {&cells.node, &cells.curve_node})
    for (const HeldNode& node : *nodes) sum += node.stiffness;
  // d in mu per side: 60/96 mu per px; lengths in px, energies per cell².
  EXPECT_NEAR(sum, 60.0 / 96.0 * arc_length(curve.source), 1e-6 * sum);
}

TEST(GridConformingRules, ACurveAgainstTheBoundaryIsAConflictThere) {
  const ConformingCells cells =
      conform({carried(pin({{0.0, 2.5}, {3.5, 2.5}}), {0.5, 0.0})}, unit_lattice(5, 5));
  ASSERT_EQ(cells.conflicts.size(), 1u);
  EXPECT_NEAR(cells.conflicts[0].distance, 0.5, 1e-12);
  EXPECT_EQ(cells.conflicts[0].rest.x, 0.0);
}

TEST(GridConformingRules, CoarserLatticesReachOverTheEdgeAndHoldTheSameCurves) {
  Lattice lattice{.nx = 13, .ny = 9, .cell_px = 4.0, .origin_px = {-3.0, 2.0}, .side_px = 52.0};
  CurvePair curve = carried(pinned(round({24.0, 20.0}, 11.0)), {3.0, -2.0});
  while (lattice.nx > 2) {
    lattice = coarsened(lattice);
    const ConformingCells cells = conform({curve}, lattice);
    EXPECT_EQ(wrong_tiling(cells), "");
    EXPECT_EQ(wrong_triangles(cells), "");
    for (const HeldNode& node : cells.node)
      expect_near(lattice.cell_px * node.wanted, {3.0, -2.0}, 1e-9);
  }
  EXPECT_EQ(lattice.nx, 2);
  EXPECT_EQ(lattice.ny, 2);
}

TEST(GridConformingRules, PartsAreFoundByTheirPoints) {
  const ConformingCells cells = conform({pinned(round({4.2, 4.3}, 2.6))}, unit_lattice(9, 9));
  for_parts(cells, [&](int c, int, int p) {
    for (int t = cells.part_triangle_begin[std::size_t(p)];
         t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
      const PartTriangle& tri = cells.triangle[std::size_t(t)];
      const int first = cells.part_node_begin[std::size_t(p)];
      const int j =
          int(std::ranges::upper_bound(cells.cell_begin, c) - cells.cell_begin.begin()) - 1;
      Point centre;
      for (const int n : tri.node)
        centre = centre + (1.0 / 3.0) * cells.rest(c, j, cells.part_node[std::size_t(first + n)]);
      EXPECT_EQ(cells.part_at(c, j, centre), p);
    }
  });
}

TEST(GridConformingRules, BadInputIsRefusedByName) {
  const Lattice lattice = unit_lattice(5, 5);
  EXPECT_NE(tests::refusal([&] {
              (void)conform({soft(pin({{1, 1}, {2, 2}}), 0.0)}, lattice);
            }).find("'pin': weight = 0"),
            std::string::npos);
  EXPECT_NE(tests::refusal([&] {
              (void)conform({pin({{1, 1}, {7, 2}})}, lattice);
            }).find("leaves the lattice"),
            std::string::npos);
  EXPECT_NE(tests::refusal([&] { (void)conform({}, lattice, {.snap = 0.3}); }).find("snap = 0.3"),
            std::string::npos);
}

}  // namespace
}  // namespace drumhead::grid
