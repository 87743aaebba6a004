// SPDX-License-Identifier: MIT
// Cut cells aggregated to coarser lattices: what the children add up to, at even and odd counts
// (where the last coarse cell overhangs the fixed edge), level after level.
#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/cut_checks.h"

namespace drumhead::grid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<CurvePair> curves(double weight) {
  const CubicBezier bow{{{{1.3, 2.2}, {22.1, 28.7}, {2.4, 19.4}, {30.6, 1.7}}}};
  std::vector<CurvePair> all{pinned({bow}), pinned(round({14.1, 11.4}, 7.7)),
                             pin({{0.2, 0.3}, {32.9, 20.9}})};
  for (CurvePair& curve : all) {
    curve.weight = weight;
    for (CubicBezier& segment : curve.target)
      for (Point& p : segment.control) p = {p.y + 0.1 * p.x, 2.0 - p.x};
  }
  return all;
}

/// body(fine, nx, ny, coarse) for each level below lattices of even and odd counts.
template <class F>
void for_levels(F&& body, double weight = kInfinity) {
  for (auto [nx, ny] : {std::pair{33, 21}, {36, 24}, {40, 27}, {64, 64}}) {
    CutCells fine = cut(curves(weight), unit_lattice(nx, ny), kInfinity);
    while (std::min(nx, ny) > 3) {
      SCOPED_TRACE(std::to_string(nx) + " x " + std::to_string(ny));
      CoarseCuts coarse = coarsen(fine, nx, ny);
      body(fine, nx, ny, coarse);
      fine = std::move(coarse.cuts);
      nx = coarse_cells(nx);
      ny = coarse_cells(ny);
    }
  }
}

TEST(GridCoarsen, EachCutGoesToTheCellThatCoversIt) {
  for_levels([](const CutCells& fine, int, int, const CoarseCuts& coarse) {
    const auto children = cells_of(fine), parents = cells_of(coarse.cuts);
    ASSERT_EQ(coarse.parent.size(), children.size());
    for (std::size_t k = 0; k < children.size(); ++k) {
      if (coarse.parent[k] < 0) continue;
      const auto [i, j] = children[k];
      EXPECT_EQ(parents[std::size_t(coarse.parent[k])], std::pair(i / 2, j / 2));
    }
  });
}

TEST(GridCoarsen, LengthsOfTheChildrenAddUp) {
  for_levels([](const CutCells& fine, int, int, const CoarseCuts& coarse) {
    std::vector<double> sum(coarse.cuts.length.size());
    for (std::size_t k = 0; k < coarse.parent.size(); ++k)
      if (coarse.parent[k] >= 0) sum[std::size_t(coarse.parent[k])] += fine.length[k];
    for (std::size_t p = 0; p < sum.size(); ++p)
      EXPECT_NEAR(sum[p], coarse.cuts.length[p], 1e-12 * sum[p]);
  });
}

TEST(GridCoarsen, LengthTimesWantedOfTheChildrenAddsUp) {
  for_levels([](const CutCells& fine, int, int, const CoarseCuts& coarse) {
    std::vector<Point> sum(coarse.cuts.length.size());
    for (std::size_t k = 0; k < coarse.parent.size(); ++k) {
      if (coarse.parent[k] < 0) continue;
      Point& of_parent = sum[std::size_t(coarse.parent[k])];
      of_parent = of_parent + fine.length[k] * fine.wanted[k];
    }
    for (std::size_t p = 0; p < sum.size(); ++p) {
      const Point expected = coarse.cuts.length[p] * coarse.cuts.wanted[p];
      EXPECT_NEAR(sum[p].x, expected.x, 1e-10);
      EXPECT_NEAR(sum[p].y, expected.y, 1e-10);
    }
  });
}

TEST(GridCoarsen, SharesAreLengthsRelativeToTheParent) {
  for_levels([](const CutCells& fine, int, int, const CoarseCuts& coarse) {
    for (std::size_t k = 0; k < coarse.parent.size(); ++k) {
      const int p = coarse.parent[k];
      const double expected = p < 0 ? 0.0 : fine.length[k] / coarse.cuts.length[std::size_t(p)];
      EXPECT_NEAR(coarse.share[k], expected, 1e-14);
    }
  });
}

/// Coarse node values, 0 on the coarse boundary, and their bilinear interpolation at fine nodes.
class CoarseNodes {
 public:
  CoarseNodes(int nx, int ny) : nx_(nx), values_(std::size_t(nx + 1) * std::size_t(ny + 1)) {
    std::mt19937 random(5);
    for (int j = 1; j < ny; ++j)
      for (int i = 1; i < nx; ++i) at(i, j) = double(random()) / double(std::mt19937::max()) - 0.5;
  }
  double& at(int i, int j) { return values_[std::size_t(j * (nx_ + 1) + i)]; }
  double at_fine(int i, int j) {
    double sum = 0.0;
    for (const int J : {j / 2, (j + 1) / 2})
      for (const int I : {i / 2, (i + 1) / 2}) sum += 0.25 * at(I, J);
    return sum;
  }

 private:
  int nx_;
  std::vector<double> values_;
};

