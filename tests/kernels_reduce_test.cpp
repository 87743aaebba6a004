// SPDX-License-Identifier: MIT
// Sums and vector updates over fields.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <drumhead/kernels/reduce.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using fields::OwnedPlane;
using fields::OwnedUnknowns;

template <class T>
class KernelsReduce : public testing::Test {};
TYPED_TEST_SUITE(KernelsReduce, fields::Numbers, fields::NumberName);

template <class T>
OwnedPlane<T> filled(int columns, int rows, unsigned seed) {
  fields::Random random(seed);
  OwnedPlane<T> plane(columns, rows);
  plane.fill(random, -2.0, 2.0);
  return plane;
}

/// body(columns) for rows shorter and longer than sixteen sums and than any batch.
template <class F>
void for_columns(F&& body) {
  fields::on_every_isa([&] {
    for (int columns = 1; columns <= 70; ++columns) {
      SCOPED_TRACE(columns);
      body(columns);
    }
  });
}

TYPED_TEST(KernelsReduce, DotIsTheSumOfProducts) {
  using T = TypeParam;
  for_columns([](int columns) {
    const OwnedPlane<T> a = filled<T>(columns, 3, 1), b = filled<T>(columns, 3, 2);
    const std::vector<T> x = a.values(), y = b.values();
    double sum = 0.0;  // multiples of 2^-24: exact in any order
    for (std::size_t n = 0; n < x.size(); ++n) sum += double(x[n]) * double(y[n]);
    EXPECT_EQ(kernels::dot<T>(a.view(), b.view()), sum);
  });
}

TYPED_TEST(KernelsReduce, DotOfUnknownsAddsTheirFields) {
  using T = TypeParam;
  fields::Random random(1);
  for (const bool pressure : {false, true}) {
    OwnedUnknowns<T> a(7, 5, pressure), b(7, 5, pressure);
    a.fill(random);
    b.fill(random);
    double sum = kernels::dot<T>(a.x.view(), b.x.view()) + kernels::dot<T>(a.y.view(), b.y.view());
    if (pressure) sum += kernels::dot<T>(a.p.view(), b.p.view());
    EXPECT_EQ(kernels::dot<T>(a.view(), b.view()), sum);
  }
}

TYPED_TEST(KernelsReduce, SquaresOverLeaveOutWhatIsOverNothing) {
  using T = TypeParam;
  for_columns([](int columns) {
    const OwnedPlane<T> a = filled<T>(columns, 3, 1);
    OwnedPlane<T> b(columns, 3);
    b.set([](int i, int j) { return T((i + j) % 3 == 0 ? 0.0 : (i + j) % 3 == 1 ? 0.5 : 4.0); });
    double sum = 0.0;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < columns; ++i)
        if (b.view().at(i, j) > T(0))
          sum += double(a.view().at(i, j)) * double(a.view().at(i, j)) / double(b.view().at(i, j));
    EXPECT_EQ(kernels::squares_over<T>(a.view(), b.view()), sum);
  });
}

TYPED_TEST(KernelsReduce, MoveIsACombinationAndItsSumOfSquares) {
  using T = TypeParam;
  for_columns([](int columns) {
    const OwnedPlane<T> x = filled<T>(columns, 3, 5), y = filled<T>(columns, 3, 6);
    OwnedPlane<T> out = filled<T>(columns, 3, 6);
    const kernels::Moved moved = kernels::move<T>(T(0.3), x.view(), out.view());
    EXPECT_EQ(moved.squares, kernels::dot<T>(x.view(), x.view()));
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < columns; ++i)
        ASSERT_EQ(out.view().at(i, j), y.view().at(i, j) + T(0.3) * x.view().at(i, j));
  });
}

TYPED_TEST(KernelsReduce, MoveFindsTheLargestSizesInEveryPlace) {
  using T = TypeParam;
  for_columns([](int columns) {
    for (int i = 0; i < columns; ++i) {
      OwnedPlane<T> x = filled<T>(columns, 2, 3), y = filled<T>(columns, 2, 4);
      x.view().at(i, 1) = T(-5.0 - i);
      y.view().at(columns - 1 - i, 0) = T(-50.0);
      x.view().at(columns - 1 - i, 0) = T(1.0);
      const kernels::Moved moved = kernels::move<T>(T(0.25), x.view(), y.view());
      EXPECT_EQ(moved.most, 5.0 + i);
      EXPECT_EQ(moved.reach, 49.75);
    }
  });
}

TYPED_TEST(KernelsReduce, MoveLeavesWhereItWouldNotBeFinite) {
  using T = TypeParam;
  for (const T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                      -std::numeric_limits<T>::infinity()})
    for_columns([bad](int columns) {
      OwnedPlane<T> x = filled<T>(columns, 3, 5), y = filled<T>(columns, 3, 6);
      const OwnedPlane<T> before = filled<T>(columns, 3, 6);
      const int i = columns / 2;
      x.view().at(i, 1) = bad;
      const kernels::Moved moved = kernels::move<T>(T(0.5), x.view(), y.view());
      EXPECT_FALSE(std::isfinite(moved.squares));
      EXPECT_FALSE(std::isfinite(moved.most));
      EXPECT_LE(moved.reach, 3.0);
      EXPECT_EQ(y.view().at(i, 1), before.view().at(i, 1));
      EXPECT_EQ(y.view().at(0, 0), before.view().at(0, 0) + T(0.5) * x.view().at(0, 0));
    });
}

TYPED_TEST(KernelsReduce, MoveDoesNotHideAStateThatIsNoNumber) {
  using T = TypeParam;
  const OwnedPlane<T> x = filled<T>(9, 3, 5);
  OwnedPlane<T> y = filled<T>(9, 3, 6);
  y.view().at(3, 0) = std::numeric_limits<T>::quiet_NaN();
  EXPECT_TRUE(std::isnan(kernels::move<T>(T(1), x.view(), y.view()).reach));
}

TYPED_TEST(KernelsReduce, CombineIsALinearCombination) {
  using T = TypeParam;
  for_columns([](int columns) {
    const OwnedPlane<T> x = filled<T>(columns, 3, 5), y = filled<T>(columns, 3, 6);
    OwnedPlane<T> out = filled<T>(columns, 3, 6);
    kernels::combine<T>(T(0.3), x.view(), T(-1.7), out.view());
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < columns; ++i)
        ASSERT_EQ(out.view().at(i, j), T(0.3) * x.view().at(i, j) + T(-1.7) * y.view().at(i, j));
  });
}

TYPED_TEST(KernelsReduce, CombineWithFactorZeroDoesNotReadItsTarget) {
  using T = TypeParam;
  for_columns([](int columns) {
    const OwnedPlane<T> x = filled<T>(columns, 3, 7);
    OwnedPlane<T> out(columns, 3);
    out.set([](int, int) { return std::numeric_limits<T>::quiet_NaN(); });
    kernels::combine<T>(T(2), x.view(), T(0), out.view());
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < columns; ++i) ASSERT_EQ(out.view().at(i, j), T(2) * x.view().at(i, j));
  });
}

TYPED_TEST(KernelsReduce, FieldsThatDoNotExistAreSkipped) {
  using T = TypeParam;
  const OwnedUnknowns<T> x(4, 3, false);
  OwnedUnknowns<T> y(4, 3, false);
  kernels::combine<T>(T(1), x.view(), T(1), y.view());
  EXPECT_EQ(kernels::dot<T>(x.view(), y.view()), 0.0);
}

}  // namespace
}  // namespace drumhead
