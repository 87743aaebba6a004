// SPDX-License-Identifier: MIT
#pragma once
// A random level as the oracle sees it. The oracle knows squares of unit cells; an nx × ny lattice
// of cells of side h becomes the corner of an n × n one (n the larger count) whose other cells have
// no stiffness and whose other nodes are no unknowns. With x = x̂/h the kernels' energy is h² times
// the oracle's, P is the same and q = h q_oracle: hence their Hessian is D M D, D = 1 for x and q,
// h for P, and their gradient is h (x) or h² (P) times the oracle's.
#include <functional>

#include "oracle_system.h"
#include "random_fields.h"

namespace drumhead::oracle {

struct KernelOracle {
  OracleScene scene;
  State state;
  Eigen::VectorXd P_H;                 ///< clamped pressures of the Hessian
  Eigen::SparseMatrix<double> matrix;  ///< D M D, curve rows included
  int nx = 0, ny = 0;
  double h = 1.0;

  int first_multiplier() const { return 2 * scene.free_nodes; }
  /// −(first derivatives) at the state with q = 0, in the kernels' units; 0 in the curve rows.
  Eigen::VectorXd force() const;
  /// Values of a lattice's unknowns (and of q, two a cut; empty: 0) in the order of the matrix.
  template <class T>
  Eigen::VectorXd packed(const kernels::Unknowns<const T>& fields,
                         const std::vector<T>& q = {}) const;
  /// Unknowns of x and y of the interior nodes for which wanted(i, j), node after node.
  std::vector<int> nodes(const std::function<bool(int, int)>& wanted) const;
  /// Unknown of P of a cell.
  int cell(int i, int j) const {
    return scene.cell_unknown[std::size_t(j) * std::size_t(scene.n) + std::size_t(i)];
  }
};

template <class T>
KernelOracle kernel_oracle(const fields::RandomLevel<T>& level);

/// Largest difference relative to the largest expected value.
double relative_error(const Eigen::VectorXd& found, const Eigen::VectorXd& expected);

}  // namespace drumhead::oracle
