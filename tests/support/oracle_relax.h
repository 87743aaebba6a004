// SPDX-License-Identifier: MIT
#pragma once
// One relaxation step at a time, taken from rows of the assembled matrix: the yardstick of the
// matrix-free sweeps. A sweep is the same steps over a list of rows; lists of the usual colours are
// below. `right` is the right side of matrix · z = right, z the iterate, both in the order of the
// oracle's unknowns.
#include <vector>

#include "oracle_system.h"

namespace drumhead::oracle {

/// For each unknown u of `rows`, one after another: z_u += (right − matrix z)_u / matrix_uu.
void gauss_seidel(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& right,
                  const std::vector<int>& rows, Eigen::VectorXd& z);

/// For each multiplier l (a P or q unknown) of `rows`, one after another, Kaczmarz on its row C u −
/// M lambda in the inner product of D = diag(K):
///     r = (right − matrix z)_l,  s = sum_i C_i²/K_ii + M_ll,  u_i += C_i r/(s K_ii),  lambda_l −=
///     r/s.
/// Unknowns before `first_multiplier` are u. K_ii is taken from the matrix.
void weighted_kaczmarz(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& right,
                       int first_multiplier, const std::vector<int>& rows, Eigen::VectorXd& z);

/// Unknowns of the free nodes with (i + j) % 2 == colour, x for axis 0 and y for axis 1.
std::vector<int> node_colour(const OracleScene& scene, int axis, int colour);
/// P unknowns of the cells with (i % 2, j % 2) == (colour % 2, colour / 2).
std::vector<int> cell_colour(const OracleScene& scene, int colour);
/// Both q unknowns of the cut cells of that colour, in the order of the rows.
std::vector<int> cut_colour(const OracleScene& scene, int colour);

}  // namespace drumhead::oracle
