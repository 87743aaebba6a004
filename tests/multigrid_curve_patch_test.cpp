// SPDX-License-Identifier: MIT
// The rows along curves relaxed at once, against the same step on the assembled matrix with Eigen's
// factorisation, and the factors of a long thin system against Eigen's.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "curve_patch.h"
#include "envelope.h"
#include "support/kernel_cases.h"
#include "support/oracle_kaczmarz.h"

namespace drumhead {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using fields::LevelSpec;
using fields::RandomLevel;

constexpr double kShift = 1e-8;  // of the largest diagonal entry, as curve_patch.cpp has it

/// Unknowns of q, and of P of the cells that a curve cuts and of their neighbours.
template <class T>
std::vector<int> rows_along_curves(const oracle::KernelOracle& oracle,
                                   const RandomLevel<T>& level) {
  std::vector<int> rows;
  for (int j = 0; level.spec.pressure && j < oracle.ny; ++j)
    for (int i = 0; i < oracle.nx; ++i) {
      bool near = false;
      for (int k = 0; k < level.cuts.size(); ++k)
        near = near || (std::abs(level.cuts.column[std::size_t(k)] - i) <= 1 &&
                        std::abs(level.cuts.row[std::size_t(k)] - j) <= 1);
      if (near) rows.push_back(oracle.cell(i, j));
    }
  for (int k = 0; k < level.cuts.size(); ++k)
    for (const int axis : {0, 1}) rows.push_back(oracle.scene.q_unknown(k, axis));
  return rows;
}

/// r = right − matrix z,  (C D⁻¹ Cᵀ + M) t = r,  u += D⁻¹ Cᵀ t,  λ −= t.
void block_step(const oracle::KernelOracle& oracle, const std::vector<int>& rows,
                const VectorXd& right, VectorXd& z) {
  const MatrixXd matrix(oracle.matrix);
  const Eigen::Index free = oracle.first_multiplier(), count = Eigen::Index(rows.size());
  const VectorXd inverse = matrix.diagonal().head(free).cwiseInverse();
  MatrixXd c(count, free), block(count, count);
  VectorXd residual(count);
  for (Eigen::Index a = 0; a < count; ++a) {
    const auto row = matrix.row(rows[std::size_t(a)]);
    c.row(a) = row.head(free);
    residual[a] = right[rows[std::size_t(a)]] - row.dot(z);
    for (Eigen::Index b = 0; b < count; ++b) block(a, b) = -row[rows[std::size_t(b)]];
  }
  block += c * inverse.asDiagonal() * c.transpose();
  block.diagonal().array() += kShift * block.diagonal().maxCoeff();
  const VectorXd t = block.ldlt().solve(residual);
  z.head(free) += inverse.cwiseProduct(c.transpose() * t);
  for (Eigen::Index a = 0; a < count; ++a) z[rows[std::size_t(a)]] -= t[a];
}

template <class T>
class MultigridCurvePatch : public testing::Test {};
TYPED_TEST_SUITE(MultigridCurvePatch, fields::Numbers, fields::NumberName);

template <class T>
void expect_block_step(const LevelSpec& base) {
  fields::for_small_lattices(base, [](const LevelSpec& spec) {
    RandomLevel<T> level(spec);
    if (level.cuts.size() == 0) return;
    const oracle::KaczmarzOracle before(level);
    const oracle::KernelOracle& oracle = before.oracle();
    VectorXd expected = before.z;
    block_step(oracle, rows_along_curves(oracle, level), before.right, expected);

    grid::MemoryMeter meter;
    multigrid::CurvePatch<T>(level.system(), meter).relax(level.system());
    const double tolerance = std::is_same_v<T, float> ? 1e-3 : 1e-7;
    EXPECT_LT(oracle::relative_error(oracle.packed<T>(level.d.view(), level.dq), expected),
              tolerance);
    const oracle::KaczmarzOracle after(level);  // f carries the new curve forces
    EXPECT_LT(oracle::relative_error(after.right, before.right), tolerance);
    EXPECT_EQ(meter.current(), 0U);
  });
}

TYPED_TEST(MultigridCurvePatch, IsTheStepOfTheAssembledMatrixForSoftRows) {
  expect_block_step<TypeParam>({.cuts = 12, .stiffness = 3.0, .jump = 0.0625});
}

TYPED_TEST(MultigridCurvePatch, IsTheStepOfTheAssembledMatrixWithPressureJump) {
  expect_block_step<TypeParam>(
      {.cuts = 12, .stiffness = 3.0, .jump = 0.0625, .pressure_jump = 0.4});
}

// Random hard rows nearly contradict one another: their multipliers need more digits than float
// has.
TEST(MultigridCurvePatchDouble, IsTheStepOfTheAssembledMatrixForHardRows) {
  expect_block_step<double>({.cuts = 6, .jump = 0.0625});
}

/// A ring of `rows` unknowns, each joined to those up to `reach` away, in a random order.
MatrixXd ring(int rows, int reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  std::vector<int> name(static_cast<std::size_t>(rows));
  for (int k = 0; k < rows; ++k) name[std::size_t(k)] = k;
  std::shuffle(name.begin(), name.end(), random);
  MatrixXd a = MatrixXd::Zero(rows, rows);
  for (int k = 0; k < rows; ++k)
    for (int step = 1; step <= reach; ++step) {
      const int i = name[std::size_t(k)], j = name[std::size_t((k + step) % rows)];
      a(i, j) = a(j, i) = entry(random);
    }
  for (int k = 0; k < rows; ++k) a(k, k) = a.row(k).cwiseAbs().sum() + 0.1;
  return a;
}

multigrid::SparseRows rows_of(const MatrixXd& a) {
  multigrid::SparseRows rows;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      if (a(i, j) != 0.0) rows.add(int(j), a(i, j));
    rows.end_row();
  }
  return rows;
}

TEST(MultigridEnvelope, SolvesLikeEigen) {
  for (const int count : {1, 2, 3, 17, 60})
    for (const int reach : {1, 3}) {
      const MatrixXd a = ring(count, std::min(reach, count - 1), unsigned(count + reach));
      std::vector<double> x(std::size_t(count), 1.0);
      multigrid::Envelope factors;
      factors.factorise(rows_of(a), 0.0);
      factors.solve(x);
      const VectorXd expected = a.ldlt().solve(VectorXd::Ones(count));
      for (int k = 0; k < count; ++k)
        EXPECT_NEAR(x[std::size_t(k)], expected[k], 1e-12 * expected.cwiseAbs().maxCoeff());
    }
}

TEST(MultigridEnvelope, GrowsWithTheLengthAndNotItsSquare) {
  const auto bytes = [](int count) {
    multigrid::Envelope factors;
    factors.factorise(rows_of(ring(count, 2, 7)), 0.0);
    return double(factors.bytes());
  };
  EXPECT_LT(bytes(800), 2.5 * bytes(400));
}

// Two equal rows: with the shift the pivots stay positive, and what the rows agree on is met.
TEST(MultigridEnvelope, RowsThatDependOnOneAnotherKeepThePivotsPositive) {
  MatrixXd a(2, 2);
  a << 4.0, 4.0, 4.0, 4.0;
  std::vector<double> x = {8.0, 8.0};
  multigrid::Envelope factors;
  factors.factorise(rows_of(a), 1e-8);
  factors.solve(x);
  EXPECT_NEAR(4.0 * (x[0] + x[1]), 8.0, 1e-6);
}

}  // namespace
}  // namespace drumhead
