// SPDX-License-Identifier: MIT
// The lattice over a picture and its margin, and what it refuses.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <drumhead/grid/lattice.h>

#include "support/refusal.h"

namespace drumhead::grid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(GridLattice, WithoutMarginIsThePictureWhereItsSidesAreWholeCells) {
  const Lattice lattice = make_lattice(1000, 500, {.cells = 64, .margin = 0.0});
  EXPECT_EQ(lattice.nx, 64);
  EXPECT_EQ(lattice.ny, 32);
  EXPECT_EQ(lattice.cell_px, 15.625);
  EXPECT_EQ(lattice.origin_px, Point{});
  EXPECT_EQ(lattice.side_px, 1000.0);
}

TEST(GridLattice, CountsCellsAcrossTheLongerSide) {
  const Lattice upright = make_lattice(300, 900, {.cells = 90, .margin = 0.0});
  EXPECT_EQ(upright.nx, 30);
  EXPECT_EQ(upright.ny, 90);
}

TEST(GridLattice, ASizeOfCellsOverridesTheirNumber) {
  const Lattice lattice = make_lattice(1000, 500, {.cells = 0, .cell_px = 20.0, .margin = 0.0});
  EXPECT_EQ(lattice.nx, 50);
  EXPECT_EQ(lattice.ny, 25);
  EXPECT_EQ(lattice.cell_px, 20.0);
}

TEST(GridLattice, WithoutMarginReachesLessThanACellPastThePicture) {
  for (const double width : {997.0, 1000.0, 1003.0, 1003.3})
    for (const double height : {1.0, 333.0, 999.9}) {
      const Lattice lattice = make_lattice(width, height, {.cell_px = 10.0, .margin = 0.0});
      EXPECT_EQ(lattice.origin_px, Point{});
      const Point end = lattice.rest_px(lattice.nx, lattice.ny);
      EXPECT_GE(end.x, width - 1e-4);
      EXPECT_LT(end.x, width + 10.0);
      EXPECT_GE(end.y, height - 1e-4);
      EXPECT_LT(end.y, height + 10.0);
    }
}

TEST(GridLattice, RoundingDoesNotAddACell) {
  // 1000/3 px cells: the quotient is 3 only up to rounding.
  EXPECT_EQ(make_lattice(1000, 1000, {.cells = 3, .margin = 0.0}).nx, 3);
  EXPECT_EQ(make_lattice(0.3, 0.1, {.cell_px = 0.1, .margin = 0.0}).nx, 3);
}

/// body(lattice, width, height, options) for pictures of many sizes with a margin.
template <class F>
void for_margins(F&& body) {
  for (const double width : {640.0, 1000.0, 4032.0})
    for (const double height : {480.0, 1000.0, 3024.0})
      for (const int cells : {1, 7, 25, 64, 100, 256, 401, 800})
        for (const double margin : {0.01, 0.1, 0.33, 1.0}) {
          const LatticeOptions options{.cells = cells, .margin = margin};
          body(make_lattice(width, height, options), width, height, options);
        }
}

TEST(GridLattice, TheMarginIsAtLeastWhatWasAskedForOnEverySide) {
  for_margins([](const Lattice& lattice, double width, double height, const LatticeOptions& asked) {
    const double margin = asked.margin * std::max(width, height) * (1.0 - 1e-9);
    const Point end = lattice.rest_px(lattice.nx, lattice.ny);
    EXPECT_LE(lattice.origin_px.x, -margin);
    EXPECT_LE(lattice.origin_px.y, -margin);
    EXPECT_GE(end.x, width + margin);
    EXPECT_GE(end.y, height + margin);
  });
}

TEST(GridLattice, TheMarginGrowsUntilBothCountsHalveToLessThan64) {
  for_margins([](const Lattice& lattice, double, double, const LatticeOptions&) {
    int nx = lattice.nx, ny = lattice.ny;
    for (int halvings = 0; halvings < 6 && std::min(nx, ny) >= 64; ++halvings) {
      ASSERT_EQ(nx % 2, 0) << lattice.nx << " x " << lattice.ny;
      ASSERT_EQ(ny % 2, 0) << lattice.nx << " x " << lattice.ny;
      nx /= 2;
      ny /= 2;
    }
  });
}

