// SPDX-License-Identifier: MIT
#pragma once
// The whole Newton system of Setaluri et al. 2014, Eq. 5, assembled as one sparse matrix, with the
// energy and the gradient: the yardstick of the matrix-free kernels, with which it shares no code.
// Lengths are in cells (h = 1, A = 1), so energies are n² times those of the report. With e = x11 −
// x00, f = x01 − x10,
//
//     L(x, P, q) = sum_cells  mu/4 (|x10−x00|² + |x11−x01|² + |x01−x00|² + |x11−x10|²)
//                + sum_cells  P (J* − 1) − P²/(2 kappa),           J* = e × f / 2
//                + sum_cut    q·(b − W x) − |q|²/(2 d len)
//                − sum_pairs  qs/mu min(len_k, len_l)² |q_k/len_k − q_l/len_l|² / 2
//
// Unknowns, in this order: x of every free node (j·(nx+1)+i ascending, the fixed boundary left
// out), y of the same nodes, P of every cell with kappa > 0 (j·nx+i ascending), then (qx, qy) row
// after row.
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "oracle_cut.h"

namespace drumhead::oracle {

struct OracleOptions {
  /// d in units of mu per side of the square; infinity: the rows hold exactly.
  double weight = std::numeric_limits<double>::infinity();
  double jump = 0.0;  ///< qs; 0: no q-jump
};

struct OracleScene {
  int n = 0;                      ///< cells along each side of the square
  std::vector<double> mu, kappa;  ///< per cell, i fastest; kappa in absolute units, 0…infinity
  double jump_mu = 1.0;           ///< the mu of qs/mu
  Cuts cuts;
  OracleOptions options;

  // Index of the unknown, −1 where there is none.
  std::vector<int> node_unknown;  ///< x of a node; its y is node_unknown + free_nodes
  std::vector<int> cell_unknown;  ///< P of a cell
  int free_nodes = 0, pressures = 0;

  int q_unknown(int row, int axis) const { return 2 * free_nodes + pressures + 2 * row + axis; }
  int unknowns() const { return q_unknown(int(cuts.rows.size()), 0); }
  int node(int i, int j) const { return j * (n + 1) + i; }
};

/// mu = 1; kappa (in units of mu) everywhere, or the scene's mask.
OracleScene make_scene(const scenes::Scene& scene, int n, double kappa, OracleOptions options = {});

struct State {
  Eigen::VectorXd x, y;  ///< positions of all nodes, in cells; the fixed ones at rest
  Eigen::VectorXd P;     ///< of all cells; 0 where kappa = 0
  Eigen::VectorXd q;     ///< (qx, qy) row after row
};
State rest(const OracleScene& scene);
/// state + t · step, the step in the order of the unknowns.
State moved(const OracleScene& scene, const State& state, const Eigen::VectorXd& step, double t);

/// J* of a cell.
double centre_J(const OracleScene& scene, const State& state, int i, int j);

/// L(x, P, q), in cell units.
double lagrangian(const OracleScene& scene, const State& state);
/// First derivatives of L in the order of the unknowns.
Eigen::VectorXd gradient(const OracleScene& scene, const State& state);

struct OracleSystem {
  Eigen::SparseMatrix<double>
      matrix;                ///< second derivatives of L with P_H in place of P; both triangles
  Eigen::VectorXd gradient;  ///< of L at the state, with the state's own P
};
/// P_H: per cell, the pressure that enters the second derivatives in x; pass state.P for the true
/// Hessian.
OracleSystem assemble(const OracleScene& scene, const State& state, const Eigen::VectorXd& P_H);

/// The q block alone, q-jump included, applied with its sign turned: M q, so that the curve rows
/// read b − W x − M q = 0.
Eigen::VectorXd softness_times(const OracleScene& scene, const Eigen::VectorXd& q);
/// sum d len/2 |b − W x|², in cell units; 0 where d is infinite.
double spring_energy(const OracleScene& scene, const State& state);
/// b − W x, two entries a row.
Eigen::VectorXd curve_gap(const OracleScene& scene, const State& state);

/// Primal energies per mu and lattice area, as in the report: elastic is 1 at rest.
struct Energies {
  double elastic = 0.0, volume = 0.0, constraint = 0.0;
  double total() const { return elastic + volume + constraint; }
};
/// volume = kappa/2 (J*−1)² (0 where kappa is infinite). constraint = |q|²/(2 d len): at a solution
/// this is d len/2 of the squared gap less the part that the q-jump opened, so that the jump is not
/// counted; the squared gap itself would put a hard curve's constraint energy at 0.1 to 3 where
/// 1e-6 is meant.
Energies energies(const OracleScene& scene, const State& state);

}  // namespace drumhead::oracle
