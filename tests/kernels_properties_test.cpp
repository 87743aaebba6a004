// SPDX-License-Identifier: MIT
// What must hold whatever the numbers are: symmetry, invariance under motions, null Lagrangian,
// scaling, and the force as the derivative of the energy.
#include <cmath>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using fields::LevelSpec;
using fields::OwnedPlane;
using fields::OwnedUnknowns;
using fields::RandomLevel;
using kernels::EnergySums;
using kernels::Membrane;
using kernels::Plane;

constexpr double kRounding = 1e-11;

OwnedUnknowns<double> product(const RandomLevel<double>& level, const Membrane<double>& membrane,
                              const OwnedUnknowns<double>& d) {
  OwnedUnknowns<double> out(level.spec.nx, level.spec.ny, level.spec.pressure);
  kernels::apply_hessian<double>(membrane, d.view(), out.view());
  return out;
}

TEST(KernelsProperties, TheHessianIsSymmetric) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    RandomLevel<double> level(spec);
    OwnedUnknowns<double> v(spec.nx, spec.ny, spec.pressure);
    v.fill(level.random);
    const OwnedUnknowns<double> Hd = product(level, level.membrane(), level.d);
    const OwnedUnknowns<double> Hv = product(level, level.membrane(), v);
    EXPECT_NEAR(kernels::dot<double>(Hd.view(), v.view()),
                kernels::dot<double>(level.d.view(), Hv.view()), 100.0 * kRounding);
  });
}

TEST(KernelsProperties, WithoutPressuresTheHessianIsPositive) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    if (spec.pressure) return;
    RandomLevel<double> level(spec);
    const OwnedUnknowns<double> Hd = product(level, level.membrane(), level.d);
    EXPECT_GT(kernels::dot<double>(Hd.view(), level.d.view()), 0.0);
  });
}

void expect_equal_sums(const EnergySums& found, const EnergySums& expected) {
  const double size = 1.0 + expected.elastic + expected.volume + std::abs(expected.volume_merit);
  EXPECT_NEAR(found.elastic, expected.elastic, kRounding * size);
  EXPECT_NEAR(found.volume, expected.volume, kRounding * size);
  EXPECT_NEAR(found.volume_merit, expected.volume_merit, kRounding * size);
  EXPECT_EQ(found.inverted_cells, expected.inverted_cells);
}

/// Replaces every position x̂ = X + u, the boundary's too, by map(x̂).
template <class Map>
void move_all(RandomLevel<double>& level, Map&& map) {
  const Plane<double> ux = level.ux.view(), uy = level.uy.view();
  const double h = level.spec.spacing;
  for (int j = 0; j < ux.rows; ++j)
    for (int i = 0; i < ux.columns; ++i) {
      const auto [x, y] = map(h * i + ux.at(i, j), h * j + uy.at(i, j));
      ux.at(i, j) = x - h * i;
      uy.at(i, j) = y - h * j;
    }
}

/// The energy does not notice that map was applied to all positions.
template <class Map>
void expect_invariant(Map&& map) {
  fields::for_small_lattices({}, [&](const LevelSpec& spec) {
    RandomLevel<double> level(spec);
    const EnergySums before = kernels::energy<double>(level.membrane(), {}, 0.0);
    move_all(level, map);
    expect_equal_sums(kernels::energy<double>(level.membrane(), {}, 0.0), before);
  });
}

TEST(KernelsProperties, MovingEverythingLeavesTheEnergy) {
  expect_invariant([](double x, double y) { return std::pair(x + 3.25, y - 1.5); });
}

TEST(KernelsProperties, TurningEverythingLeavesTheEnergy) {
  for (const double degrees : {30.0, 90.0, 180.0, -77.0}) {
    const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
    expect_invariant([=](double x, double y) { return std::pair(c * x - s * y, s * x + c * y); });
  }
}

TEST(KernelsProperties, MirroringInvertsEveryCellAndKeepsTheElasticEnergy) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    RandomLevel<double> level(spec);
    const EnergySums before = kernels::energy<double>(level.membrane(), {}, 0.0);
    move_all(level, [](double x, double y) { return std::pair(-x, y); });
    const EnergySums mirrored = kernels::energy<double>(level.membrane(), {}, 0.0);
    EXPECT_NEAR(mirrored.elastic, before.elastic, kRounding * before.elastic);
    EXPECT_EQ(mirrored.inverted_cells, spec.nx * spec.ny - before.inverted_cells);
  });
}

