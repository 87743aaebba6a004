// SPDX-License-Identifier: MIT
// Folds counted row by row, against J by finite differences of the bilinear map.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/folds.h>
#include <drumhead/kernels/threads.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using kernels::RowFolds;

/// A lattice whose nodes are moved at random, by up to `size` cells.
struct Warped {
  int nx, ny;
  double h = 2.5;
  std::vector<double> u, v;
  std::vector<int> row_begin, column;  ///< of cells to be left out

  Warped(int nx_, int ny_, double size, unsigned seed) : nx(nx_), ny(ny_) {
    fields::Random random(seed);
    const std::size_t nodes = std::size_t(nx + 1) * std::size_t(ny + 1);
    for (std::size_t n = 0; n < nodes; ++n) {
      u.push_back(h * random.number(-size, size));
      v.push_back(h * random.number(-size, size));
    }
  }
  kernels::LatticeMapView view() const {
    kernels::LatticeMapView map{
        .u = u.data(), .v = v.data(), .nx = nx, .ny = ny, .cell_px = h, .origin_px = {}};
    if (!row_begin.empty()) map.split = {row_begin.data(), column.data(), nullptr, nullptr};
    return map;
  }
  /// Where the point (s, t) of cell (i, j), in its cells, is taken.
  std::array<double, 2> at(int i, int j, double s, double t) const {
    std::array<double, 2> to{h * (i + s), h * (j + t)};
    for (int n = 0; n < 4; ++n) {
      const std::size_t node =
          std::size_t(j + n / 2) * std::size_t(nx + 1) + std::size_t(i + n % 2);
      const double weight = (n % 2 ? s : 1.0 - s) * (n / 2 ? t : 1.0 - t);
      to[0] += weight * u[node];
      to[1] += weight * v[node];
    }
    return to;
  }
  /// The map is linear along s and along t, so that differences are its derivatives.
  double J(int i, int j, double s, double t) const {
    const auto west = at(i, j, 0.0, t), east = at(i, j, 1.0, t);
    const auto south = at(i, j, s, 0.0), north = at(i, j, s, 1.0);
    return ((east[0] - west[0]) * (north[1] - south[1]) -
            (east[1] - west[1]) * (north[0] - south[0])) /
           (h * h);
  }
  RowFolds counted(int j) const {
    RowFolds row;
    for (int i = 0; i < nx; ++i) {
      if (!row_begin.empty() && std::count(column.begin() + row_begin[std::size_t(j)],
                                           column.begin() + row_begin[std::size_t(j) + 1], i) > 0)
        continue;
      const double centre = J(i, j, 0.5, 0.5);
      const double corner =
          std::min(std::min(J(i, j, 0, 0), J(i, j, 1, 0)), std::min(J(i, j, 0, 1), J(i, j, 1, 1)));
      row.least_J = std::min(row.least_J, centre);
      row.least_corner_J = std::min(row.least_corner_J, corner);
      row.inverted += centre < 0.0;
      row.folded += corner < 0.0;
    }
    return row;
  }
};

void expect_counts(const Warped& warped) {
  const std::vector<RowFolds> rows = kernels::count_folds(warped.view());
  ASSERT_EQ(rows.size(), std::size_t(warped.ny));
  for (int j = 0; j < warped.ny; ++j) {
    const RowFolds row = rows[std::size_t(j)], wanted = warped.counted(j);
    EXPECT_EQ(row.inverted, wanted.inverted);
    EXPECT_EQ(row.folded, wanted.folded);
    EXPECT_NEAR(row.least_J, wanted.least_J, 1e-13);
    EXPECT_NEAR(row.least_corner_J, wanted.least_corner_J, 1e-13);
  }
}

TEST(KernelsFolds, CountsWhatTheBilinearMapFolds) {
  fields::on_every_isa([] {
    for (const int nx : {1, 2, 7, 8, 9, 16, 31, 255, 256, 300})
      expect_counts(Warped(nx, 3, 0.8, unsigned(nx)));
  });
}

TEST(KernelsFolds, LeavesSplitCellsOut) {
  fields::on_every_isa([] {
    Warped warped(300, 2, 0.8, 5);
    warped.row_begin = {0, 4, 5};
    warped.column = {0, 7, 256, 299, 12};
    expect_counts(warped);
  });
}

TEST(KernelsFolds, FindsNoneAtRest) {
  fields::on_every_isa([] {
    Warped warped(9, 2, 0.0, 1);
    for (const RowFolds& row : kernels::count_folds(warped.view())) {
      EXPECT_EQ(row.inverted + row.folded, 0);
      EXPECT_EQ(row.least_J, 1.0);
      EXPECT_EQ(row.least_corner_J, 1.0);
    }
  });
}

TEST(KernelsFolds, ACellOfNoAreaOrWithoutANumberIsNone) {
  fields::on_every_isa([] {
    Warped flat(9, 1, 0.0, 1);  // its upper nodes on the lower ones
    for (std::size_t n = 10; n < 20; ++n) flat.v[n] = -flat.h;
    const RowFolds of_flat = kernels::count_folds(flat.view()).front();
    EXPECT_EQ(of_flat.inverted + of_flat.folded, 0);
    EXPECT_EQ(of_flat.least_corner_J, 0.0);
    Warped broken(9, 1, 0.0, 1);
    broken.u[3] = std::numeric_limits<double>::quiet_NaN();
    const RowFolds of_broken = kernels::count_folds(broken.view()).front();
    EXPECT_EQ(of_broken.inverted + of_broken.folded, 0);
    EXPECT_EQ(of_broken.least_J, 1.0);
  });
}

TEST(KernelsFolds, HaveTheBitsOfOneThread) {
  const Warped warped(700, 400, 0.6, 3);
  std::vector<RowFolds> rows[2];
  for (const int threads : {1, 2}) {
    const kernels::ThreadLimit limit(threads);
    rows[threads - 1] = kernels::count_folds(warped.view());
  }
  for (std::size_t j = 0; j < rows[0].size(); ++j) {
    ASSERT_EQ(rows[0][j].least_J, rows[1][j].least_J);
    ASSERT_EQ(rows[0][j].least_corner_J, rows[1][j].least_corner_J);
    ASSERT_EQ(rows[0][j].inverted, rows[1][j].inverted);
    ASSERT_EQ(rows[0][j].folded, rows[1][j].folded);
  }
}

}  // namespace
}  // namespace drumhead
