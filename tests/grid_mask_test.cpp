// SPDX-License-Identifier: MIT
// Coefficients of cells from a grey picture: area means are exact, and the same on every lattice.
#include <gtest/gtest.h>

#include <drumhead/grid/mask.h>
#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "support/refusal.h"

namespace drumhead::grid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 4 × 2 pixels with greys 0, ¼, ½, 1 in the upper row and their complements below.
Mask steps(double black, double white) {
  return {4, 2, {0.0f, 0.25f, 0.5f, 1.0f, 1.0f, 0.75f, 0.5f, 0.0f}, black, white};
}

Lattice lattice(int nx, int ny, double cell_px, Point origin = {}) {
  return {nx, ny, cell_px, origin, 4.0};
}

Mask random_mask(int width, int height) {
  Mask mask{width, height, {}, 0.5, 50.0};
  std::mt19937 random(7);
  std::uniform_real_distribution<float> grey(0.0f, 1.0f);
  for (int k = 0; k < width * height; ++k) mask.grey.push_back(grey(random));
  return mask;
}

TEST(GridMask, ACellOfOnePixelTakesItsCoefficient) {
  const std::vector<float> mu = mu_cells(steps(2.0, 6.0), lattice(4, 2, 1.0));
  EXPECT_EQ(mu, (std::vector<float>{2, 3, 4, 6, 6, 5, 4, 2}));
  const std::vector<float> kappa = kappa_cells(steps(0.0, 8.0), lattice(4, 2, 1.0));
  EXPECT_EQ(kappa, (std::vector<float>{0, 2, 4, 8, 8, 6, 4, 0}));
}

TEST(GridMask, OnALogScaleEqualStepsOfGreyAreEqualRatios) {
  Mask mask = steps(0.01, 100.0);
  mask.scale = MaskScale::log;
  const std::vector<float> mu = mu_cells(mask, lattice(4, 2, 1.0));
  EXPECT_FLOAT_EQ(mu[0], 0.01f);
  EXPECT_FLOAT_EQ(mu[1], 0.1f);
  EXPECT_FLOAT_EQ(mu[2], 1.0f);
  EXPECT_FLOAT_EQ(mu[3], 100.0f);
  EXPECT_EQ(kappa_cells(mask, lattice(4, 2, 1.0)), mu);
}

TEST(GridMask, ALargeCellTakesTheMeanOfMuAndOfTheInverseOfKappa) {
  EXPECT_EQ(mu_cells(steps(2.0, 6.0), lattice(2, 1, 2.0)), (std::vector<float>{4.0f, 4.0f}));
  const std::vector<float> kappa = kappa_cells(steps(1.0, 5.0), lattice(2, 1, 2.0));
  EXPECT_FLOAT_EQ(kappa[0], float(4.0 / (1.0 / 1 + 1.0 / 2 + 1.0 / 5 + 1.0 / 4)));
  EXPECT_FLOAT_EQ(kappa[1], float(4.0 / (1.0 / 3 + 1.0 / 5 + 1.0 / 3 + 1.0 / 1)));
  EXPECT_EQ(kappa_cells(steps(0.0, 8.0), lattice(2, 1, 2.0)), (std::vector<float>{0.0f, 0.0f}));
}

TEST(GridMask, PixelsCountByTheAreaThatACellCovers) {
  // Cells of 1.6 pixels from (0.3, 0.2) on: the first covers .7 and .9 of two columns, .8 of both
  // rows.
  const std::vector<float> mu = mu_cells(steps(2.0, 6.0), lattice(2, 1, 1.6, {0.3, 0.2}));
  const double upper = (0.7 * 2 + 0.9 * 3) / 1.6, lower = (0.7 * 6 + 0.9 * 5) / 1.6;
  EXPECT_FLOAT_EQ(mu[0], float((0.8 * upper + 0.8 * lower) / 1.6));
}

