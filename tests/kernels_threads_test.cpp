// SPDX-License-Identifier: MIT
// The same bits for every number of threads, with every fused stage. Lattices are large enough to
// be shared out: a relaxation makes many passes over its rows, the other kernels one, of which the
// coarser lattice has a quarter of the nodes.
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/threads.h>
#include <drumhead/kernels/transfer.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using fields::LevelSpec;
using fields::OwnedUnknowns;
using fields::RandomLevel;

constexpr int kMostThreads = 4;

LevelSpec with_curves(bool pressure, bool mu_cells) {
  return {.nx = 300,
          .ny = 301,
          .pressure = pressure,
          .mu_cells = mu_cells,
          .cuts = 9000,
          .stiffness = 3.0,
          .jump = 0.0625};
}
LevelSpec large(bool mu_cells, fields::Kappa kappa) {
  return {.nx = 900, .ny = 901, .mu_cells = mu_cells, .kappa = kappa};
}

/// result() has the same bits on one and on more threads.
template <class Result>
void expect_bits_of_one_thread(Result&& result) {
  const kernels::ThreadLimit one(1);
  const auto expected = result();
  for (int threads = 2; threads <= kMostThreads; ++threads) {
    const kernels::ThreadLimit several(threads);
    EXPECT_TRUE(fields::same_bits(result(), expected)) << threads << " threads";
  }
}

template <class T>
class KernelsThreads : public testing::Test {};
TYPED_TEST_SUITE(KernelsThreads, fields::Numbers, fields::NumberName);

TEST(ThreadLimit, HoldsForItsScope) {
  const int before = kernels::thread_limit();
  {
    const kernels::ThreadLimit three(3);
    EXPECT_EQ(kernels::thread_limit(), 3);
    const kernels::ThreadLimit as_it_is(0);
    EXPECT_EQ(kernels::thread_limit(), 3);
  }
  EXPECT_EQ(kernels::thread_limit(), before);
}

template <class T>
void expect_relaxation_of_one_thread(bool from_zero, bool prolong, bool restrict) {
  const LevelSpec spec = with_curves(true, false);
  kernels::RowScratch<T> scratch(spec.nx + 1, kMostThreads);
  expect_bits_of_one_thread([&] {
    RandomLevel<T> level(spec);
    if (from_zero) level.dq.assign(level.dq.size(), T(0));
    OwnedUnknowns<T> correction((spec.nx + 1) / 2, (spec.ny + 1) / 2, true);
    OwnedUnknowns<T> restricted((spec.nx + 1) / 2, (spec.ny + 1) / 2, true);
    correction.fill(level.random);
    const kernels::Unknowns<const T> d = correction.view();
    const kernels::Unknowns<T> f = restricted.view();
    kernels::relax<T>(level.system(), {.from_zero = from_zero}, prolong ? &d : nullptr,
                      restrict ? &f : nullptr, scratch);
    return fields::joined({level.d.values(), level.f.values(), level.dq, restricted.values()});
  });
}

TYPED_TEST(KernelsThreads, RelaxationHasTheBitsOfOneThread) {
  expect_relaxation_of_one_thread<TypeParam>(false, false, false);
}

TYPED_TEST(KernelsThreads, RelaxationFromZeroWithRestrictionHasTheBitsOfOneThread) {
  expect_relaxation_of_one_thread<TypeParam>(true, false, true);
}

TYPED_TEST(KernelsThreads, RelaxationAfterProlongationHasTheBitsOfOneThread) {
  expect_relaxation_of_one_thread<TypeParam>(false, true, false);
}

TYPED_TEST(KernelsThreads, RelaxationWithAllStagesHasTheBitsOfOneThread) {
  expect_relaxation_of_one_thread<TypeParam>(true, true, true);
}

TYPED_TEST(KernelsThreads, RelaxationWithoutPressuresHasTheBitsOfOneThread) {
  using T = TypeParam;
  const LevelSpec spec = with_curves(false, true);
  kernels::RowScratch<T> scratch(spec.nx + 1, kMostThreads);
  expect_bits_of_one_thread([&] {
    RandomLevel<T> level(spec);
    OwnedUnknowns<T> restricted((spec.nx + 1) / 2, (spec.ny + 1) / 2, false);
    const kernels::Unknowns<T> f = restricted.view();
    kernels::relax<T>(level.system(), {}, nullptr, &f, scratch);
    return fields::joined({level.d.values(), level.f.values(), level.dq, restricted.values()});
  });
}

TYPED_TEST(KernelsThreads, HessianProductAndForceHaveTheBitsOfOneThread) {
  using T = TypeParam;
  RandomLevel<T> level(large(true, fields::Kappa::cells));
  expect_bits_of_one_thread([&] {
    OwnedUnknowns<T> product(level.spec.nx, level.spec.ny, true);
    OwnedUnknowns<T> force(level.spec.nx, level.spec.ny, true);
    kernels::apply_hessian<T>(level.membrane(), level.d.view(), product.view());
    kernels::force<T>(level.membrane(), force.view());
    return fields::joined({product.values(), force.values()});
  });
}

TYPED_TEST(KernelsThreads, SumsHaveTheBitsOfOneThread) {
  using T = TypeParam;
  RandomLevel<T> level(large(true, fields::Kappa::cells));
  kernels::RowScratch<T> scratch(level.spec.nx + 1, kMostThreads);
  expect_bits_of_one_thread([&] {
    const kernels::EnergySums sums = kernels::energy<T>(level.membrane(), level.d.view(), T(0.3));
    RandomLevel<T> other(large(true, fields::Kappa::cells));
    const kernels::Moved moved = kernels::move<T>(T(0.3), level.d.x.view(), other.f.x.view());
    return std::vector<double>{sums.elastic,
                               sums.volume,
                               sums.volume_merit,
                               sums.inverted_cells,
                               kernels::dot<T>(level.d.view(), level.f.view()),
                               kernels::squares_over<T>(level.f.p.view(), level.d.p.view()),
                               moved.squares,
                               moved.most,
                               moved.reach,
                               kernels::residual_norm2<T>(level.system(), scratch)};
  });
}

TYPED_TEST(KernelsThreads, TransfersHaveTheBitsOfOneThread) {
  using T = TypeParam;
  RandomLevel<T> level(large(false, fields::Kappa::constant));
  const int nx = level.spec.nx, ny = level.spec.ny;
  expect_bits_of_one_thread([&] {
    OwnedUnknowns<T> down((nx + 1) / 2, (ny + 1) / 2, true), up(nx, ny, true);
    kernels::inject_nodes<T>(level.ux.view(), down.x.view());
    kernels::prolong_nodes<T>(down.x.view(), up.x.view());
    kernels::mean_cells<T>(level.pressure.view(), down.p.view());
    kernels::interpolate_cells<T>(down.p.view(), up.p.view());
    return fields::joined({down.values(), up.values()});
  });
}

}  // namespace
}  // namespace drumhead
