// SPDX-License-Identifier: MIT
// One relaxation against the same steps on rows of the assembled matrix, in the order of relax.h:
// nodes red, nodes black (both components), volume rows and curve rows there and back; and the same
// in the band beside the curves alone.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>

#include "support/kernel_cases.h"
#include "support/kernel_oracle.h"
#include "support/oracle_relax.h"

namespace drumhead {
namespace {

using Eigen::VectorXd;
using fields::LevelSpec;
using fields::RandomLevel;
using kernels::VolumeSweeps;
using oracle::KernelOracle;

// A volume row's step is shortened by a share of its fixed floor (see relax_body.h).
constexpr double kFloor = 1e-6;

template <class T>
constexpr double kTolerance = std::is_same_v<T, float> ? 2e-4 : 1e-11;

/// The cells within one column and row of a cut one.
class Band {
 public:
  template <class T>
  explicit Band(const RandomLevel<T>& level) : row_(level.cuts.row), column_(level.cuts.column) {}
  bool has(int i, int j) const {
    for (std::size_t k = 0; k < row_.size(); ++k)
      if (std::abs(row_[k] - j) <= 1 && std::abs(column_[k] - i) <= 1) return true;
    return false;
  }
  kernels::Band of_kernels(const int* row_begin, int nx, int ny) const {
    return {{row_begin, row_begin + ny + 1}, column_, nx, 1, false};
  }

 private:
  std::vector<int> row_, column_;
};

/// The relaxation of the oracle.
class Reference {
 public:
  template <class T>
  explicit Reference(const RandomLevel<T>& level)
      : oracle_(oracle::kernel_oracle(level)),
        cut_row_(level.cuts.row),
        floor_(kFloor * oracle_.h * oracle_.h / (4.0 * double(level.mu_value))) {
    z = oracle_.packed<T>(level.d.view(), level.dq);
    // f carries the curve forces; the assembled rows have them on the other side.
    right = oracle_.packed<T>(level.f.view(), level.fq) - curve_force();
  }

  /// Wᵀ dq in the node rows.
  VectorXd curve_force() const {
    const Eigen::Index first = oracle_.scene.q_unknown(0, 0);
    VectorXd only_q = VectorXd::Zero(z.size());
    only_q.tail(z.size() - first) = z.tail(z.size() - first);
    VectorXd force = -(oracle_.matrix * only_q);
    force.tail(z.size() - oracle_.first_multiplier()).setZero();
    return force;
  }

  void relax(const Band* band = nullptr, VolumeSweeps volume_sweeps = VolumeSweeps::twice) {
    band_ = band;
    for (const int colour : {0, 1}) {
      const auto rows =
          oracle_.nodes([&](int i, int j) { return (i + j) % 2 == colour && relaxed(i, j); });
      oracle::gauss_seidel(oracle_.matrix, right, rows, z);
    }
    if (volume_sweeps != VolumeSweeps::reverse)
      for (const int rows : {0, 1}) volume(rows, false);
    for (const int rows : {0, 1}) curves(rows, false);
    for (const int rows : {1, 0}) curves(rows, true);
    if (volume_sweeps != VolumeSweeps::forwards)
      for (const int rows : {1, 0}) volume(rows, true);
  }

  const KernelOracle& oracle() const { return oracle_; }
  VectorXd z, right;

 private:
  void volume(int rows, bool reverse) {
    for (int j = rows; j < oracle_.ny; j += 2)
      for (const int parity : {int(reverse), int(!reverse)})
        for (int i = parity; i < oracle_.nx; i += 2)
          if (const int l = oracle_.cell(i, j); l >= 0 && relaxed(i, j)) shortened_step(l);
  }

  /// Cell (i, j) and the node at its corner 00.
  bool relaxed(int i, int j) const { return !band_ || band_->has(i, j); }

