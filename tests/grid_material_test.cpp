// SPDX-License-Identifier: MIT
// What a material may be; every refusal names the value, the cell and the bound.
#include <limits>

#include <gtest/gtest.h>

#include <drumhead/grid/material.h>

#include "support/refusal.h"

namespace drumhead::grid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kFloatNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

std::string refusal(const Material& material) {
  return tests::refusal([&] { check(material, {.nx = 3, .ny = 2}); });
}

TEST(GridMaterial, AcceptsKappaFromZeroToInfinity) {
  for (const double kappa : {0.0, 1e-3, 1e6, kInfinity}) EXPECT_EQ(refusal({.kappa = kappa}), "");
}

TEST(GridMaterial, RefusesMuThatIsNotPositive) {
  EXPECT_EQ(refusal({.mu = 0.0}), "mu = 0: must be positive and finite");
  for (const double mu : {-1.0, kNan, kInfinity})
    EXPECT_TRUE(refusal({.mu = mu}).starts_with("mu = "));
}

TEST(GridMaterial, RefusesNegativeKappa) {
  EXPECT_EQ(refusal({.kappa = -2.0}), "kappa = -2: must be at least 0 (infinity allowed)");
  EXPECT_TRUE(refusal({.kappa = kNan}).starts_with("kappa = "));
}

TEST(GridMaterial, AcceptsAValueForEachCell) {
  EXPECT_EQ(
      refusal({.mu_cells = {1, 2, 3, 4, 5, 6}, .kappa_cells = {0, 1, 2, 3, 4, kFloatInfinity}}),
      "");
}

TEST(GridMaterial, RefusesAnotherNumberOfValues) {
  EXPECT_EQ(refusal({.mu_cells = {1, 2, 3}}),
            "mu_cells has 3 values: must be empty or 6, one per cell");
  EXPECT_EQ(refusal({.kappa_cells = {1, 2, 3, 4, 5, 6, 7}}),
            "kappa_cells has 7 values: must be empty or 6, one per cell");
}

TEST(GridMaterial, NamesTheCellOfABadValue) {
  EXPECT_EQ(refusal({.mu_cells = {1, 1, 1, 1, 0, 1}}),
            "mu factor of cell (1, 1) = 0: must be positive and finite");
  EXPECT_EQ(refusal({.kappa_cells = {1, 1, -1, 1, 1, 1}}),
            "kappa of cell (2, 0) = -1: must be at least 0 (infinity allowed)");
  EXPECT_TRUE(
      refusal({.mu_cells = {1, 1, 1, kFloatNan, 1, 1}}).starts_with("mu factor of cell (0, 1) = "));
  EXPECT_TRUE(
      refusal({.kappa_cells = {kFloatNan, 1, 1, 1, 1, 1}}).starts_with("kappa of cell (0, 0) = "));
}

}  // namespace
}  // namespace drumhead::grid
