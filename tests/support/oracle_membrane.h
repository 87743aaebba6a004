// SPDX-License-Identifier: MIT
#pragma once
// The isotropic membranes by their textbook tensors (first Piola–Kirchhoff stress P(F) and its
// derivative), assembled over the lattice as sparse matrices: the yardstick of the kernels, which
// work with the lengths (ra, rb) instead and share no code with this.
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "oracle_system.h"

namespace drumhead::oracle {

using Matrix2 = Eigen::Matrix2d;

/// A density at F: energy, stress, and the 4×4 second derivative on (F11, F21, F12, F22).
struct PointLaw {
  double energy = 0.0;
  Matrix2 stress = Matrix2::Zero();
  Eigen::Matrix4d tangent = Eigen::Matrix4d::Zero();
};
/// model: arap (the part with mu), one_sided (arap's part with kappa and eps), corotated, linear,
/// neohookean, stvk.
PointLaw law_at(const std::string& model, const Matrix2& F, double mu, double kappa, double eps);

/// nx × ny cells of side h with nodes at x, y (j·(nx+1)+i), one mu and kappa per cell.
struct MembraneLattice {
  std::string model;
  int nx = 0, ny = 0;
  double h = 1.0, eps = 0.2;
  std::vector<double> mu, kappa;
  Eigen::VectorXd x, y;
};

struct MembraneSystem {
  double energy = 0.0;
  Eigen::VectorXd gradient;             ///< x of all nodes, then y
  Eigen::SparseMatrix<double> hessian;  ///< in the same order, the boundary included
};
/// `projected`: every point's tangent with its negative eigenvalues set to 0.
MembraneSystem assemble(const MembraneLattice& lattice, bool projected);

/// Newton's method with the true Hessian on the interior nodes and the scene's curve rows, from a
/// state close to a solution; the moved state. `steps` at most; stops below 1e-12 cells.
State newton(const OracleScene& scene, const std::string& model, double kappa, double eps,
             const State& start, int steps);

}  // namespace drumhead::oracle
