// SPDX-License-Identifier: MIT
// The library's cut cells against the oracle's, which integrates chords exactly by a rule of its
// own.
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <drumhead/grid/cut_cells.h>

#include "support/oracle_cut.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

using CellIndex = std::pair<int, int>;  // (j, i)

std::vector<scenes::Scene> all_scenes(double offset) {
  return {scenes::sponge(offset), scenes::roundabout(90.0, offset),
          scenes::pinch(offset),  scenes::shift(offset),
          scenes::fold(offset),   scenes::many_discs(),
          scenes::turning_discs()};
}

CellIndex cell_of(const grid::CutCells& cuts, int k) {
  int j = 0;
  while (cuts.row_begin[std::size_t(j) + 1] <= k) ++j;
  return {j, cuts.column[std::size_t(k)]};
}

// Where W x at rest is: b counts from there in the library, and from node (0, 0) in the oracle.
Eigen::Vector2d rest_of(const oracle::CutRow& row) {
  Eigen::Vector2d point(0.0, 0.0);
  for (int k = 0; k < 4; ++k) {
    point += row.weight[std::size_t(k)] * Eigen::Vector2d(row.i + k % 2, row.j + k / 2);
  }
  return point;
}

void expect_equal_rows(const grid::CutCells& cuts, const oracle::Cuts& expected) {
  std::map<CellIndex, int> at;
  for (int k = 0; k < cuts.size(); ++k) at[cell_of(cuts, k)] = k;
  ASSERT_EQ(at.size(), expected.rows.size());
  for (const oracle::CutRow& row : expected.rows) {
    ASSERT_TRUE(at.count({row.j, row.i})) << row.i << ", " << row.j;
    const auto k = std::size_t(at[{row.j, row.i}]);
    EXPECT_NEAR(cuts.length[k], row.length, 1e-9 * row.length);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      EXPECT_NEAR(cuts.weight[k][corner], row.weight[corner], 1e-9);
    }
    const Eigen::Vector2d wanted = row.target - rest_of(row);
    EXPECT_NEAR(cuts.wanted[k].x, wanted.x(), 1e-8);
    EXPECT_NEAR(cuts.wanted[k].y, wanted.y(), 1e-8);
    EXPECT_EQ(cuts.compliance[k], 0.0);
  }
}

void expect_equal_links(const grid::CutCells& cuts, const oracle::Cuts& expected) {
  using Link = std::pair<CellIndex, CellIndex>;
  std::set<Link> wanted, found;
  for (const auto& [k, l] : expected.neighbours) {
    const oracle::CutRow &a = expected.rows[std::size_t(k)], &b = expected.rows[std::size_t(l)];
    wanted.insert({{a.j, a.i}, {b.j, b.i}});
    wanted.insert({{b.j, b.i}, {a.j, a.i}});
  }
  for (int k = 0; k < cuts.size(); ++k) {
    for (int l = cuts.link_begin[std::size_t(k)]; l < cuts.link_begin[std::size_t(k) + 1]; ++l) {
      const Link link{cell_of(cuts, k), cell_of(cuts, cuts.link[std::size_t(l)])};
      EXPECT_TRUE(found.insert(link).second) << "a link twice";
    }
  }
  EXPECT_EQ(found, wanted);
}

TEST(GridCut, EqualsTheOracleInEveryScene) {
  for (const double offset : {0.0, scenes::kStudyOffset}) {
    for (const scenes::Scene& scene : all_scenes(offset)) {
      for (const int n : {16, 25, 32, 64, 100}) {
        SCOPED_TRACE(scene.name + " at " + std::to_string(n));
        const multigrid::WarpProblem problem = scenes::problem(scene, n, 1.0);
        const grid::CutCells cuts =
            grid::cut(problem.curves, problem.lattice, std::numeric_limits<double>::infinity());
        const oracle::Cuts expected = oracle::cut(scene, n);
        expect_equal_rows(cuts, expected);
        expect_equal_links(cuts, expected);
      }
    }
  }
}

TEST(GridCut, SoftCurvesHaveTheirComplianceInCells) {
  const int n = 32;
  multigrid::WarpProblem problem = scenes::problem(scenes::shift(), n, 1.0);
  problem.curves[0].weight = 500.0;
  const grid::CutCells cuts = grid::cut(problem.curves, problem.lattice, 1e6);
  for (int k = 0; k < cuts.size(); ++k) {
    const double d_len = 500.0 / n * cuts.length[std::size_t(k)];
    EXPECT_NEAR(cuts.compliance[std::size_t(k)] * d_len, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace drumhead
