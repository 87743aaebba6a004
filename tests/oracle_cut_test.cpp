// SPDX-License-Identifier: MIT
// The oracle's cutting on lattices that can be checked by hand, and against total length.
#include <numbers>

#include <gtest/gtest.h>

#include "support/oracle_cut.h"

namespace drumhead::oracle {
namespace {

using Eigen::Vector2d;

scenes::Scene one_curve(std::vector<Vector2d> source, std::vector<Vector2d> target) {
  return {"hand", {{"curve", std::move(source), std::move(target)}}, {}};
}

TEST(OracleCut, StraightLineGivesMeansOverEachCell) {
  // On a 4 × 4 lattice: from (1.5, 1.5) to (2.5, 1.5) cells, moved up by half a cell.
  const Cuts cuts = cut(one_curve({{.375, .375}, {.625, .375}}, {{.375, .5}, {.625, .5}}), 4);
  ASSERT_EQ(cuts.rows.size(), 2u);
  const CutRow& left = cuts.rows[0];
  EXPECT_EQ(left.i, 1);
  EXPECT_EQ(left.j, 1);
  EXPECT_NEAR(left.length, 0.5, 1e-15);
  EXPECT_NEAR(left.weight[0], 0.125, 1e-15);  // mean of (1 − s)(1 − t) at t = ½ over s in [½, 1]
  EXPECT_NEAR(left.weight[1], 0.375, 1e-15);
  EXPECT_NEAR(left.target.x(), 1.75, 1e-15);
  EXPECT_NEAR(left.target.y(), 2.0, 1e-15);
  ASSERT_EQ(cuts.neighbours.size(), 1u);
  EXPECT_EQ(cuts.neighbours[0], (std::pair{0, 1}));
}

TEST(OracleCut, WeightsReproduceThePositionOfTheCurve) {
  // Bilinear weights hold linear functions: with source = target, b must be W x at rest.
  const scenes::Scene moved = scenes::shift(scenes::kStudyOffset);
  for (const int n : {8, 13, 32}) {
    const scenes::Scene pinned = one_curve(moved.curves[0].source, moved.curves[0].source);
    double length = 0.0;
    for (const CutRow& row : cut(pinned, n).rows) {
      double sum = 0.0, x = 0.0, y = 0.0;
      for (int k = 0; k < 4; ++k) {
        sum += row.weight[std::size_t(k)];
        x += row.weight[std::size_t(k)] * (row.i + k % 2);
        y += row.weight[std::size_t(k)] * (row.j + k / 2);
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_NEAR(x, row.target.x(), 1e-11);
      EXPECT_NEAR(y, row.target.y(), 1e-11);
      length += row.length;
    }
    EXPECT_NEAR(length / (n * 0.2 * std::numbers::pi), 1.0, 1e-5);
  }
}

TEST(OracleCut, ClosedCurveHasAsManyNeighboursAsCells) {
  const Cuts cuts = cut(scenes::shift(scenes::kStudyOffset), 32);
  EXPECT_EQ(cuts.neighbours.size(), cuts.rows.size());
}

TEST(OracleCut, OpenCurveHasOneNeighbourLess) {
  const Cuts cuts = cut(scenes::sponge(scenes::kStudyOffset), 32);
  EXPECT_EQ(cuts.neighbours.size(), cuts.rows.size() - 2);  // two curves
}

TEST(OracleCut, TouchingALatticeLineCutsNoCellBeyondIt) {
  // The leftmost point of S4's circle lies on a line of the 32 × 32 lattice up to rounding.
  for (const CutRow& row : cut(scenes::shift(), 32).rows) {
    EXPECT_GE(row.i, 8);
    EXPECT_GE(row.length, kShortestArc);
  }
}

TEST(OracleCut, CurvesThatCoincideShareOneRowPerCell) {
  scenes::Scene twice = scenes::shift(scenes::kStudyOffset);
  const Cuts once = cut(twice, 16);
  twice.curves.push_back(twice.curves[0]);
  const Cuts both = cut(twice, 16);
  ASSERT_EQ(both.rows.size(), once.rows.size());
  EXPECT_EQ(both.neighbours, once.neighbours);
  for (std::size_t r = 0; r < once.rows.size(); ++r) {
    EXPECT_NEAR(both.rows[r].length, 2.0 * once.rows[r].length, 1e-13);
    EXPECT_NEAR(both.rows[r].weight[2], once.rows[r].weight[2], 1e-13);
  }
}

TEST(OracleCut, RowsOnTheFixedBoundaryAreLeftOut) {
  const Cuts cuts = cut(one_curve({{.3, .002}, {.6, .002}}, {{.3, .002}, {.6, .002}}), 8);
  EXPECT_TRUE(cuts.rows.empty());
}

}  // namespace
}  // namespace drumhead::oracle