TEST(GridLattice, TheMarginGrowsByAtMostASixteenthOfACount) {
  for_margins([](const Lattice& lattice, double width, double height, const LatticeOptions& asked) {
    const double margin = std::ceil(asked.margin * asked.cells);
    EXPECT_LE(lattice.nx, 1.0625 * (std::ceil(width / lattice.cell_px) + 2.0 * margin) + 1.0);
    EXPECT_LE(lattice.ny, 1.0625 * (std::ceil(height / lattice.cell_px) + 2.0 * margin) + 1.0);
  });
}

TEST(GridLattice, ThePicturesCornerIsANode) {
  for_margins([](const Lattice& lattice, double, double, const LatticeOptions&) {
    const Point corner = lattice.to_cells({0.0, 0.0});
    EXPECT_NEAR(corner.x, std::round(corner.x), 1e-9);
    EXPECT_NEAR(corner.y, std::round(corner.y), 1e-9);
  });
}

TEST(GridLattice, PixelsAndCellsConvertBack) {
  const Lattice lattice = make_lattice(640, 480, {.cells = 50});
  const Point cells = lattice.to_cells(lattice.rest_px(7, 11));
  EXPECT_NEAR(cells.x, 7.0, 1e-12);
  EXPECT_NEAR(cells.y, 11.0, 1e-12);
}

TEST(GridLattice, CountsItsNodesAndCells) {
  const Lattice lattice{.nx = 16384, .ny = 3};
  EXPECT_EQ(lattice.nodes(), 16385u * 4u);
  EXPECT_EQ(lattice.cells(), 16384u * 3u);
}

TEST(GridLattice, OddCountsCoarsenUpwards) {
  EXPECT_EQ(coarse_cells(800), 400);
  EXPECT_EQ(coarse_cells(25), 13);
  EXPECT_EQ(coarse_cells(1), 1);
}

/// What make_lattice says, empty if it accepts.
std::string refusal(double width, double height, const LatticeOptions& options) {
  return tests::refusal([&] { (void)make_lattice(width, height, options); });
}

TEST(GridLattice, RefusesAPictureWithoutArea) {
  EXPECT_EQ(refusal(0, 10, {}), "width = 0: must be positive and finite");
  EXPECT_EQ(refusal(10, -3, {}), "height = -3: must be positive and finite");
  for (const double bad : {kNan, kInfinity}) {
    EXPECT_TRUE(refusal(bad, 10, {}).starts_with("width = "));
    EXPECT_TRUE(refusal(10, bad, {}).starts_with("height = "));
  }
}

TEST(GridLattice, RefusesCountsOutsideItsBounds) {
  EXPECT_EQ(refusal(10, 10, {.cells = 0}), "cells = 0: must be 1…16384");
  EXPECT_EQ(refusal(10, 10, {.cells = -4}), "cells = -4: must be 1…16384");
  EXPECT_EQ(refusal(10, 10, {.cells = 16385}), "cells = 16385: must be 1…16384");
  EXPECT_EQ(refusal(10, 10, {.cells = 1}), "");
  EXPECT_EQ(refusal(10, 10, {.cells = 16384, .margin = 0.0}), "");
}

TEST(GridLattice, RefusesASizeOfCellsThatIsNone) {
  for (const double bad : {-1.0, kNan, kInfinity}) {
    const std::string text = refusal(10, 10, {.cell_px = bad});
    EXPECT_TRUE(text.starts_with("cell size = ")) << text;
    EXPECT_TRUE(text.ends_with("must be at least 0 and finite")) << text;
  }
}

TEST(GridLattice, RefusesAMarginThatIsNone) {
  for (const double bad : {-0.1, kNan, kInfinity}) {
    const std::string text = refusal(10, 10, {.margin = bad});
    EXPECT_TRUE(text.starts_with("margin = ")) << text;
    EXPECT_TRUE(text.ends_with("must be at least 0 and finite")) << text;
  }
}

TEST(GridLattice, RefusesMoreCellsThanItCanIndex) {
  EXPECT_EQ(refusal(1e9, 10, {.cell_px = 1.0, .margin = 0.0}),
            "cells with the margin = 1e+09: must be at most 32768");
  EXPECT_TRUE(refusal(10, 10, {.cells = 256, .margin = 1e6}).starts_with("cells with the margin"));
}

}  // namespace
}  // namespace drumhead::grid
