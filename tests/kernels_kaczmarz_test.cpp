// SPDX-License-Identifier: MIT
// Kaczmarz sweeps against the same steps on rows of the assembled matrix, and against themselves
// on every instruction set, lattice width and number of threads.
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/kaczmarz.h>
#include <drumhead/kernels/threads.h>

#include "support/kernel_cases.h"
#include "support/oracle_kaczmarz.h"

namespace drumhead {
namespace {

using Eigen::VectorXd;
using fields::Layout;
using fields::LevelSpec;
using fields::OwnedPlane;
using fields::OwnedUnknowns;
using fields::RandomLevel;
using kernels::Isa;
using oracle::KaczmarzOracle;

template <class T>
constexpr double kTolerance = std::is_same_v<T, float> ? 2e-4 : 1e-11;
constexpr double kDamping = 0.375, kOverRelaxation = 1.4375;

enum class Sweep { jacobi, everywhere, near_curves };

/// One sweep by kernel on a random level.
template <class T>
void sweep(RandomLevel<T>& level, Sweep which) {
  const LevelSpec& spec = level.spec;
  const kernels::CurveNodes<T> nodes(spec.nx, spec.ny, level.cuts.view());
  OwnedPlane<T> alpha2;
  if (spec.pressure) alpha2 = OwnedPlane<T>(spec.nx, spec.ny, spec.layout);
  OwnedUnknowns<T> e(spec.nx, spec.ny, spec.pressure, spec.layout);
  std::vector<T> beta2(level.dq.size() / 2), eq(2 * level.dq.size());
  kernels::balance_rows<T>(level.membrane(), level.cuts.view(), alpha2.view(), beta2.data());
  kernels::KaczmarzSystem<T> system{.level = level.system(),
                                    .nodes = nodes.view(),
                                    .alpha2 = alpha2.view(),
                                    .beta2 = beta2.data(),
                                    .omega = T(kOverRelaxation)};
  switch (which) {
    case Sweep::jacobi:
      system.omega = T(kDamping);
      return kernels::damped_kaczmarz<T>(system, e.view(), eq.data());
    case Sweep::everywhere:
      return kernels::coloured_kaczmarz<T>(system, kernels::Reach::everywhere);
    case Sweep::near_curves:
      return kernels::coloured_kaczmarz<T>(system, kernels::Reach::near_curves);
  }
}

void sweep(KaczmarzOracle& reference, Sweep which) {
  if (which == Sweep::jacobi) return reference.jacobi(kDamping);
  const bool near = which == Sweep::near_curves;
  if (near && reference.curve_rows().empty()) return;
  reference.sweep(reference.momentum_rows(near), kOverRelaxation);
  reference.sweep(reference.volume_rows(near), kOverRelaxation);
  reference.sweep(reference.curve_rows(), kOverRelaxation);
}

/// What a sweep changes.
template <class T>
std::vector<T> state_of(const RandomLevel<T>& level) {
  return fields::joined({level.d.values(), level.f.values(), level.dq});
}

template <class T>
class KernelsKaczmarz : public testing::Test {};
TYPED_TEST_SUITE(KernelsKaczmarz, fields::Numbers, fields::NumberName);

/// Sweeps lattices of `base` by kernel and by matrix; compares unknowns and carried forces.
template <class T>
void expect_oracle_sweep(const LevelSpec& base, Sweep which) {
  fields::for_small_lattices(base, [&](const LevelSpec& spec) {
    const RandomLevel<T> start(spec);
    KaczmarzOracle reference(start);
    const oracle::KernelOracle& oracle = reference.oracle();
    sweep(reference, which);
    fields::on_every_isa([&] {
      RandomLevel<T> level(spec);
      sweep(level, which);
      const VectorXd found = oracle.template packed<T>(level.d.view(), level.dq);
      EXPECT_LT(oracle::relative_error(found, reference.z), kTolerance<T>);
      const VectorXd carried = oracle.template packed<T>(level.f.view(), level.fq);
      const VectorXd expected = reference.right + reference.curve_force();
      EXPECT_LT(oracle::relative_error(carried, expected), kTolerance<T>);
    });
  });
}

TYPED_TEST(KernelsKaczmarz, DampedSweepIsThatOfTheAssembledMatrix) {
  expect_oracle_sweep<TypeParam>({}, Sweep::jacobi);
}

TYPED_TEST(KernelsKaczmarz, DampedSweepWithCurveRowsIsThatOfTheAssembledMatrix) {
  expect_oracle_sweep<TypeParam>({.cuts = 30, .stiffness = 3.0, .jump = 0.0625}, Sweep::jacobi);
}

TYPED_TEST(KernelsKaczmarz, ColouredSweepIsThatOfTheAssembledMatrix) {
  expect_oracle_sweep<TypeParam>({}, Sweep::everywhere);
}

TYPED_TEST(KernelsKaczmarz, ColouredSweepWithHardCurveRowsIsThatOfTheAssembledMatrix) {
  expect_oracle_sweep<TypeParam>({.cuts = 12}, Sweep::everywhere);
}

TYPED_TEST(KernelsKaczmarz, ColouredSweepWithSoftLinkedCurveRowsIsThatOfTheAssembledMatrix) {
  expect_oracle_sweep<TypeParam>({.cuts = 30, .stiffness = 3.0, .jump = 0.0625}, Sweep::everywhere);
}

TYPED_TEST(KernelsKaczmarz, SweepNearTheCurvesIsThatOfTheAssembledMatrix) {
  expect_oracle_sweep<TypeParam>({.cuts = 12, .stiffness = 3.0, .jump = 0.0625},
                                 Sweep::near_curves);
}

// Each step of Kaczmarz's method projects onto a hyperplane through the solution: in the scaled
// unknowns the error never grows. Here the solution is 0.
TYPED_TEST(KernelsKaczmarz, ColouredSweepsNeverEnlargeTheError) {
  using T = TypeParam;
  fields::for_small_lattices({.cuts = 12, .jump = 0.0625}, [](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    level.f = OwnedUnknowns<T>(spec.nx, spec.ny, spec.pressure);
    level.fq.assign(level.fq.size(), T(0));
    kernels::add_curve_force<T>(level.cuts.view(), level.dq.data(), T(1), level.f.view());
    KaczmarzOracle before(level);
    sweep(level, Sweep::everywhere);
    const KaczmarzOracle after(level);
    EXPECT_LT(after.scaled_norm(), before.scaled_norm());
  });
}

TYPED_TEST(KernelsKaczmarz, TheFixedBoundaryOfTheCorrectionStaysZero) {
  using T = TypeParam;
  fields::for_small_lattices({.cuts = 10}, [](const LevelSpec& spec) {
    for (const Sweep which : {Sweep::jacobi, Sweep::everywhere, Sweep::near_curves}) {
      RandomLevel<T> level(spec);
      sweep(level, which);
      const std::vector<T> found = level.d.values();
      level.d.x.set_boundary(T(0));
      level.d.y.set_boundary(T(0));
      EXPECT_EQ(found, level.d.values());
    }
  });
}

TYPED_TEST(KernelsKaczmarz, EveryWidthHasTheScalarBits) {
  using T = TypeParam;
  unsigned seed = 0;
  for (int nx = 2; nx <= 40; ++nx)
    for (const int ny : {2, 7})
      for (const Layout layout : {Layout::exact, Layout::guarded})
        for (LevelSpec spec : fields::membranes())
          for (const Sweep which : {Sweep::jacobi, Sweep::everywhere, Sweep::near_curves}) {
            spec.nx = nx;
            spec.ny = ny;
            spec.layout = layout;
            spec.cuts = int(seed % 3) * 4;
            spec.jump = 0.0625;
            spec.seed = ++seed;
            const auto result = [&](Isa isa) {
              const fields::ForcedIsa forced(isa);
              RandomLevel<T> level(spec);
              sweep(level, which);
              return state_of(level);
            };
            const std::vector<T> expected = result(Isa::scalar);
            for (const Isa isa : kernels::available_isas())
              ASSERT_TRUE(fields::same_bits(result(isa), expected))
                  << fields::describe(spec) << " on " << kernels::name(isa) << ", sweep "
                  << int(which);
          }
}

TYPED_TEST(KernelsKaczmarz, SweepsHaveTheBitsOfOneThread) {
  using T = TypeParam;
  for (const bool pressure : {true, false})
    for (const Sweep which : {Sweep::jacobi, Sweep::everywhere}) {
      const LevelSpec spec{.nx = 400,
                           .ny = 401,
                           .pressure = pressure,
                           .mu_cells = !pressure,
                           .cuts = 6000,
                           .stiffness = 3.0,
                           .jump = 0.0625};
      const auto result = [&](int threads) {
        const kernels::ThreadLimit limit(threads);
        RandomLevel<T> level(spec);
        sweep(level, which);
        return state_of(level);
      };
      const std::vector<T> expected = result(1);
      for (const int threads : {2, 3, 4})
        EXPECT_TRUE(fields::same_bits(result(threads), expected)) << threads << " threads";
    }
}

}  // namespace
}  // namespace drumhead
