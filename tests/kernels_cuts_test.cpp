// SPDX-License-Identifier: MIT
// The curve rows alone against the assembled matrix.
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/cuts.h>

#include "support/kernel_cases.h"
#include "support/kernel_oracle.h"

namespace drumhead {
namespace {

using Eigen::VectorXd;
using fields::kRounding;
using fields::LevelSpec;
using fields::OwnedUnknowns;
using fields::RandomLevel;
using oracle::KernelOracle;

template <class T>
class KernelsCuts : public testing::Test {};
TYPED_TEST_SUITE(KernelsCuts, fields::Numbers, fields::NumberName);

/// body(level, oracle) for hard rows, soft rows, and soft rows with jump.
template <class T, class F>
void against_oracle(F&& body) {
  const LevelSpec hard{.cuts = 12}, soft{.cuts = 12, .stiffness = 3.0},
      jumping{.cuts = 25, .stiffness = 3.0, .jump = 0.0625};
  for (const LevelSpec& base : {hard, soft, jumping}) {
    fields::for_small_lattices(base, [&](const LevelSpec& spec) {
      if (spec.pressure) return;
      RandomLevel<T> level(spec);
      body(level, oracle::kernel_oracle(level));
    });
  }
}

/// The curve rows of matrix · (d, dq).
template <class T>
VectorXd curve_rows(const KernelOracle& oracle, const RandomLevel<T>& level) {
  const VectorXd product = oracle.matrix * oracle.packed<T>(level.d.view(), level.dq);
  return product.tail(2 * level.cuts.size());
}

template <class T>
VectorXd as_vector(const std::vector<T>& values) {
  VectorXd result(Eigen::Index(values.size()));
  for (std::size_t n = 0; n < values.size(); ++n) result[Eigen::Index(n)] = double(values[n]);
  return result;
}

TYPED_TEST(KernelsCuts, AppliedRowsEqualTheAssembledOnes) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    std::vector<T> out(level.dq.size());
    kernels::apply_cuts<T>(level.cuts.view(), level.d.view(), level.dq.data(), out.data());
    EXPECT_LT(oracle::relative_error(as_vector(out), curve_rows(oracle, level)), kRounding<T>);
  });
}

TYPED_TEST(KernelsCuts, ResidualIsTheRightHandSideLessTheRows) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    std::vector<T> out(level.dq.size());
    kernels::cuts_residual<T>(level.cuts.view(), level.fq.data(), level.d.view(), level.dq.data(),
                              out.data());
    const VectorXd expected = as_vector(level.fq) - curve_rows(oracle, level);
    EXPECT_LT(oracle::relative_error(as_vector(out), expected), 10.0 * kRounding<T>);
  });
}

TYPED_TEST(KernelsCuts, CurveForceIsTheTransposeOfTheRows) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    OwnedUnknowns<T> none(level.spec.nx, level.spec.ny, false);
    VectorXd expected = -2.0 * (oracle.matrix * oracle.packed<T>(none.view(), level.dq));
    expected.tail(2 * level.cuts.size()).setZero();
    expected += oracle.packed<T>(level.f.view());
    kernels::add_curve_force<T>(level.cuts.view(), level.dq.data(), T(2), level.f.view());
    EXPECT_LT(oracle::relative_error(oracle.packed<T>(level.f.view()), expected), kRounding<T>);
  });
}

TYPED_TEST(KernelsCuts, ComplianceOfEachCutEqualsTheAssembledBlock) {
  using T = TypeParam;
  against_oracle<T>([](RandomLevel<T>& level, const KernelOracle& oracle) {
    std::vector<T> out;
    for (int k = 0; k < level.cuts.size(); ++k) {
      const auto m = kernels::cut_compliance<T>(level.cuts.view(), level.dq.data(), k);
      out.insert(out.end(), {m.x, m.y});
    }
    const VectorXd expected = oracle::softness_times(oracle.scene, as_vector(level.dq));
    EXPECT_LT(oracle::relative_error(as_vector(out), expected), 10.0 * kRounding<T>);
  });
}

// The jump compares tractions q/len: where they are equal it is nothing.
TYPED_TEST(KernelsCuts, AConstantTractionMakesNoJump) {
  using T = TypeParam;
  RandomLevel<T> level({.nx = 17, .ny = 9, .cuts = 40, .jump = 0.0625});
  ASSERT_FALSE(level.cuts.link.empty());
  for (int k = 0; k < level.cuts.size(); ++k) {
    level.dq[2 * std::size_t(k)] = T(0.75) * level.cuts.length[std::size_t(k)];
    level.dq[2 * std::size_t(k) + 1] = T(-2) * level.cuts.length[std::size_t(k)];
  }
  for (int k = 0; k < level.cuts.size(); ++k) {
    const auto m = kernels::cut_compliance<T>(level.cuts.view(), level.dq.data(), k);
    EXPECT_NEAR(m.x, 0.0, kRounding<T>);
    EXPECT_NEAR(m.y, 0.0, kRounding<T>);
  }
}

}  // namespace
}  // namespace drumhead
