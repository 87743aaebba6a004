// SPDX-License-Identifier: MIT
// The isotropic membranes: the oracle against finite differences, the kernels against the oracle on
// random and degenerate states, and their invariances.
#include <cmath>

#include <drumhead/kernels/blocks.h>
#include <drumhead/kernels/elastic.h>

#include "support/membrane_sample.h"

namespace drumhead {
namespace {

using namespace fields;

TEST(MembraneOracle, StressAndTangentAreDerivativesOfTheEnergy) {
  for (const std::string model :
       {"arap", "one_sided", "harmonic", "volume", "corotated", "linear", "neohookean", "stvk"})
    for (const State& state : states()) {
      if (state.collapsed && model == "neohookean") continue;
      SCOPED_TRACE(model + ", " + state.name);
      const Matrix2d F = state.F;
      const oracle::PointLaw law = oracle::law_at(model, F, 1.5, 2.5, kEps);
      for (int k = 0; k < 4; ++k) {
        auto moved = [&](double step) {
          Matrix2d G = F;
          G.data()[k] += step;
          return oracle::law_at(model, G, 1.5, 2.5, kEps);
        };
        // Richardson's extrapolation of central differences: error of fourth order.
        auto derivative = [&](auto&& value, double h) {
          const auto wide = (value(moved(2 * h)) - value(moved(-2 * h))) / (4 * h);
          const auto narrow = (value(moved(h)) - value(moved(-h))) / (2 * h);
          return (4.0 * narrow - wide) / 3.0;
        };
        const double slope = derivative([](const oracle::PointLaw& l) { return l.energy; }, 1e-3);
        EXPECT_NEAR(law.stress.data()[k], slope, 1e-8 * std::max(1.0, law.stress.norm()));
        for (int row = 0; row < 4; ++row) {
          const double change =
              derivative([row](const oracle::PointLaw& l) { return l.stress.data()[row]; }, 1e-3);
          EXPECT_NEAR(law.tangent(row, k), change, 1e-6 * std::max(1.0, law.tangent.norm()));
        }
      }
    }
}

template <class T>
class KernelsMembranes : public testing::Test {};
TYPED_TEST_SUITE(KernelsMembranes, fields::Numbers, fields::NumberName);

TYPED_TEST(KernelsMembranes, EnergyForceAndHessianEqualTheAssembledOnes) {
  using T = TypeParam;
  for_samples<T>([](Sample<T>& sample, const State& state) {
    const oracle::MembraneSystem expected = assemble(sample.lattice(), false);
    const double h = double(sample.membrane.spacing);
    const kernels::EnergySums sums = kernels::energy<T>(sample.membrane, {}, T(0));
    EXPECT_NEAR(sums.elastic + sums.volume, expected.energy,
                kRounding<T> * std::max(h * h, expected.energy));
    EXPECT_EQ(sums.volume_merit, sums.volume);
    OwnedUnknowns<T> f = sample.unknowns(), d = sample.unknowns(), out = sample.unknowns();
    kernels::force<T>(sample.membrane, f.view());
    const VectorXd force = inside(-expected.gradient, sample.nx, sample.ny);
    EXPECT_LT(relative(packed(f), force, h), kRounding<T>);
    // Where the rotation is not defined the kernels take a finite value, the derivative has none.
    const bool rotates = std::string(state.name) != "folded here and there";
    d.fill(sample.random);
    kernels::apply_hessian<T>(sample.membrane, d.view(), out.view());
    const VectorXd product = inside(expected.hessian * packed(d), sample.nx, sample.ny);
    if (rotates)
      EXPECT_LT(relative(packed(out), product, 1.0), kRounding<T>);
    else
      EXPECT_TRUE(packed(out).allFinite());
  });
}

TYPED_TEST(KernelsMembranes, ProjectedHessianEqualsTheEigenprojection) {
  using T = TypeParam;
  for_samples<T>([](Sample<T>& sample, const State&) {
    sample.membrane.clamp_width = T(1);
    const oracle::MembraneSystem expected = assemble(sample.lattice(), true);
    OwnedUnknowns<T> d = sample.unknowns(), out = sample.unknowns();
    d.fill(sample.random);
    kernels::apply_hessian<T>(sample.membrane, d.view(), out.view());
    const VectorXd product = inside(expected.hessian * packed(d), sample.nx, sample.ny);
    EXPECT_LT(relative(packed(out), product, 1.0), 4.0 * kRounding<T>);
    EXPECT_GE(packed(d).dot(packed(out)), -kRounding<T> * packed(d).squaredNorm());
  });
}

TEST(Membranes, CollapsedCellsHaveFiniteForcesAndHessians) {
  for (const Model model : models()) {
    Sample<double> sample(model, 4, 3, 1.0, 7);
    sample.deform(Matrix2d::Zero(), 0.0);
    for (const double width : {1.0, kExact}) {
      sample.membrane.clamp_width = width;
      OwnedUnknowns<double> d = sample.unknowns(), out = sample.unknowns();
      d.fill(sample.random);
      kernels::apply_hessian<double>(sample.membrane, d.view(), out.view());
      EXPECT_TRUE(packed(out).allFinite()) << name(model);
      kernels::force<double>(sample.membrane, out.view());
      EXPECT_TRUE(packed(out).allFinite()) << name(model);
    }
    EXPECT_TRUE(std::isfinite(kernels::energy<double>(sample.membrane, {}, 0.0).elastic));
  }
}

TEST(Membranes, EnergyIsThatOfTheTurnedState) {
  for (const Model model : models()) {
    SCOPED_TRACE(name(model));
    Sample<double> sample(model, 6, 5, 1.0, 3);
    Matrix2d F;
    F << 1.25, 0.25, -0.125, 0.75;
    auto energy = [&](const Matrix2d& by) {
      sample.deform(by * F, 0.0);
      const kernels::EnergySums sums = kernels::energy<double>(sample.membrane, {}, 0.0);
      return sums.elastic + sums.volume;
    };
    const double still = energy(Matrix2d::Identity()), by70 = energy(turned(70));
    if (model == Model::linear)
      EXPECT_GT(std::abs(by70 - still), 0.1 * still);
    else
      EXPECT_NEAR(by70, still, 1e-12 * still);
  }
}

TEST(Membranes, LinearOneForgetsTurnsOfTheFirstOrderOnly) {
  Sample<double> sample(Model::linear, 5, 5, 1.0, 3);
  auto energy = [&](double degrees) {
    sample.deform(turned(degrees), 0.0);
    const kernels::EnergySums sums = kernels::energy<double>(sample.membrane, {}, 0.0);
    return sums.elastic + sums.volume;
  };
  EXPECT_NEAR(energy(2.0) / energy(1.0), 16.0, 0.1);  // the fourth power of the angle
}

TEST(Membranes, EnergyAlongAStepIsThatOfTheMovedState) {
  for (const Model model : models()) {
    Sample<double> sample(model, 7, 4, 2.0, 5);
    sample.deform(turned(20), 0.05);
    OwnedUnknowns<double> d = sample.unknowns();
    d.fill(sample.random);
    const double step = 0.0625;
    const kernels::EnergySums along = kernels::energy<double>(sample.membrane, d.view(), step);
    const std::vector<double> x = sample.ux.values(), y = sample.uy.values();
    const std::vector<double> dx = d.x.values(), dy = d.y.values();
    auto at = [&](int i, int j) { return std::size_t(j * (sample.nx + 1) + i); };
    sample.ux.set([&](int i, int j) { return x[at(i, j)] + step * dx[at(i, j)]; });
    sample.uy.set([&](int i, int j) { return y[at(i, j)] + step * dy[at(i, j)]; });
    const kernels::EnergySums moved = kernels::energy<double>(sample.membrane, {}, 0.0);
    EXPECT_NEAR(along.elastic, moved.elastic, 1e-12 * moved.elastic) << name(model);
    EXPECT_EQ(along.inverted_cells, moved.inverted_cells) << name(model);
    EXPECT_NEAR(along.least_J, moved.least_J, 1e-12) << name(model);
  }
}

TEST(Membranes, DiagonalBlocksAreThoseOfTheMatrix) {
  for (const Model model : models()) {
    Sample<double> sample(model, 5, 4, 2.0, 11);
    sample.deform(turned(20), 0.05);
    sample.membrane.clamp_width = 1.0;
    const Eigen::MatrixXd matrix = assemble(sample.lattice(), true).hessian;
    OwnedPlane<double> xx(6, 5), xy(6, 5), yy(6, 5);
    kernels::inverse_blocks<double>(sample.membrane, {xx.view(), xy.view(), yy.view()});
    for (int j = 1; j < 4; ++j)
      for (int i = 1; i < 5; ++i) {
        const int x = j * 6 + i, y = x + 30;
        Matrix2d block, inverse;
        block << matrix(x, x), matrix(x, y), matrix(y, x), matrix(y, y);
        inverse << xx.view().at(i, j), xy.view().at(i, j), xy.view().at(i, j), yy.view().at(i, j);
        EXPECT_LT((block * inverse - Matrix2d::Identity()).norm(), 1e-3) << name(model);
      }
  }
}

}  // namespace
}  // namespace drumhead
