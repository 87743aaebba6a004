// SPDX-License-Identifier: MIT
#pragma once
// Kaczmarz's method on the rows of the assembled matrix of a random level: the yardstick of
// kernels/kaczmarz.h. Rows and unknowns are scaled by the balanced α and β, computed here from the
// matrix: α² = 20 mu²/Σ B² over all four corners of a cell, β² = 20 mu²/Σ w².
#include <vector>

#include "kernel_oracle.h"

namespace drumhead::oracle {

class KaczmarzOracle {
 public:
  template <class T>
  explicit KaczmarzOracle(const fields::RandomLevel<T>& level);

  const KernelOracle& oracle() const { return oracle_; }
  /// Wᵀ dq in the node rows: the curve forces that the kernels' right-hand side carries.
  Eigen::VectorXd curve_force() const;

  /// One row after the other, over-relaxed.
  void sweep(const std::vector<int>& rows, double omega);
  /// All rows at once, damped.
  void jacobi(double omega);

  /// Rows of the coloured sweep in order: momentum rows, volume rows, curve rows.
  std::vector<int> momentum_rows(bool near_curves) const;
  std::vector<int> volume_rows(bool near_curves) const;
  std::vector<int> curve_rows() const;

  /// |S⁻¹ z|.
  double scaled_norm() const { return (z.array() / scale2_.array().sqrt()).matrix().norm(); }

  Eigen::VectorXd z, right;

 private:
  double step_length(int row) const;
  bool touches_curve(int unknown) const;

  KernelOracle oracle_;
  std::vector<int> cut_column_, cut_row_;
  Eigen::VectorXd scale2_;  ///< 1, α², β²
  Eigen::VectorXd floor_;   ///< added to a volume row's squared norm (see kaczmarz_body.h)
};

}  // namespace drumhead::oracle