TEST(GridMask, BeyondThePictureTheNearestEdgeGoesOn) {
  const Mask mask = steps(2.0, 6.0);
  // Cells of one pixel with a margin of two on every side.
  const std::vector<float> mu = mu_cells(mask, lattice(8, 6, 1.0, {-2.0, -2.0}));
  const auto at = [&](int i, int j) { return mu[std::size_t(j * 8 + i)]; };
  const std::vector<float> inside = mu_cells(mask, lattice(4, 2, 1.0));
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 8; ++i) {
      const int x = std::clamp(i - 2, 0, 3), y = std::clamp(j - 2, 0, 1);
      EXPECT_EQ(at(i, j), inside[std::size_t(y * 4 + x)]) << i << ", " << j;
    }
  // One cell over all of it, half of whose width is beyond the right edge.
  const std::vector<float> one = mu_cells(mask, lattice(1, 1, 8.0));
  const double upper = (2 + 3 + 4 + 5 * 6) / 8.0, lower = (6 + 5 + 4 + 5 * 2) / 8.0;
  EXPECT_FLOAT_EQ(one[0], float((upper + 7 * lower) / 8.0));
}

TEST(GridMask, CellsSmallerThanAPixelKeepItsValue) {
  const std::vector<float> mu = mu_cells(steps(2.0, 6.0), lattice(16, 8, 0.25));
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_EQ(mu[i], (std::array{2.0f, 3.0f, 4.0f, 6.0f})[i / 4]);
}

TEST(GridMask, AMaskMeansTheSameOnALatticeOfHalfAsManyCells) {
  for (const Mask& mask : {random_mask(37, 23), random_mask(5, 3), random_mask(1, 1)}) {
    const Lattice fine{16, 12, 2.7, {-4.1, -3.3}, 37.0}, coarse{8, 6, 5.4, {-4.1, -3.3}, 37.0};
    const std::vector<float> mu = mu_cells(mask, fine), mu2 = mu_cells(mask, coarse);
    const std::vector<float> kappa = kappa_cells(mask, fine), kappa2 = kappa_cells(mask, coarse);
    for (std::size_t j = 0; j < 6; ++j)
      for (std::size_t i = 0; i < 8; ++i) {
        double sum = 0.0, compliance = 0.0;
        for (const std::size_t c : {0u, 1u, 16u, 17u}) {
          sum += double(mu[32 * j + 2 * i + c]);
          compliance += 1.0 / double(kappa[32 * j + 2 * i + c]);
        }
        EXPECT_FLOAT_EQ(mu2[8 * j + i], float(sum / 4.0));
        EXPECT_FLOAT_EQ(kappa2[8 * j + i], float(4.0 / compliance));
      }
  }
}

TEST(GridMask, RefusesWhatHasNoValueAndNamesIt) {
  const Lattice cells = lattice(4, 2, 1.0);
  const auto mu_refusal = [&](const Mask& m) {
    return tests::refusal([&] { (void)mu_cells(m, cells); });
  };
  const auto kappa_refusal = [&](const Mask& m) {
    return tests::refusal([&] { (void)kappa_cells(m, cells); });
  };
  EXPECT_EQ(mu_refusal(steps(0.0, 1.0)), "black = 0: must be finite and above 0");
  EXPECT_EQ(kappa_refusal(steps(0.0, 1.0)), "");
  EXPECT_EQ(kappa_refusal(steps(-1.0, 1.0)), "black = -1: must be finite and at least 0");
  EXPECT_EQ(kappa_refusal(steps(1.0, kInfinity)), "white = inf: must be finite and at least 0");
  Mask mask = steps(0.0, 1.0);
  mask.scale = MaskScale::log;
  EXPECT_EQ(kappa_refusal(mask), "black = 0: must be finite and above 0 on a log scale");
  mask = steps(1.0, 2.0);
  mask.grey[6] = kNan;
  EXPECT_EQ(mu_refusal(mask), "pixel (2, 1) = nan: must be from 0 to 1");
  mask.grey[6] = 1.5f;
  EXPECT_EQ(kappa_refusal(mask), "pixel (2, 1) = 1.5: must be from 0 to 1");
  mask.grey.pop_back();
  EXPECT_EQ(mu_refusal(mask), "mask of 4 × 2 pixels has 7 values: must be one a pixel");
}

}  // namespace
}  // namespace drumhead::grid
