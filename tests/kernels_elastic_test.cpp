// SPDX-License-Identifier: MIT
// The elastic kernels against the assembled matrix, for random states, on every instruction set.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>

#include "support/kernel_cases.h"
#include "support/kernel_oracle.h"

namespace drumhead {
namespace {

using Eigen::VectorXd;
using fields::kRounding;
using fields::OwnedUnknowns;
using fields::RandomLevel;
using kernels::EnergySums;
using oracle::KernelOracle;

template <class T>
class KernelsElastic : public testing::Test {};
TYPED_TEST_SUITE(KernelsElastic, fields::Numbers, fields::NumberName);

/// body(level, oracle) for every small lattice on every instruction set.
template <class T, class F>
void against_oracle(F&& body, const fields::LevelSpec& base = {}) {
  fields::for_small_lattices(base, [&](const fields::LevelSpec& spec) {
    RandomLevel<T> level(spec);
    const KernelOracle oracle = oracle::kernel_oracle(level);
    fields::on_every_isa([&] { body(level, oracle); });
  });
}

template <class T>
OwnedUnknowns<T> like(const RandomLevel<T>& level) {
  return {level.spec.nx, level.spec.ny, level.spec.pressure};
}

TYPED_TEST(KernelsElastic, HessianProductEqualsTheAssembledMatrix) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    OwnedUnknowns<T> out = like(level);
    kernels::apply_hessian<T>(level.membrane(), level.d.view(), out.view());
    const VectorXd expected = oracle.matrix * oracle.packed<T>(level.d.view());
    EXPECT_LT(oracle::relative_error(oracle.packed<T>(out.view()), expected), kRounding<T>);
  });
}

TYPED_TEST(KernelsElastic, ForceIsMinusTheAssembledGradient) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    OwnedUnknowns<T> out = like(level);
    kernels::force<T>(level.membrane(), out.view());
    EXPECT_LT(oracle::relative_error(oracle.packed<T>(out.view()), oracle.force()), kRounding<T>);
  });
}

TYPED_TEST(KernelsElastic, LinearResidualEqualsTheAssembledOne) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    OwnedUnknowns<T> out = like(level);
    kernels::linear_residual<T>(level.membrane(), level.f.view(), level.d.view(), out.view());
    const VectorXd expected =
        oracle.packed<T>(level.f.view()) - oracle.matrix * oracle.packed<T>(level.d.view());
    EXPECT_LT(oracle::relative_error(oracle.packed<T>(out.view()), expected), kRounding<T>);
  });
}

TYPED_TEST(KernelsElastic, PressureJumpEqualsTheAssembledEdges) {
  using T = TypeParam;
  against_oracle<T>(
      [](RandomLevel<T>& level, const KernelOracle& oracle) {
        OwnedUnknowns<T> out = like(level);
        kernels::apply_hessian<T>(level.membrane(), level.d.view(), out.view());
        const VectorXd product = oracle.matrix * oracle.packed<T>(level.d.view());
        EXPECT_LT(oracle::relative_error(oracle.packed<T>(out.view()), product), kRounding<T>);
        kernels::linear_residual<T>(level.membrane(), level.f.view(), level.d.view(), out.view());
        const VectorXd residual = oracle.packed<T>(level.f.view()) - product;
        EXPECT_LT(oracle::relative_error(oracle.packed<T>(out.view()), residual), kRounding<T>);
      },
      {.pressure_jump = 0.5});
}

/// Forces of the same dP everywhere cancel, up to its rounding: dP x̂ of four cells.
TYPED_TEST(KernelsElastic, APressureThatIsTheSameEverywhereRoundsWithItsSize) {
  using T = TypeParam;
  constexpr double kPressure = 1e3;
  fields::for_small_lattices({}, [](const fields::LevelSpec& spec) {
    if (!spec.pressure) return;
    RandomLevel<T> level(spec);
    level.d.x.set([](int, int) { return T(0); });
    level.d.y.set([](int, int) { return T(0); });
    level.d.p.set([](int, int) { return T(kPressure); });
    OwnedUnknowns<T> out = like(level);
    kernels::apply_hessian<T>(level.membrane(), level.d.view(), out.view());
    const double size = 4.0 * kPressure * 3.0 * spec.spacing;  // displacements are less than h
    for (int j = 1; j < spec.ny; ++j)
      for (int i = 1; i < spec.nx; ++i) {
        EXPECT_LT(std::abs(out.x.view().at(i, j)), size * std::numeric_limits<T>::epsilon());
        EXPECT_LT(std::abs(out.y.view().at(i, j)), size * std::numeric_limits<T>::epsilon());
      }
  });
}