TEST(KernelsProperties, TheRestStateHasTheEnergyOfItsArea) {
  for (const double h : {1.0, 2.0, 4.0}) {
    RandomLevel<double> level({.nx = 7, .ny = 4, .spacing = h});
    level.ux.set([](int, int) { return 0.0; });
    level.uy.set([](int, int) { return 0.0; });
    const EnergySums sums = kernels::energy<double>(level.membrane(), {}, 0.0);
    EXPECT_EQ(sums.elastic, level.mu_value * h * h * 7 * 4);
    EXPECT_EQ(sums.volume, 0.0);
    EXPECT_EQ(sums.inverted_cells, 0.0);
  }
}

TEST(KernelsProperties, AConstantPressureIsANullLagrangianInTheHessian) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    if (!spec.pressure) return;
    RandomLevel<double> level(spec);
    level.clamp_width = 100.0;
    const OwnedUnknowns<double> expected = product(level, level.membrane(), level.d);
    level.clamp_centre += 7.0;  // P_H less a constant
    const OwnedUnknowns<double> shifted = product(level, level.membrane(), level.d);
    for (std::size_t n = 0; n < expected.values().size(); ++n)
      ASSERT_NEAR(shifted.values()[n], expected.values()[n], 10.0 * kRounding);
  });
}

TEST(KernelsProperties, AConstantPressureExertsNoForce) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    if (!spec.pressure) return;
    RandomLevel<double> level(spec);
    OwnedUnknowns<double> with(spec.nx, spec.ny, true), without(spec.nx, spec.ny, true);
    level.pressure.set([](int, int) { return 7.0; });
    kernels::force<double>(level.membrane(), with.view());
    level.pressure.set([](int, int) { return 0.0; });
    kernels::force<double>(level.membrane(), without.view());
    for (std::size_t n = 0; n < with.x.values().size(); ++n) {
      ASSERT_NEAR(with.x.values()[n], without.x.values()[n], 10.0 * kRounding);
      ASSERT_NEAR(with.y.values()[n], without.y.values()[n], 10.0 * kRounding);
    }
  });
}

/// Stiffness and all that has its unit, times a power of two.
void stiffen(RandomLevel<double>& level, double factor) {
  const auto scale = [](OwnedPlane<double>& plane, double by) {
    kernels::combine<double>(0.0, plane.view(), by, plane.view());
  };
  level.mu_value *= factor;
  level.compliance_value /= factor;
  level.clamp_centre *= factor;
  scale(level.mu, factor);
  scale(level.compliance, 1.0 / factor);
  scale(level.pressure, factor);
  scale(level.inverse_diagonal, 1.0 / factor);
  scale(level.d.p, factor);
  scale(level.f.x, factor);
  scale(level.f.y, factor);
}

// Bit for bit, because a power of two changes no rounding.
TEST(KernelsProperties, StiffnessIsAUnit) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    RandomLevel<double> soft(spec), stiff(spec);
    stiffen(stiff, 8.0);
    kernels::RowScratch<double> scratch(spec.nx + 1, 1);
    kernels::relax<double>(soft.system(), {}, nullptr, nullptr, scratch);
    kernels::relax<double>(stiff.system(), {}, nullptr, nullptr, scratch);
    EXPECT_EQ(stiff.d.x.values(), soft.d.x.values());
    EXPECT_EQ(stiff.d.y.values(), soft.d.y.values());
    kernels::combine<double>(0.0, soft.d.p.view(), 8.0, soft.d.p.view());
    EXPECT_EQ(stiff.d.p.values(), soft.d.p.values());
  });
}

// The elastic energy is quadratic along d, so that a central difference of any width is exact.
TEST(KernelsProperties, TheForceIsTheSlopeOfTheElasticEnergy) {
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    if (spec.pressure) return;
    RandomLevel<double> level(spec);
    OwnedUnknowns<double> force(spec.nx, spec.ny, false);
    kernels::force<double>(level.membrane(), force.view());
    const auto energy = [&](double step) {
      return kernels::energy<double>(level.membrane(), level.d.view(), step).elastic;
    };
    EXPECT_NEAR(kernels::dot<double>(force.view(), level.d.view()),
                0.5 * (energy(-1.0) - energy(1.0)), kRounding * energy(1.0));
  });
}

// With 1/kappa not below the cap of the merit function, the merit is the volume energy itself.
TEST(KernelsProperties, TheMeritOfASoftMembraneIsItsVolumeEnergy) {
  RandomLevel<double> level({.nx = 9, .ny = 6});
  const EnergySums sums = kernels::energy<double>(level.membrane(), level.d.view(), 0.5);
  EXPECT_NEAR(sums.volume_merit, sums.volume, kRounding * sums.volume);
}

}  // namespace
}  // namespace drumhead
