// SPDX-License-Identifier: MIT
// Transfers of states between a lattice and its coarser one, at even and odd counts (where the last
// coarse cell overhangs the fixed edge) and at rows longer than the kernels' buffers.
#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/transfer.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using fields::OwnedPlane;
using kernels::Plane;

template <class T>
class KernelsTransfer : public testing::Test {};
TYPED_TEST_SUITE(KernelsTransfer, fields::Numbers, fields::NumberName);

int coarse(int n) { return (n + 1) / 2; }

/// body(nx, ny) on every instruction set.
template <class F>
void for_sizes(F&& body) {
  std::vector<std::array<int, 2>> sizes{{2, 2}, {3, 5}, {4, 3}, {9, 8}, {16, 7}, {33, 6}, {40, 9}};
  for (const int nx : {1023, 1024, 1025, 1026, 2047, 2050}) sizes.push_back({nx, 3});
  fields::on_every_isa([&] {
    for (const auto& [nx, ny] : sizes) {
      SCOPED_TRACE(std::to_string(nx) + " x " + std::to_string(ny));
      body(nx, ny);
    }
  });
}

bool interior(const auto& plane, int i, int j) {
  return i > 0 && j > 0 && i + 1 < plane.columns && j + 1 < plane.rows;
}

TYPED_TEST(KernelsTransfer, ProlongationOfABilinearFunctionIsExact) {
  using T = TypeParam;
  // Small integers over powers of two: every step is exact.
  const auto function = [](int i, int j) { return 0.5 + 0.25 * i - 2.0 * j + 0.125 * i * j; };
  for_sizes([&](int nx, int ny) {
    OwnedPlane<T> from(coarse(nx) + 1, coarse(ny) + 1), to(nx + 1, ny + 1);
    from.set([&](int i, int j) { return function(2 * i, 2 * j); });
    kernels::prolong_nodes<T>(from.view(), to.view());
    const Plane<T> fine = to.view();
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        ASSERT_EQ(fine.at(i, j), interior(fine, i, j) ? T(function(i, j)) : T(0)) << i << ' ' << j;
  });
}

TYPED_TEST(KernelsTransfer, InjectionTakesTheNodesAtTheSamePlaces) {
  using T = TypeParam;
  for_sizes([](int nx, int ny) {
    fields::Random random(3);
    OwnedPlane<T> from(nx + 1, ny + 1), to(coarse(nx) + 1, coarse(ny) + 1);
    from.fill(random, -1.0, 1.0);
    kernels::inject_nodes<T>(from.view(), to.view());
    const Plane<T> found = to.view();
    for (int j = 1; j + 1 < found.rows; ++j)
      for (int i = 1; i + 1 < found.columns; ++i)
        ASSERT_EQ(found.at(i, j), from.view().at(2 * i, 2 * j)) << i << ' ' << j;
  });
}

TYPED_TEST(KernelsTransfer, InjectionUndoesProlongation) {
  using T = TypeParam;
  for_sizes([](int nx, int ny) {
    fields::Random random(4);
    OwnedPlane<T> from(coarse(nx) + 1, coarse(ny) + 1), fine(nx + 1, ny + 1),
        back(coarse(nx) + 1, coarse(ny) + 1);
    from.fill(random, -1.0, 1.0);
    from.set_boundary(T(0));
    kernels::prolong_nodes<T>(from.view(), fine.view());
    kernels::inject_nodes<T>(fine.view(), back.view());
    EXPECT_EQ(back.values(), from.values());
  });
}

TYPED_TEST(KernelsTransfer, MeanOfCellsTakesThoseThatExist) {
  using T = TypeParam;
  for_sizes([](int nx, int ny) {
    fields::Random random(5);
    OwnedPlane<T> from(nx, ny), to(coarse(nx), coarse(ny));
    from.fill(random, -1.0, 1.0);
    kernels::mean_cells<T>(from.view(), to.view());
    for (int J = 0; J < coarse(ny); ++J) {
      for (int I = 0; I < coarse(nx); ++I) {
        double sum = 0.0;
        int count = 0;
        for (int j = 2 * J; j < std::min(ny, 2 * J + 2); ++j)
          for (int i = 2 * I; i < std::min(nx, 2 * I + 2); ++i, ++count)
            sum += double(from.view().at(i, j));
        ASSERT_EQ(to.view().at(I, J), T(sum / count)) << I << ' ' << J;  // exact: 1, 2 or 4 cells
      }
    }
  });
}

TYPED_TEST(KernelsTransfer, InterpolatedCellsAreBilinearBetweenTheCoarseCentres) {
  using T = TypeParam;
  // In units of the fine cells: a fine centre is at i + ½, a coarse one at 2 I + 1. Beyond the
  // outermost coarse centres the value stays.
  const auto function = [](double x, double y) { return 1.0 + 0.5 * x - 0.25 * y + 0.5 * x * y; };
  for_sizes([&](int nx, int ny) {
    OwnedPlane<T> from(coarse(nx), coarse(ny)), to(nx, ny);
    from.set([&](int i, int j) { return function(2 * i + 1, 2 * j + 1); });
    kernels::interpolate_cells<T>(from.view(), to.view());
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const double x = std::clamp(i + 0.5, 1.0, 2.0 * coarse(nx) - 1.0);
        const double y = std::clamp(j + 0.5, 1.0, 2.0 * coarse(ny) - 1.0);
        ASSERT_EQ(to.view().at(i, j), T(function(x, y))) << i << ' ' << j;
      }
    }
  });
}

TYPED_TEST(KernelsTransfer, AConstantStaysConstantInCells) {
  using T = TypeParam;
  for_sizes([](int nx, int ny) {
    OwnedPlane<T> coarse_cells(coarse(nx), coarse(ny)), fine(nx, ny);
    coarse_cells.set([](int, int) { return T(2.5); });
    kernels::interpolate_cells<T>(coarse_cells.view(), fine.view());
    kernels::mean_cells<T>(fine.view(), coarse_cells.view());
    for (const T value : coarse_cells.values()) ASSERT_EQ(value, T(2.5));
    for (const T value : fine.values()) ASSERT_EQ(value, T(2.5));
  });
}

}  // namespace
}  // namespace drumhead
