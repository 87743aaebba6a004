// SPDX-License-Identifier: MIT
#include "oracle_relax.h"

namespace drumhead::oracle {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

// The matrix is symmetric, so a column, which can be walked, serves as the row.
double residual_of(const Matrix& matrix, const Eigen::VectorXd& right, const Eigen::VectorXd& z,
                   int row) {
  double residual = right[row];
  for (Matrix::InnerIterator entry(matrix, row); entry; ++entry) {
    residual -= entry.value() * z[entry.row()];
  }
  return residual;
}

}  // namespace

void gauss_seidel(const Matrix& matrix, const Eigen::VectorXd& right, const std::vector<int>& rows,
                  Eigen::VectorXd& z) {
  for (const int u : rows) z[u] += residual_of(matrix, right, z, u) / matrix.coeff(u, u);
}

void weighted_kaczmarz(const Matrix& matrix, const Eigen::VectorXd& right, int first_multiplier,
                       const std::vector<int>& rows, Eigen::VectorXd& z) {
  for (const int l : rows) {
    const double r = residual_of(matrix, right, z, l);
    double s = -matrix.coeff(l, l);
    for (Matrix::InnerIterator C(matrix, l); C; ++C) {
      if (C.row() < first_multiplier) s += C.value() * C.value() / matrix.coeff(C.row(), C.row());
    }
    for (Matrix::InnerIterator C(matrix, l); C; ++C) {
      if (C.row() < first_multiplier) {
        z[C.row()] += C.value() * r / (s * matrix.coeff(C.row(), C.row()));
      }
    }
    z[l] -= r / s;
  }
}

std::vector<int> node_colour(const OracleScene& scene, int axis, int colour) {
  std::vector<int> rows;
  for (int j = 1; j < scene.n; ++j) {
    for (int i = 1; i < scene.n; ++i) {
      if ((i + j) % 2 != colour) continue;
      rows.push_back(scene.node_unknown[std::size_t(scene.node(i, j))] + axis * scene.free_nodes);
    }
  }
  return rows;
}

std::vector<int> cell_colour(const OracleScene& scene, int colour) {
  std::vector<int> rows;
  for (int j = colour / 2; j < scene.n; j += 2) {
    for (int i = colour % 2; i < scene.n; i += 2) {
      if (const int u = scene.cell_unknown[std::size_t(j * scene.n + i)]; u >= 0) rows.push_back(u);
    }
  }
  return rows;
}

std::vector<int> cut_colour(const OracleScene& scene, int colour) {
  std::vector<int> rows;
  for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
    const CutRow& row = scene.cuts.rows[r];
    if (row.i % 2 != colour % 2 || row.j % 2 != colour / 2) continue;
    rows.push_back(scene.q_unknown(int(r), 0));
    rows.push_back(scene.q_unknown(int(r), 1));
  }
  return rows;
}

}  // namespace drumhead::oracle