template <class Value>
double mean_value(const CutCells& cuts, std::size_t k, std::pair<int, int> cell, Value&& value) {
  double sum = 0.0;
  for (int n = 0; n < 4; ++n) {
    const double at_corner = value(cell.first + (n & 1), cell.second + (n >> 1));
    sum += cuts.weight[k][std::size_t(n)] * at_corner;
  }
  return sum;
}

// len·W of the children, applied to an interpolated coarse field, is len·W of the parent.
TEST(GridCoarsen, LengthTimesWeightsOfTheChildrenAddUp) {
  for_levels([](const CutCells& fine, int nx, int ny, const CoarseCuts& coarse) {
    CoarseNodes v(coarse_cells(nx), coarse_cells(ny));
    std::vector<double> sum(coarse.cuts.length.size());
    const auto children = cells_of(fine), parents = cells_of(coarse.cuts);
    for (std::size_t k = 0; k < children.size(); ++k) {
      if (coarse.parent[k] < 0) continue;
      const auto value = [&](int i, int j) { return v.at_fine(i, j); };
      sum[std::size_t(coarse.parent[k])] +=
          fine.length[k] * mean_value(fine, k, children[k], value);
    }
    for (std::size_t p = 0; p < parents.size(); ++p) {
      const auto value = [&](int i, int j) { return v.at(i, j); };
      EXPECT_NEAR(sum[p], coarse.cuts.length[p] * mean_value(coarse.cuts, p, parents[p], value),
                  1e-11);
    }
  });
}

TEST(GridCoarsen, WeightsSumToOneAwayFromTheBoundary) {
  for_levels([](const CutCells&, int nx, int ny, const CoarseCuts& coarse) {
    const auto cells = cells_of(coarse.cuts);
    for (std::size_t p = 0; p < cells.size(); ++p) {
      const auto [i, j] = cells[p];
      // A child at the fixed edge has already lost weights, so a parent next to it is short too.
      if (i < 1 || j < 1 || 2 * i + 3 > nx || 2 * j + 3 > ny) continue;
      EXPECT_NEAR(weight_sum(coarse.cuts, p), 1.0, 1e-11);
    }
  });
}

TEST(GridCoarsen, NodesOnTheCoarseBoundaryHaveNoWeight) {
  for_levels([](const CutCells&, int nx, int ny, const CoarseCuts& coarse) {
    const auto cells = cells_of(coarse.cuts);
    for (std::size_t p = 0; p < cells.size(); ++p)
      for (int n = 0; n < 4; ++n) {
        const int x = cells[p].first + (n & 1), y = cells[p].second + (n >> 1);
        const double w = coarse.cuts.weight[p][std::size_t(n)];
        const bool fixed = x == 0 || y == 0 || x == coarse_cells(nx) || y == coarse_cells(ny);
        EXPECT_TRUE(!fixed || w == 0.0) << x << ' ' << y;
      }
  });
}

// With q_c = share·q_p, ½ |q|² 1/(d len) of the children is that of the parent.
TEST(GridCoarsen, ComplianceIsThatOfAConstantTraction) {
  for_levels(
      [](const CutCells& fine, int, int, const CoarseCuts& coarse) {
        std::vector<double> sum(coarse.cuts.length.size());
        for (std::size_t k = 0; k < coarse.parent.size(); ++k)
          if (coarse.parent[k] >= 0)
            sum[std::size_t(coarse.parent[k])] +=
                coarse.share[k] * coarse.share[k] * fine.compliance[k];
        for (std::size_t p = 0; p < sum.size(); ++p)
          EXPECT_NEAR(coarse.cuts.compliance[p] / sum[p], 1.0, 1e-12);
      },
      300.0);
}

TEST(GridCoarsen, OnlyWhatTheFixedBoundaryHoldsIsDropped) {
  for_levels([](const CutCells& fine, int nx, int ny, const CoarseCuts& coarse) {
    const auto cells = cells_of(fine);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (coarse.parent[k] >= 0) continue;
      const auto [i, j] = cells[k];
      const int I = i / 2, J = j / 2;
      EXPECT_TRUE(I == 0 || J == 0 || I + 1 == coarse_cells(nx) || J + 1 == coarse_cells(ny));
    }
  });
}

TEST(GridCoarsen, ParentsAreLinkedWhereTheirChildrenAre) {
  for_levels([](const CutCells& fine, int, int, const CoarseCuts& coarse) {
    const auto parents = cells_of(coarse.cuts);
    std::set<CellPair> expected;
    for (std::size_t k = 0; k < coarse.parent.size(); ++k)
      for (int l = fine.link_begin[k]; l < fine.link_begin[k + 1]; ++l) {
        const int p = coarse.parent[k];
        const int q = coarse.parent[std::size_t(fine.link[std::size_t(l)])];
        if (p >= 0 && q >= 0 && p != q)
          expected.insert({parents[std::size_t(p)], parents[std::size_t(q)]});
      }
    EXPECT_EQ(links_of(coarse.cuts), expected);
    EXPECT_EQ(coarse.cuts.link.size(), expected.size());
  });
}

}  // namespace
}  // namespace drumhead::grid