  void shortened_step(int l) {
    const auto& matrix = oracle_.matrix;
    double s = -matrix.coeff(l, l);
    for (Eigen::SparseMatrix<double>::InnerIterator C(matrix, l); C; ++C)
      if (C.row() < oracle_.first_multiplier())
        s += C.value() * C.value() / matrix.coeff(C.row(), C.row());
    const VectorXd before = z;
    oracle::weighted_kaczmarz(matrix, right, oracle_.first_multiplier(), {l}, z);
    z = before + s / (s + floor_) * (z - before);
  }

  void curves(int rows, bool reverse) {
    std::vector<int> order;
    for (int k = 0; k < int(cut_row_.size()); ++k)
      if (cut_row_[std::size_t(k)] % 2 == rows) order.push_back(k);
    // Cell rows of one parity share no node and are not linked: only the order within a row counts.
    if (reverse) std::reverse(order.begin(), order.end());
    std::vector<int> steps;
    for (const int k : order)
      steps.insert(steps.end(), {oracle_.scene.q_unknown(k, 0), oracle_.scene.q_unknown(k, 1)});
    oracle::weighted_kaczmarz(oracle_.matrix, right, oracle_.first_multiplier(), steps, z);
  }

  KernelOracle oracle_;
  std::vector<int> cut_row_;
  double floor_;
  const Band* band_ = nullptr;
};

template <class T>
class KernelsRelax : public testing::Test {};
TYPED_TEST_SUITE(KernelsRelax, fields::Numbers, fields::NumberName);

template <class T>
void relax(RandomLevel<T>& level, VolumeSweeps volume = VolumeSweeps::twice) {
  kernels::RowScratch<T> scratch(level.spec.nx + 1, 1);
  kernels::relax<T>(level.system(), {.volume = volume}, nullptr, nullptr, scratch);
}

/// Relaxes lattices of `base` by kernel and by matrix and compares unknowns and carried forces.
template <class T, class Wanted>
void expect_oracle_relaxation(const LevelSpec& base, Wanted&& wanted,
                              VolumeSweeps volume = VolumeSweeps::twice) {
  fields::for_small_lattices(base, [&](const LevelSpec& spec) {
    if (!wanted(spec)) return;
    const RandomLevel<T> start(spec);
    Reference reference(start);
    const KernelOracle& oracle = reference.oracle();
    reference.relax(nullptr, volume);
    fields::on_every_isa([&] {
      RandomLevel<T> level(spec);
      relax(level, volume);
      const VectorXd found = oracle.template packed<T>(level.d.view(), level.dq);
      EXPECT_LT(oracle::relative_error(found, reference.z), kTolerance<T>);
      const VectorXd carried = oracle.template packed<T>(level.f.view(), level.fq);
      const VectorXd expected = reference.right + reference.curve_force();
      EXPECT_LT(oracle::relative_error(carried, expected), kTolerance<T>);
    });
  });
}

TYPED_TEST(KernelsRelax, NodesAreRedBlackGaussSeidelOfTheAssembledMatrix) {
  expect_oracle_relaxation<TypeParam>({}, [](const LevelSpec& spec) { return !spec.pressure; });
}

TYPED_TEST(KernelsRelax, VolumeRowsAreWeightedKaczmarzOfTheAssembledMatrix) {
  expect_oracle_relaxation<TypeParam>({}, [](const LevelSpec& spec) { return spec.pressure; });
}

TYPED_TEST(KernelsRelax, VolumeRowsWithPressureJumpAreWeightedKaczmarzOfTheAssembledMatrix) {
  expect_oracle_relaxation<TypeParam>({.pressure_jump = 0.5},
                                      [](const LevelSpec& spec) { return spec.pressure; });
}

TYPED_TEST(KernelsRelax, HardCurveRowsAreWeightedKaczmarzOfTheAssembledMatrix) {
  expect_oracle_relaxation<TypeParam>({.cuts = 12},
                                      [](const LevelSpec& spec) { return !spec.pressure; });
}

TYPED_TEST(KernelsRelax, SoftCurveRowsWithJumpAreWeightedKaczmarzOfTheAssembledMatrix) {
  expect_oracle_relaxation<TypeParam>({.cuts = 20, .stiffness = 3.0, .jump = 0.0625},
                                      [](const LevelSpec& spec) { return !spec.pressure; });
}

TYPED_TEST(KernelsRelax, AllRowsTogetherEqualTheAssembledRelaxation) {
  expect_oracle_relaxation<TypeParam>({.cuts = 30, .stiffness = 3.0, .jump = 0.0625},
                                      [](const LevelSpec& spec) { return spec.pressure; });
}

TYPED_TEST(KernelsRelax, VolumeRowsSweptOnceAreSweptBeforeOrAfterTheCurveRows) {
  for (const VolumeSweeps volume : {VolumeSweeps::forwards, VolumeSweeps::reverse})
    expect_oracle_relaxation<TypeParam>(
        {.cuts = 30, .stiffness = 3.0, .jump = 0.0625},
        [](const LevelSpec& spec) { return spec.pressure; }, volume);
}

TYPED_TEST(KernelsRelax, TheBandBesideCurvesEqualsItsPartOfTheAssembledRelaxation) {
  using T = TypeParam;
  for (const LevelSpec& base :
       {LevelSpec{.cuts = 3, .jump = 0.0625},
        LevelSpec{.cuts = 2, .stiffness = 3.0, .jump = 0.0625, .pressure_jump = 0.5}})
    fields::for_small_lattices(base, [&](const LevelSpec& spec) {
      const RandomLevel<T> start(spec);
      const Band band(start);
      Reference reference(start);
      const KernelOracle& oracle = reference.oracle();
      reference.relax(&band);
      fields::on_every_isa([&] {
        RandomLevel<T> level(spec);
        kernels::LevelSystem<T> system = level.system();
        const kernels::Band spans = band.of_kernels(system.cuts.row_begin, spec.nx, spec.ny);
        system.band = &spans;
        kernels::RowScratch<T> scratch(spec.nx + 1, 1);
        kernels::relax<T>(system, {.sweeps = kernels::Sweeps::none, .band = 1}, nullptr, nullptr,
                          scratch);
        const VectorXd found = oracle.template packed<T>(level.d.view(), level.dq);
        EXPECT_LT(oracle::relative_error(found, reference.z), kTolerance<T>);
      });
    });
}

TYPED_TEST(KernelsRelax, AnotherNumberOfBandsIsRefused) {
  using T = TypeParam;
  RandomLevel<T> level({.nx = 4, .ny = 4});
  kernels::RowScratch<T> scratch(5, 1);
  auto refuses = [&](const kernels::LevelSystem<T>& system, int band) {
    EXPECT_THROW(kernels::relax<T>(system, {.band = band}, nullptr, nullptr, scratch),
                 std::invalid_argument);
  };
  kernels::LevelSystem<T> system = level.system();
  refuses(system, 1);  // it has none
  const kernels::Band band;
  system.band = &band;
  for (const int number : {-1, 3}) refuses(system, number);
}

// The solution of the system is what no relaxation changes: the right-hand side is made from d.
TYPED_TEST(KernelsRelax, LeaveASolutionInPlace) {
  using T = TypeParam;
  fields::for_small_lattices({.cuts = 10, .jump = 0.0625}, [](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    const VectorXd before =
        VectorXd(oracle::kernel_oracle(level).template packed<T>(level.d.view(), level.dq));
    const kernels::LevelSystem<T> system = level.system();
    kernels::apply_hessian<T>(system.membrane, system.d, system.f);
    kernels::apply_cuts<T>(system.cuts, system.d, system.dq, level.fq.data());
    relax(level);
    const VectorXd after =
        VectorXd(oracle::kernel_oracle(level).template packed<T>(level.d.view(), level.dq));
    EXPECT_LT(oracle::relative_error(after, before), kTolerance<T>);
  });
}

TYPED_TEST(KernelsRelax, TheFixedBoundaryOfTheCorrectionStaysZero) {
  using T = TypeParam;
  fields::for_small_lattices({.cuts = 10}, [](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    relax(level);
    const std::vector<T> found = level.d.values();
    level.d.x.set_boundary(T(0));
    level.d.y.set_boundary(T(0));
    EXPECT_EQ(found, level.d.values());
  });
}

}  // namespace
}  // namespace drumhead
