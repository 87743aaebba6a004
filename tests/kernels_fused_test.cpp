// SPDX-License-Identifier: MIT
// The stages that relax.h fuses with a relaxation, against the same done one after the other:
// clear, prolong and relax give the same bits; the restriction is the adjoint of the prolongation,
// applied to the residual that is left.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/transfer.h>

#include "support/kernel_cases.h"

namespace drumhead {
namespace {

using fields::LevelSpec;
using fields::OwnedPlane;
using fields::OwnedUnknowns;
using fields::RandomLevel;
using kernels::Plane;

template <class T>
class KernelsFused : public testing::Test {};
TYPED_TEST_SUITE(KernelsFused, fields::Numbers, fields::NumberName);

const LevelSpec kWithCurves{.cuts = 15, .stiffness = 3.0, .jump = 0.0625};

int coarse(int n) { return (n + 1) / 2; }

template <class T>
OwnedUnknowns<T> coarse_unknowns(const LevelSpec& spec) {
  return {coarse(spec.nx), coarse(spec.ny), spec.pressure};
}

struct Fused {
  bool from_zero = false, prolong = false, restrict = false;
};

/// Relaxes with the stages asked for.
template <class T>
void relax(RandomLevel<T>& level, Fused fused, OwnedUnknowns<T>& coarse_d,
           OwnedUnknowns<T>& coarse_f) {
  kernels::RowScratch<T> scratch(level.spec.nx + 1, 1);
  const kernels::Unknowns<const T> d = coarse_d.view();
  const kernels::Unknowns<T> f = coarse_f.view();
  kernels::relax<T>(level.system(), {.from_zero = fused.from_zero}, fused.prolong ? &d : nullptr,
                    fused.restrict ? &f : nullptr, scratch);
}
template <class T>
void relax(RandomLevel<T>& level) {
  OwnedUnknowns<T> none;
  relax(level, {}, none, none);
}

/// Everything that a relaxation changes.
template <class T>
std::vector<T> state_of(const RandomLevel<T>& level) {
  return fields::joined({level.d.values(), level.f.values(), level.dq});
}

TYPED_TEST(KernelsFused, FromZeroEqualsClearedAndRelaxed) {
  using T = TypeParam;
  fields::for_small_lattices(kWithCurves, [](const LevelSpec& spec) {
    RandomLevel<T> fused(spec), separate(spec);
    OwnedUnknowns<T> none;
    std::ranges::fill(fused.dq, T(0));
    std::ranges::fill(separate.dq, T(0));
    separate.d = OwnedUnknowns<T>(spec.nx, spec.ny, spec.pressure);
    relax(fused, {.from_zero = true}, none, none);
    relax(separate);
    EXPECT_TRUE(fields::same_bits(state_of(fused), state_of(separate)));
  });
}

/// fine += P coarse: bilinear for nodes by the public transfer, constant for cells.
template <class T>
void add_prolonged(const OwnedUnknowns<T>& from, OwnedUnknowns<T>& to) {
  const auto add_nodes = [](const OwnedPlane<T>& source, OwnedPlane<T>& target) {
    OwnedPlane<T> fine(target.view().columns, target.view().rows);
    kernels::prolong_nodes<T>(source.view(), fine.view());
    kernels::combine<T>(T(1), fine.view(), T(1), target.view());
  };
  add_nodes(from.x, to.x);
  add_nodes(from.y, to.y);
  const Plane<T> p = to.p.view();
  to.p.set([&](int i, int j) { return p.at(i, j) + from.p.view().at(i / 2, j / 2); });
}

TYPED_TEST(KernelsFused, ProlongedCorrectionEqualsAddedAndRelaxed) {
  using T = TypeParam;
  fields::for_small_lattices(kWithCurves, [](const LevelSpec& spec) {
    RandomLevel<T> fused(spec), separate(spec);
    OwnedUnknowns<T> correction = coarse_unknowns<T>(spec), none;
    correction.fill(fused.random);
    relax(fused, {.prolong = true}, correction, none);
    add_prolonged(correction, separate.d);
    relax(separate);
    EXPECT_TRUE(fields::same_bits(state_of(fused), state_of(separate)));
  });
}

TYPED_TEST(KernelsFused, RestrictingChangesNothingOnTheFineLattice) {
  using T = TypeParam;
  fields::for_small_lattices(kWithCurves, [](const LevelSpec& spec) {
    RandomLevel<T> fused(spec), separate(spec);
    OwnedUnknowns<T> none, restricted = coarse_unknowns<T>(spec);
    relax(fused, {.restrict = true}, none, restricted);
    relax(separate);
    EXPECT_TRUE(fields::same_bits(state_of(fused), state_of(separate)));
  });
}

/// f − H d of a level.
template <class T>
OwnedUnknowns<T> residual_of(const RandomLevel<T>& level) {
  OwnedUnknowns<T> r(level.spec.nx, level.spec.ny, level.spec.pressure);
  kernels::linear_residual<T>(level.membrane(), level.f.view(), level.d.view(), r.view());
  return r;
}

/// Σ over the interior fine nodes of the bilinear weights of coarse node (I, J).
template <class T>
double restricted_node(const Plane<const T>& fine, int I, int J) {
  double sum = 0.0;
  for (int j = std::max(1, 2 * J - 1); j <= std::min(fine.rows - 2, 2 * J + 1); ++j)
    for (int i = std::max(1, 2 * I - 1); i <= std::min(fine.columns - 2, 2 * I + 1); ++i)
      sum += (i == 2 * I ? 1.0 : 0.5) * (j == 2 * J ? 1.0 : 0.5) * double(fine.at(i, j));
  return sum;
}
template <class T>
double restricted_cell(const Plane<const T>& fine, int I, int J) {
  double sum = 0.0;
  for (int j = 2 * J; j < std::min(fine.rows, 2 * J + 2); ++j)
    for (int i = 2 * I; i < std::min(fine.columns, 2 * I + 2); ++i) sum += double(fine.at(i, j));
  return sum;
}

template <class T>
void expect_restriction(const OwnedUnknowns<T>& fine, const OwnedUnknowns<T>& found) {
  const double tolerance = 10.0 * fields::kRounding<T>;
  const auto expect_nodes = [&](const Plane<const T>& r, const Plane<const T>& restricted) {
    for (int J = 1; J + 1 < restricted.rows; ++J)
      for (int I = 1; I + 1 < restricted.columns; ++I)
        ASSERT_NEAR(restricted.at(I, J), restricted_node(r, I, J), tolerance) << I << ' ' << J;
  };
  expect_nodes(fine.x.view(), found.x.view());
  expect_nodes(fine.y.view(), found.y.view());
  const Plane<const T> p = found.p.view();
  for (int J = 0; J < p.rows; ++J)
    for (int I = 0; I < p.columns; ++I)
      ASSERT_NEAR(p.at(I, J), restricted_cell(fine.p.view(), I, J), tolerance) << I << ' ' << J;
}

TYPED_TEST(KernelsFused, RestrictionIsTheAdjointAppliedToTheResidualLeft) {
  using T = TypeParam;
  fields::for_small_lattices(kWithCurves, [](const LevelSpec& spec) {
    fields::on_every_isa([&] {
      RandomLevel<T> level(spec);
      OwnedUnknowns<T> none, restricted = coarse_unknowns<T>(spec);
      relax(level, {.restrict = true}, none, restricted);
      expect_restriction(residual_of(level), restricted);
    });
  });
}

TYPED_TEST(KernelsFused, RestrictionDoesNotRememberAWiderLattice) {
  using T = TypeParam;
  kernels::RowScratch<T> scratch(61, 1);
  for (const int n : {60, 30, 15, 8, 5}) {
    SCOPED_TRACE(n);
    RandomLevel<T> level({.nx = n, .ny = n});
    OwnedUnknowns<T> restricted = coarse_unknowns<T>(level.spec);
    const kernels::Unknowns<T> f = restricted.view();
    kernels::relax<T>(level.system(), {}, nullptr, &f, scratch);
    expect_restriction(residual_of(level), restricted);
  }
}

TYPED_TEST(KernelsFused, ResidualNormIsThatOfTheResidualOnEveryLattice) {
  using T = TypeParam;
  kernels::RowScratch<T> scratch(18, 1);
  fields::for_small_lattices(kWithCurves, [&](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    const OwnedUnknowns<T> r = residual_of(level);
    const double h = spec.spacing, rows = kernels::dot<T>(r.p.view(), r.p.view()) / (h * h);
    const double expected =
        kernels::dot<T>(r.x.view(), r.x.view()) + kernels::dot<T>(r.y.view(), r.y.view()) + rows;
    const double found = kernels::residual_norm2<T>(level.system(), scratch);
    EXPECT_NEAR(found, expected, 1e-13 * expected);
  });
}

TYPED_TEST(KernelsFused, RestrictionOfWideRowsIsTheAdjoint) {
  using T = TypeParam;
  // Transfers work through a row in pieces of 512 coarse columns.
  for (const int nx : {1021, 1022, 1023, 1024, 1025, 1026, 1027, 2051}) {
    SCOPED_TRACE(nx);
    RandomLevel<T> level({.nx = nx, .ny = 5});
    OwnedUnknowns<T> none, restricted = coarse_unknowns<T>(level.spec);
    relax(level, {.restrict = true}, none, restricted);
    expect_restriction(residual_of(level), restricted);
  }
}

// <R r, v> = <r, P v> for the residual r that the relaxation leaves and any coarse v.
TYPED_TEST(KernelsFused, RestrictionAndProlongationAreAdjoint) {
  using T = TypeParam;
  fields::for_small_lattices({}, [](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    OwnedUnknowns<T> none, restricted = coarse_unknowns<T>(spec), v = coarse_unknowns<T>(spec);
    v.fill(level.random);
    relax(level, {.restrict = true}, none, restricted);
    OwnedUnknowns<T> prolonged(spec.nx, spec.ny, spec.pressure);
    add_prolonged(v, prolonged);
    const double coarse_product = kernels::dot<T>(restricted.view(), v.view());
    const double fine_product = kernels::dot<T>(residual_of(level).view(), prolonged.view());
    EXPECT_NEAR(coarse_product, fine_product, 50.0 * fields::kRounding<T>);
  });
}

TYPED_TEST(KernelsFused, AllStagesTogetherEqualOneAfterTheOther) {
  using T = TypeParam;
  fields::for_small_lattices(kWithCurves, [](const LevelSpec& spec) {
    RandomLevel<T> fused(spec), separate(spec);
    OwnedUnknowns<T> correction = coarse_unknowns<T>(spec), restricted = coarse_unknowns<T>(spec);
    correction.fill(fused.random);
    relax(fused, {.from_zero = true, .prolong = true, .restrict = true}, correction, restricted);
    separate.d = OwnedUnknowns<T>(spec.nx, spec.ny, spec.pressure);
    add_prolonged(correction, separate.d);
    relax(separate);
    EXPECT_TRUE(fields::same_bits(state_of(fused), state_of(separate)));
    expect_restriction(residual_of(separate), restricted);
  });
}

}  // namespace
}  // namespace drumhead