TYPED_TEST(KernelsElastic, LinearResidualMayOverwriteItsRightHandSide) {
  using T = TypeParam;
  fields::for_small_lattices({}, [](const fields::LevelSpec& spec) {
    RandomLevel<T> level(spec);
    OwnedUnknowns<T> out = like(level);
    out.x.set([&](int i, int j) { return level.f.x.view().at(i, j); });  // boundary values too
    out.y.set([&](int i, int j) { return level.f.y.view().at(i, j); });
    kernels::linear_residual<T>(level.membrane(), level.f.view(), level.d.view(), out.view());
    kernels::linear_residual<T>(level.membrane(), level.f.view(), level.d.view(), level.f.view());
    EXPECT_TRUE(fields::same_bits(level.f.values(), out.values()));
  });
}

/// The sums at x̂ + step d from the oracle's energies; the merit from its definition.
template <class T>
EnergySums expected_sums(const RandomLevel<T>& level, const KernelOracle& oracle, double step) {
  const oracle::OracleScene& scene = oracle.scene;
  const VectorXd d = oracle.packed<T>(level.d.view());
  oracle::State state = oracle::moved(scene, oracle.state, d / oracle.h, step);
  const double area = oracle.h * oracle.h, whole = area * scene.n * scene.n;
  const oracle::Energies energies = oracle::energies(scene, state);
  EnergySums sums{.elastic = whole * energies.elastic, .volume = whole * energies.volume};
  for (int j = 0; j < oracle.ny; ++j) {
    for (int i = 0; i < oracle.nx; ++i) {
      const double J = oracle::centre_J(scene, state, i, j);
      if (J < 0.0) sums.inverted_cells += 1.0;
      if (oracle.cell(i, j) < 0) continue;
      const double kappa = scene.kappa[std::size_t(j) * std::size_t(scene.n) + std::size_t(i)];
      const double km = std::min(kappa, 100.0 * double(level.mu_value));
      const double dP = step == 0.0 ? 0.0 : d[oracle.cell(i, j)];
      const double P = oracle.state.P[j * scene.n + i] + dP, c = J - 1.0 - P / kappa;
      sums.volume_merit += kappa <= km ? area * kappa / 2.0 * (J - 1.0) * (J - 1.0)
                                       : area * (P * c + km / 2.0 * c * c);
    }
  }
  return sums;
}

template <class T>
void expect_sums(const EnergySums& found, const EnergySums& expected) {
  const double tolerance = kRounding<T> * (1.0 + std::abs(expected.elastic));
  EXPECT_NEAR(found.elastic, expected.elastic, tolerance);
  EXPECT_EQ(found.inverted_cells, expected.inverted_cells);
  EXPECT_NEAR(found.volume, expected.volume, kRounding<T> * (1.0 + expected.volume));
  // Two terms of either sign make up the merit.
  const double size = std::abs(expected.volume_merit) + expected.volume + expected.elastic;
  EXPECT_NEAR(found.volume_merit, expected.volume_merit, kRounding<T> * (1.0 + size));
}

TYPED_TEST(KernelsElastic, EnergyAtTheStateEqualsTheOracles) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    expect_sums<T>(kernels::energy<T>(level.membrane(), {}, T(1)),
                   expected_sums(level, oracle, 0.0));
  });
}

TYPED_TEST(KernelsElastic, EnergyAfterAStepEqualsTheOracles) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    for (const double step : {0.25, 1.0}) {
      expect_sums<T>(kernels::energy<T>(level.membrane(), level.d.view(), T(step)),
                     expected_sums(level, oracle, step));
    }
  });
}

TYPED_TEST(KernelsElastic, LongStepsInvertCells) {
  using T = TypeParam;
  RandomLevel<T> level({.nx = 17, .ny = 9});
  const EnergySums sums = kernels::energy<T>(level.membrane(), level.d.view(), T(1));
  EXPECT_GT(sums.inverted_cells, 5.0);
}

TYPED_TEST(KernelsElastic, TheFixedBoundaryIsNeverWritten) {
  using T = TypeParam;
  fields::for_small_lattices({}, [](const fields::LevelSpec& spec) {
    RandomLevel<T> level(spec);
    const auto run = [&](auto&& kernel) {
      OwnedUnknowns<T> out = like(level);
      const T untouched(77);
      out.x.set([&](int, int) { return untouched; });
      out.y.set([&](int, int) { return untouched; });
      kernel(out.view());
      const std::vector<T> found = out.values();
      out.x.set_boundary(untouched);
      out.y.set_boundary(untouched);
      EXPECT_TRUE(fields::same_bits(found, out.values()));
    };
    const kernels::Membrane<T> m = level.membrane();
    run([&](auto out) { kernels::apply_hessian<T>(m, level.d.view(), out); });
    run([&](auto out) { kernels::linear_residual<T>(m, level.f.view(), level.d.view(), out); });
    run([&](auto out) { kernels::force<T>(m, out); });
  });
}

}  // namespace
}  // namespace drumhead
