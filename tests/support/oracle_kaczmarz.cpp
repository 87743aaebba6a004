// SPDX-License-Identifier: MIT
#include "oracle_kaczmarz.h"

#include <cmath>

namespace drumhead::oracle {
namespace {

using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;

constexpr double kCollapsed = 1e-6;

// h² |F|² of a cell from the positions of its corners, in finest cells.
double gradient_norm2(const KernelOracle& oracle, int i, int j) {
  const auto at = [&](int di, int dj) {
    const int node = oracle.scene.node(i + di, j + dj);
    return Eigen::Vector2d(oracle.state.x[node], oracle.state.y[node]);
  };
  // Mean of the two parallel edges: a column of F at the centre.
  const Eigen::Vector2d along_x = 0.5 * (at(1, 0) - at(0, 0) + at(1, 1) - at(0, 1));
  const Eigen::Vector2d along_y = 0.5 * (at(0, 1) - at(0, 0) + at(1, 1) - at(1, 0));
  return oracle.h * oracle.h * (along_x.squaredNorm() + along_y.squaredNorm());
}

}  // namespace

template <class T>
KaczmarzOracle::KaczmarzOracle(const fields::RandomLevel<T>& level)
    : z(),
      right(),
      oracle_(kernel_oracle(level)),
      cut_column_(level.cuts.column),
      cut_row_(level.cuts.row),
      scale2_(VectorXd::Ones(oracle_.scene.unknowns())),
      floor_(VectorXd::Zero(oracle_.scene.unknowns())) {
  const OracleScene& scene = oracle_.scene;
  const double floor = kCollapsed * oracle_.h * oracle_.h;
  const auto mu = [&](int i, int j) { return scene.mu[std::size_t(j * scene.n + i)]; };
  for (int j = 0; j < oracle_.ny; ++j)
    for (int i = 0; i < oracle_.nx; ++i) {
      const int p = oracle_.cell(i, j);
      if (p < 0) continue;
      floor_[p] = floor;
      scale2_[p] = 20.0 * std::pow(mu(i, j), 2) / (gradient_norm2(oracle_, i, j) + floor);
    }
  for (int k = 0; k < int(cut_column_.size()); ++k) {
    const CutRow& row = scene.cuts.rows[std::size_t(k)];
    double sum = 0.0;
    for (const double w : row.weight) sum += w * w;
    for (const int axis : {0, 1})
      scale2_[scene.q_unknown(k, axis)] = 20.0 * std::pow(mu(row.i, row.j), 2) / sum;
  }
  z = oracle_.packed<T>(level.d.view(), level.dq);
  right = oracle_.packed<T>(level.f.view(), level.fq) - curve_force();
}

VectorXd KaczmarzOracle::curve_force() const {
  const Eigen::Index first = oracle_.scene.q_unknown(0, 0);
  VectorXd only_q = VectorXd::Zero(z.size());
  only_q.tail(z.size() - first) = z.tail(z.size() - first);
  VectorXd force = -(oracle_.matrix * only_q);
  force.tail(z.size() - oracle_.first_multiplier()).setZero();
  return force;
}

// residual/|row|², the row scaled on the side of the unknowns.
double KaczmarzOracle::step_length(int row) const {
  double residual = right[row], norm2 = floor_[row];
  for (Matrix::InnerIterator a(oracle_.matrix, row); a; ++a) {
    residual -= a.value() * z[a.row()];
    norm2 += scale2_[a.row()] * a.value() * a.value();
  }
  return residual / norm2;
}

void KaczmarzOracle::sweep(const std::vector<int>& rows, double omega) {
  for (const int row : rows) {
    const double delta = omega * step_length(row);
    for (Matrix::InnerIterator a(oracle_.matrix, row); a; ++a)
      z[a.row()] += delta * scale2_[a.row()] * a.value();
  }
}

void KaczmarzOracle::jacobi(double omega) {
  VectorXd delta(z.size());
  for (int row = 0; row < int(z.size()); ++row) delta[row] = omega * step_length(row);
  z += scale2_.cwiseProduct(oracle_.matrix * delta);
}

bool KaczmarzOracle::touches_curve(int unknown) const {
  const int first = oracle_.scene.q_unknown(0, 0);
  for (Matrix::InnerIterator a(oracle_.matrix, unknown); a; ++a)
    if (a.row() >= first) return true;
  return false;
}

std::vector<int> KaczmarzOracle::momentum_rows(bool near_curves) const {
  std::vector<int> rows;
  const auto& unknown = oracle_.scene.node_unknown;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      for (const int axis : {0, 1})
        for (int j = 1; j < oracle_.ny; ++j)
          for (int i = 1; i < oracle_.nx; ++i) {
            if (j % 3 != row || i % 4 != column) continue;
            const int u = unknown[std::size_t(oracle_.scene.node(i, j))];
            if (near_curves && !touches_curve(u)) continue;
            rows.push_back(u + axis * oracle_.scene.free_nodes);
          }
  return rows;
}

std::vector<int> KaczmarzOracle::volume_rows(bool near_curves) const {
  std::vector<int> rows;
  for (int colour = 0; colour < 4; ++colour)
    for (int j = colour / 2; j < oracle_.ny; j += 2)
      for (int i = colour % 2; i < oracle_.nx; i += 2) {
        bool wanted = !near_curves;
        for (std::size_t k = 0; k < cut_row_.size(); ++k)
          wanted = wanted || (cut_row_[k] == j && cut_column_[k] == i);
        if (const int p = oracle_.cell(i, j); wanted && p >= 0) rows.push_back(p);
      }
  return rows;
}

std::vector<int> KaczmarzOracle::curve_rows() const {
  std::vector<int> rows;
  for (int k = 0; k < int(cut_row_.size()); ++k)
    for (const int axis : {0, 1}) rows.push_back(oracle_.scene.q_unknown(k, axis));
  return rows;
}

template KaczmarzOracle::KaczmarzOracle(const fields::RandomLevel<float>&);
template KaczmarzOracle::KaczmarzOracle(const fields::RandomLevel<double>&);

}  // namespace drumhead::oracle
