// SPDX-License-Identifier: MIT
#pragma once
// The membrane on conforming cells, assembled: the yardstick of the kernels that go over them, with
// which it shares nothing but the geometry (grid::ConformingCells). Lengths are in cells, positions
// (not displacements) are the unknowns. With a(x, r) the deformed area of the polygons of row r and
// A_r their area at rest,
//
//     L(x, P) = sum_regular cells  mu/4 (|x10−x00|² + |x11−x01|² + |x01−x00|² + |x11−x10|²)
//             + sum_triangles      mu/2 A_t |F_t|²
//             + sum_held, soft     s/2 |x − target|²
//             + sum_rows           P (a − A) − A P²/(2 kappa)
//             − sum_joined parts   gamma/2 1/(mu_a + mu_b) (P_a − P_b)²
//
// A row is a regular cell or a part of a special cell: the deformed area of a cell is J* of its
// centre, that of a part the sum of A_t J_t, and both are their outline's shoelace formula. Parts
// of two special cells are joined that have a piece of their outlines in common, not between two
// held nodes; where their kappa differ, by so much less as one is of the other. Nodes: lattice
// nodes j·(nx+1) + i, then the curve nodes.
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <drumhead/grid/conforming.h>

namespace drumhead::oracle {

/// Two coordinates for every node, in cells.
using Positions = Eigen::MatrixX2d;

struct ConformingRow {
  std::vector<int> outline;  ///< polygon, counter-clockwise
  double area = 0.0;
  double kappa = 0.0;  ///< > 0, infinity allowed
};

struct ConformingMembrane {
  grid::ConformingCells cells;
  Positions rest, target;  ///< target: of the known and the soft nodes; elsewhere rest
  std::vector<char> known;
  Eigen::VectorXd spring;                 ///< s, 0 where no soft curve holds the node
  Eigen::SparseMatrix<double> stiffness;  ///< of the triangles and regular cells, all nodes
  std::vector<ConformingRow> rows;
  Eigen::SparseMatrix<double> jump;  ///< J of −½ Pᵀ J P, what joined parts add to L
  bool joined(std::size_t row) const {
    return jump.coeff(Eigen::Index(row), Eigen::Index(row)) > 0.0;
  }
  std::vector<int> unknown;  ///< number of a node among the unknown ones, −1: known
  int unknowns = 0;          ///< nodes
};

/// mu = 1; kappa per lattice cell, i fastest (special cells hand theirs to their parts). `gamma`:
/// of the joined parts, as the solver has it.
ConformingMembrane conforming_membrane(const std::vector<grid::CurvePair>& curves,
                                       const grid::Lattice& lattice,
                                       const std::vector<double>& kappa, double gamma = 0.5);

struct ConformingState {
  Positions x;
  Eigen::VectorXd P;  ///< per row
};

double deformed_area(const ConformingRow& row, const Positions& x);
/// B: derivatives of the deformed areas with respect to the unknowns (x, then y).
Eigen::SparseMatrix<double> area_derivatives(const ConformingMembrane& membrane,
                                             const Positions& x);
/// Second derivatives of L in x with the given pressures.
Eigen::SparseMatrix<double> hessian(const ConformingMembrane& membrane,
                                    const Eigen::VectorXd& pressure);
double elastic_energy(const ConformingMembrane& membrane, const Positions& x);
double spring_energy(const ConformingMembrane& membrane, const Positions& x);

/// Energies per mu and lattice area; elastic is 1 at rest.
struct ConformingEnergy {
  double elastic = 0.0, volume = 0.0, constraint = 0.0;
  double total() const { return elastic + volume + constraint; }
};
ConformingEnergy energy(const ConformingMembrane& membrane, const ConformingState& state);

/// ∂L/∂x of the unknown nodes (x, then y), then ∂L/∂P.
Eigen::VectorXd gradient(const ConformingMembrane& membrane, const ConformingState& state);

struct ConformingResult {
  ConformingState state;
  bool converged = false;
};
/// Newton's method with the clamp schedule from the solution without pressures, or from positions
/// `start` of the unknown nodes (which a solution keeps in the first step, that finds its P); each
/// system is solved directly, pressures condensed with kappa ≤ 1e4 and what that leaves refined
/// away.
ConformingResult newton(const ConformingMembrane& membrane, const Positions* start = nullptr,
                        int most_steps = 60);

}  // namespace drumhead::oracle
