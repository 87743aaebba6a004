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
/// model: arap (the part with mu), one_sided (arap's part with kappa and eps), harmonic, volume
/// (crpm's part with kappa), corotated, linear, neohookean, stvk.
PointLaw law_at(const std::string& model, const Matrix2& F, double mu, double kappa, double eps);

/// nx × ny cells of side h with nodes at x, y (j·(nx+1)+i), one mu and kappa per cell.
struct MembraneLattice {
  std::string model;
  int nx = 0, ny = 0;
  double h = 1.0, eps = 0.2;
  double corner = 1e4;  ///< fold-free: stiffness of its one-sided term
  std::vector<double> mu, kappa;
  Eigen::VectorXd x, y;
};

struct MembraneSystem {
  double energy = 0.0;
  Eigen::VectorXd gradient;             ///< x of all nodes, then y
  Eigen::SparseMatrix<double> hessian;  ///< in the same order, the boundary included
};
/// Mean over a cell's points of the law's projected tangents where F is the same everywhere, on
/// (F11, F21, F12, F22).
Eigen::Matrix4d mean_projected_tangent(const std::string& model, const Matrix2& F, double mu,
                                       double kappa, double eps, double corner);

/// `projected`: every point's tangent with its negative eigenvalues set to 0; those of fold-free's
/// volume part, which Eq. 6 makes up for, to −mu.
MembraneSystem assemble(const MembraneLattice& lattice, bool projected);

/// Newton's method with the true Hessian on the interior nodes and the scene's curve rows, from a
/// state close to a solution; the moved state. `steps` at most; stops below 1e-12 cells.
State newton(const OracleScene& scene, const std::string& model, double kappa, double eps,
             const State& start, int steps);

}  // namespace drumhead::oracle
