// SPDX-License-Identifier: MIT
// The isotropic membranes' coarse operators and corner pressures, and the same bits of all their
// kernels on every instruction set and number of threads.
#include <cmath>

#include <drumhead/kernels/blocks.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/threads.h>

#include "support/membrane_sample.h"

namespace drumhead {
namespace {

using namespace fields;

/// The upper triangle, by rows, of a cell's projected tangent at F on (a₁, a₂, b₁, b₂).
std::vector<double> tangent_entries(const std::string& model, const Matrix2d& F, double mu,
                                    double kappa) {
  Eigen::Matrix4d to_ab;  // from (F11, F21, F12, F22)
  to_ab << 1, 0, 0, 1, 0, 1, -1, 0, 1, 0, 0, -1, 0, 1, 1, 0;
  to_ab /= std::sqrt(2.0);
  const Eigen::Matrix4d tangent =
      to_ab * oracle::mean_projected_tangent(model, F, mu, kappa, kEps, kCorner) *
      to_ab.transpose();
  std::vector<double> entries;
  for (int row = 0; row < 4; ++row)
    for (int column = row; column < 4; ++column) entries.push_back(tangent(row, column));
  return entries;
}
Matrix2d some_F() {
  Matrix2d F;
  F << 0.5, 0.25, -0.25, 0.125;
  return turned(20) * F;
}

TEST(Membranes, CoarseTangentsAreMeansOfTheFineOnes) {
  for (const Model model : models())
    for (const int n : {4, 5}) {
      Sample<double> sample(model, n, n, 1.0, 13);
      sample.deform(some_F(), 0.0);
      sample.membrane.clamp_width = 1.0;
      const int half = (n + 1) / 2, quarter = (half + 1) / 2;
      OwnedPlane<double> coarse(half, 10 * half), coarser(quarter, 10 * quarter);
      kernels::average_tangents<double>(sample.membrane, coarse.view());
      kernels::Membrane<double> below = sample.membrane;
      below.tangent = coarse.view();
      kernels::average_tangents<double>(below, coarser.view());
      auto mean = [&](int first_i, int first_j, int size, int e) {
        double sum = 0.0;
        int count = 0;
        for (int j = first_j; j < std::min(n, first_j + size); ++j)
          for (int i = first_i; i < std::min(n, first_i + size); ++i, ++count)
            sum += tangent_entries(std::string(name(model)), some_F(), sample.mu.view().at(i, j),
                                   sample.kappa.view().at(i, j))[std::size_t(e)];
        return sum / count;
      };
      for (int e = 0; e < 10; ++e) {
        EXPECT_NEAR(coarse.view().at(half - 1, e * half), mean(2 * half - 2, 0, 2, e), 1e-11)
            << name(model) << ", entry " << e;
        EXPECT_NEAR(coarser.view().at(0, e * quarter), mean(0, 0, 4, e), 1e-11)
            << name(model) << ", entry " << e;
      }
    }
}

TEST(Membranes, GivenTangentsMakeTheOperatorOfTheStateTheyAreOf) {
  for (const Model model : models()) {
    // Integrated at the corners, partly.
    if (model == Model::arap || model == Model::fold_free) continue;
    Sample<double> sample(model, 6, 5, 2.0, 13);
    sample.deform(some_F(), 0.0);
    sample.membrane.clamp_width = 1.0;
    OwnedPlane<double> tangent(6, 50);
    tangent.set([&](int i, int row) {
      return tangent_entries(std::string(name(model)), some_F(), sample.mu.view().at(i, row % 5),
                             sample.kappa.view().at(i, row % 5))[std::size_t(row / 5)];
    });
    OwnedUnknowns<double> d = sample.unknowns(), out = sample.unknowns(), given = sample.unknowns();
    d.fill(sample.random);
    kernels::apply_hessian<double>(sample.membrane, d.view(), out.view());
    OwnedPlane<double> block[6];
    for (auto& b : block) b = OwnedPlane<double>(7, 6);
    kernels::inverse_blocks<double>(sample.membrane,
                                    {block[0].view(), block[1].view(), block[2].view()});
    sample.membrane.tangent = tangent.view();
    kernels::apply_hessian<double>(sample.membrane, d.view(), given.view());
    kernels::inverse_blocks<double>(sample.membrane,
                                    {block[3].view(), block[4].view(), block[5].view()});
    EXPECT_LT(relative(packed(given), packed(out), 1.0), 1e-12) << name(model);
    for (int n = 0; n < 3; ++n)
      for (int i = 1; i < 6; ++i)
        EXPECT_NEAR(block[n].view().at(i, 2), block[n + 3].view().at(i, 2), 1e-10) << name(model);
  }
}

template <class T>
class MembraneBits : public testing::Test {};
TYPED_TEST_SUITE(MembraneBits, fields::Numbers, fields::NumberName);

/// Everything the kernels compute for a sample, one after the other.
template <class T>
std::vector<T> everything(Model model, int nx, int ny) {
  Sample<T> sample(model, nx, ny, 1.0, 17);
  sample.deform(turned(20), 0.1);
  OwnedUnknowns<T> d = sample.unknowns(), f = sample.unknowns(), product = sample.unknowns();
  OwnedPlane<T> block[3], shift[4], tangent((nx + 1) / 2, 10 * ((ny + 1) / 2));
  for (auto& b : block) b = OwnedPlane<T>(nx + 1, ny + 1);
  for (int n = 0; n < 4; ++n) {
    shift[n] = OwnedPlane<T>(nx, ny);
    shift[n].fill(sample.random, -0.5, 0.0);
    sample.membrane.law.shift[n] = shift[n].view();
  }
  sample.membrane.law.relief = T(8);
  sample.membrane.law.onset = T(0.125);
  sample.membrane.clamp_width = T(2);
  d.fill(sample.random);
  const kernels::EnergySums sums = kernels::energy<T>(sample.membrane, d.view(), T(0.0625));
  kernels::force<T>(sample.membrane, f.view());
  const std::vector<T> force = f.values();
  kernels::inverse_blocks<T>(sample.membrane, {block[0].view(), block[1].view(), block[2].view()});
  for (int n = 0; n < 3; ++n) sample.membrane.inverse_block[n] = block[n].view();
  kernels::average_tangents<T>(sample.membrane, tangent.view());
  OwnedUnknowns<T> coarse((nx + 1) / 2, (ny + 1) / 2, false);
  const kernels::LevelSystem<T> system{.membrane = sample.membrane,
                                       .d = d.view(),
                                       .f = f.view(),
                                       .product = product.view(),
                                       .largest = T(2.5)};
  kernels::RowScratch<T> scratch(nx + 1, kernels::thread_limit());
  const kernels::Unknowns<T> below = coarse.view();
  kernels::relax<T>(system, {}, nullptr, &below, scratch);
  const T norm = T(kernels::residual_norm2<T>(system, scratch));
  const std::vector<T> relaxed = d.values();
  const T largest = T(kernels::largest_eigenvalue<T>(system, 3));
  kernels::update_corner_pressure<T>(
      sample.membrane, {shift[0].view(), shift[1].view(), shift[2].view(), shift[3].view()});
  return joined({force,
                 relaxed,
                 coarse.values(),
                 block[0].values(),
                 block[1].values(),
                 tangent.values(),
                 shift[0].values(),
                 shift[3].values(),
                 {T(sums.elastic), T(sums.volume), T(sums.least_J), norm, largest}});
}

TYPED_TEST(MembraneBits, HaveTheScalarBitsOnEveryInstructionSet) {
  using T = TypeParam;
  for (const Model model : models())
    for (int nx = 2; nx < 40; ++nx) {
      std::vector<T> expected;
      {
        const ForcedIsa scalar(kernels::Isa::scalar);
        expected = everything<T>(model, nx, 2 + nx % 5);
      }
      on_every_isa([&] {
        ASSERT_TRUE(same_bits(everything<T>(model, nx, 2 + nx % 5), expected))
            << name(model) << ", " << nx;
      });
    }
}

TYPED_TEST(MembraneBits, HaveTheSameBitsForEveryNumberOfThreads) {
  using T = TypeParam;
  for (const Model model : {Model::arap, Model::fold_free, Model::neohookean}) {
    const kernels::ThreadLimit one(1);
    const std::vector<T> expected = everything<T>(model, 480, 481);
    for (const int threads : {2, 3}) {
      const kernels::ThreadLimit several(threads);
      EXPECT_TRUE(same_bits(everything<T>(model, 480, 481), expected)) << threads;
    }
  }
}

// A coarse row takes two fine ones: on the lattice above that is work for one thread.
TYPED_TEST(MembraneBits, CoarseTangentsHaveTheSameBitsForEveryNumberOfThreads) {
  using T = TypeParam;
  constexpr int nx = 700, ny = 701;
  Sample<T> sample(Model::arap, nx, ny, 1.0, 17);
  sample.deform(turned(20), 0.1);
  const auto tangents = [&](int threads) {
    const kernels::ThreadLimit limit(threads);
    OwnedPlane<T> tangent((nx + 1) / 2, 10 * ((ny + 1) / 2));
    kernels::average_tangents<T>(sample.membrane, tangent.view());
    return tangent.values();
  };
  const std::vector<T> expected = tangents(1);
  for (const int threads : {2, 3}) EXPECT_TRUE(same_bits(tangents(threads), expected)) << threads;
}

TEST(Arap, CornerPressuresReachTheFixedPointOfThePenaltyAskedFor) {
  Sample<double> sample(Model::arap, 3, 3, 1.0, 19);
  Matrix2d F;
  F << 0.25, 0.0, 0.0, 0.5;  // J = .125, .075 under eps
  sample.deform(F, 0.0);
  OwnedPlane<double> shift[4];
  for (int n = 0; n < 4; ++n) {
    shift[n] = OwnedPlane<double>(3, 3);
    sample.membrane.law.shift[n] = shift[n].view();
  }
  sample.membrane.law.relief = 8.0;
  for (int n = 0; n < 200; ++n)
    kernels::update_corner_pressure<double>(
        sample.membrane, {shift[0].view(), shift[1].view(), shift[2].view(), shift[3].view()});
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(8.0 * shift[2].view().at(i, j), sample.kappa.view().at(i, j) * (0.125 - kEps),
                  1e-9);
}

TEST(Arap, AGradualOnsetIsTheParabolaBelowItAndNothingAbove) {
  Sample<double> sample(Model::arap, 3, 3, 1.0, 19);
  const double w = 0.125;
  auto energy_of_corners = [&](double J, double onset) {
    Matrix2d F;
    F << J, 0.0, 0.0, 1.0;
    sample.deform(F, 0.0);
    sample.membrane.law.onset = onset;
    return kernels::energy<double>(sample.membrane, {}, 0.0).volume;
  };
  double kappa = 0.0;
  for (const double of_cell : sample.kappa.values()) kappa += of_cell;
  EXPECT_EQ(energy_of_corners(kEps + w, w), 0.0);
  EXPECT_NEAR(energy_of_corners(kEps, w), kappa * w * w / 12.0, 1e-12);
  EXPECT_NEAR(energy_of_corners(kEps - w, w), kappa * w * w * 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(energy_of_corners(kEps - 0.5, w),
              energy_of_corners(kEps - 0.5, 0.0) + kappa * w * w / 6.0, 1e-11);
}

TEST(Arap, ForceAndHessianOfAGradualOnsetAreDerivatives) {
  for (const double J : {0.05, 0.15, 0.2, 0.25, 0.35}) {
    Sample<double> sample(Model::arap, 4, 3, 1.0, 23);
    sample.membrane.law.onset = 0.125;
    Matrix2d F;
    F << 0.5, 0.25, -0.25, 2.0 * J - 0.125;
    sample.deform(F, 0.0);
    OwnedUnknowns<double> d = sample.unknowns(), f = sample.unknowns(), product = sample.unknowns();
    d.fill(sample.random);
    kernels::force<double>(sample.membrane, f.view());
    kernels::apply_hessian<double>(sample.membrane, d.view(), product.view());
    auto energy = [&](double step) {
      const kernels::EnergySums sums = kernels::energy<double>(sample.membrane, d.view(), step);
      return sums.elastic + sums.volume;
    };
    const double h = 1e-4, slope = -packed(d).dot(packed(f)), bend = packed(d).dot(packed(product));
    EXPECT_NEAR((energy(h) - energy(-h)) / (2 * h), slope, 1e-5 * std::abs(bend)) << J;
    EXPECT_NEAR((energy(h) - 2 * energy(0) + energy(-h)) / (h * h), bend, 2e-3 * std::abs(bend))
        << J;
  }
}

}  // namespace
}  // namespace drumhead
