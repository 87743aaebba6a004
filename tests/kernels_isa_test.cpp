// SPDX-License-Identifier: MIT
// Every instruction set gives the bits of the scalar one: each row kernel, reached through the
// public functions, at each width from 3 to 40 columns of nodes, in rows that leave no spare
// element (exact) and in rows with NaN around them that AddressSanitizer guards (guarded).
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/transfer.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using fields::Layout;
using fields::LevelSpec;
using fields::OwnedUnknowns;
using fields::RandomLevel;
using kernels::Isa;

template <class T>
class KernelsIsa : public testing::Test {};
TYPED_TEST_SUITE(KernelsIsa, fields::Numbers, fields::NumberName);

int coarse(int n) { return (n + 1) / 2; }

/// body(spec) for every width, some heights, both layouts and every kind of membrane.
template <class F>
void for_widths(F&& body) {
  unsigned seed = 0;
  for (int columns = 3; columns <= 40; ++columns)
    for (const int rows : {3, 4, 7})
      for (const Layout layout : {Layout::exact, Layout::guarded})
        for (LevelSpec spec : fields::membranes()) {
          spec.nx = columns - 1;
          spec.ny = rows - 1;
          spec.layout = layout;
          spec.seed = ++seed;
          spec.pressure_jump = seed % 2 == 0 ? 0.5 : 0.0;
          body(spec);
        }
}

/// result(spec) is a std::vector: the same bits on every instruction set.
template <class Result>
void expect_scalar_bits(Result&& result) {
  for_widths([&](const LevelSpec& spec) {
    const fields::ForcedIsa forced(Isa::scalar);
    const auto expected = result(spec);
    for (const Isa isa : kernels::available_isas()) {
      kernels::use_isa(isa);
      ASSERT_TRUE(fields::same_bits(result(spec), expected))
          << fields::describe(spec) << " on " << kernels::name(isa);
    }
  });
}

template <class T>
OwnedUnknowns<T> fresh(const LevelSpec& spec) {
  return {spec.nx, spec.ny, spec.pressure, spec.layout};
}
template <class T>
OwnedUnknowns<T> fresh_coarse(const LevelSpec& spec) {
  return {coarse(spec.nx), coarse(spec.ny), spec.pressure, spec.layout};
}

TYPED_TEST(KernelsIsa, HessianProductHasTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    OwnedUnknowns<T> out = fresh<T>(spec);
    kernels::apply_hessian<T>(level.membrane(), level.d.view(), out.view());
    return out.values();
  });
}

TYPED_TEST(KernelsIsa, LinearResidualHasTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    kernels::linear_residual<T>(level.membrane(), level.f.view(), level.d.view(), level.f.view());
    return level.f.values();
  });
}

TYPED_TEST(KernelsIsa, ForceHasTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    OwnedUnknowns<T> out = fresh<T>(spec);
    kernels::force<T>(RandomLevel<T>(spec).membrane(), out.view());
    return out.values();
  });
}

TYPED_TEST(KernelsIsa, EnergyHasTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    std::vector<double> sums;
    for (const kernels::EnergySums& s :
         {kernels::energy<T>(level.membrane(), {}, T(0)),
          kernels::energy<T>(level.membrane(), level.d.view(), T(0.7))})
      sums.insert(sums.end(), {s.elastic, s.volume, s.volume_merit, s.inverted_cells});
    return sums;
  });
}

TYPED_TEST(KernelsIsa, RelaxationWithItsTransfersHasTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    OwnedUnknowns<T> correction = fresh_coarse<T>(spec), restricted = fresh_coarse<T>(spec);
    correction.fill(level.random);
    const kernels::Unknowns<const T> d = correction.view();
    const kernels::Unknowns<T> f = restricted.view();
    kernels::RowScratch<T> scratch(spec.nx + 1, 1);
    kernels::relax<T>(level.system(), {}, &d, &f, scratch);
    return fields::joined({level.d.values(), restricted.values()});
  });
}

TYPED_TEST(KernelsIsa, ResidualNormHasTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    kernels::RowScratch<T> scratch(spec.nx + 1, 1);
    return std::vector<double>{kernels::residual_norm2<T>(level.system(), scratch)};
  });
}

TYPED_TEST(KernelsIsa, TransfersHaveTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    OwnedUnknowns<T> down = fresh_coarse<T>(spec), up = fresh<T>(spec);
    kernels::inject_nodes<T>(level.ux.view(), down.x.view());
    kernels::prolong_nodes<T>(down.x.view(), up.x.view());
    if (spec.pressure) {
      kernels::mean_cells<T>(level.pressure.view(), down.p.view());
      kernels::interpolate_cells<T>(down.p.view(), up.p.view());
    }
    return fields::joined({down.values(), up.values()});
  });
}

TYPED_TEST(KernelsIsa, ReductionsAndUpdatesHaveTheScalarBits) {
  using T = TypeParam;
  expect_scalar_bits([](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    const double product = kernels::dot<T>(level.ux.view(), level.uy.view());
    kernels::combine<T>(T(0.3), level.d.view(), T(0.7), level.f.view());
    kernels::combine<T>(T(0.3), level.ux.view(), T(0), level.d.x.view());
    const kernels::Moved moved = kernels::move<T>(T(0.3), level.ux.view(), level.f.x.view());
    const double over = kernels::squares_over<T>(level.uy.view(), level.f.y.view());
    return fields::joined({level.f.values(),
                           level.d.values(),
                           {T(product), T(over), T(moved.squares), T(moved.most), T(moved.reach)}});
  });
}

TEST(Isa, TheAvailableOnesBeginWithScalarAndRise) {
  const auto isas = kernels::available_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_EQ(isas.front(), Isa::scalar);
  for (std::size_t n = 0; n + 1 < isas.size(); ++n) EXPECT_LT(isas[n], isas[n + 1]);
}

TEST(Isa, EachAvailableOneCanBeUsed) {
  const fields::ForcedIsa restored(kernels::current_isa());
  for (const Isa isa : kernels::available_isas()) {
    EXPECT_TRUE(kernels::use_isa(isa));
    EXPECT_EQ(kernels::current_isa(), isa);
  }
}

TEST(Isa, OneThatIsNotAvailableIsRefused) {
  const Isa before = kernels::current_isa();
  for (const Isa isa : {Isa::avx2, Isa::avx512}) {
    if (isa <= kernels::available_isas().back()) continue;
    EXPECT_FALSE(kernels::use_isa(isa));
  }
  EXPECT_EQ(kernels::current_isa(), before);
}

/// Ends a fresh process after it has chosen as DRUMHEAD_ISA says, with the choice on stderr.
[[noreturn]] void choose(const char* wanted) {
  setenv("DRUMHEAD_ISA", wanted, 1);
  std::cerr << kernels::name(kernels::current_isa()) << '|' << kernels::forced_isa_error() << '|';
  std::exit(0);
}

TEST(IsaDeathTest, TheEnvironmentForcesOne) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(choose("scalar"), testing::ExitedWithCode(0), "scalar\\|\\|");
}

TEST(IsaDeathTest, AnUnknownNameIsReportedAndTheBestUsed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string best(kernels::name(kernels::available_isas().back()));
  EXPECT_EXIT(choose("mmx"), testing::ExitedWithCode(0),
              best + "\\|DRUMHEAD_ISA=mmx: not one of scalar, sse2, avx2, avx512");
}

}  // namespace
}  // namespace drumhead
