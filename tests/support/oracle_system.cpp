// SPDX-License-Identifier: MIT
#include "oracle_system.h"

#include <algorithm>
#include <cmath>

namespace drumhead::oracle {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector4d;
using Eigen::VectorXd;

// Corners in the order 00, 10, 01, 11. The elastic energy of a cell is mu/2 X'SX + mu/2 Y'SY with S
// the Laplacian of the cell's four edges, each of weight ½; J* = X'ZY with Z = (e f' − f e')/2.
Matrix4d edge_laplacian() {
  Matrix4d S;
  S << 1.0, -.5, -.5, 0.0,  // row by row
      -.5, 1.0, 0.0, -.5,   //
      -.5, 0.0, 1.0, -.5,   //
      0.0, -.5, -.5, 1.0;
  return S;
}
Matrix4d area_form() {
  const Vector4d e(-1.0, 0.0, 0.0, 1.0), f(0.0, -1.0, 1.0, 0.0);
  return 0.5 * (e * f.transpose() - f * e.transpose());
}

struct Corners {
  std::array<int, 4> node;
  Vector4d X, Y;
};
Corners corners(const OracleScene& scene, const State& state, int i, int j) {
  Corners c;
  for (int k = 0; k < 4; ++k) {
    const int node = scene.node(i + k % 2, j + k / 2);
    c.node[std::size_t(k)] = node;
    c.X[k] = state.x[node];
    c.Y[k] = state.y[node];
  }
  return c;
}

template <class Visit>
void for_cells(const OracleScene& scene, const Visit& visit) {
  for (int j = 0; j < scene.n; ++j) {
    for (int i = 0; i < scene.n; ++i) visit(i, j, std::size_t(j * scene.n + i));
  }
}

double inverse(double value) { return std::isinf(value) ? 0.0 : 1.0 / value; }

// 1/(d len) of a row, in cells: d is per side of the square, which is n cells.
double softness(const OracleScene& scene, const CutRow& row) {
  return inverse(scene.options.weight / scene.n * row.length);
}

// The q block M as triplets of rows (the same for both axes): 1/(d len) on the diagonal, and for
// each pair qs/mu min(len)² times the square of the difference of q/len.
std::vector<Eigen::Triplet<double>> softness_triplets(const OracleScene& scene) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto& rows = scene.cuts.rows;
  for (int r = 0; r < int(rows.size()); ++r) {
    entries.emplace_back(r, r, softness(scene, rows[std::size_t(r)]));
  }
  if (scene.options.jump == 0.0) return entries;
  for (const auto& [k, l] : scene.cuts.neighbours) {
    const double len_k = rows[std::size_t(k)].length, len_l = rows[std::size_t(l)].length;
    const double shorter = std::min(len_k, len_l);
    const double stiffness = scene.options.jump / scene.jump_mu * shorter * shorter;
    entries.emplace_back(k, k, stiffness / (len_k * len_k));
    entries.emplace_back(l, l, stiffness / (len_l * len_l));
    entries.emplace_back(k, l, -stiffness / (len_k * len_l));
    entries.emplace_back(l, k, -stiffness / (len_k * len_l));
  }
  return entries;
}

void number_unknowns(OracleScene& scene) {
  const int n = scene.n;
  scene.node_unknown.assign(std::size_t((n + 1) * (n + 1)), -1);
  for (int j = 1; j < n; ++j) {
    for (int i = 1; i < n; ++i) {
      scene.node_unknown[std::size_t(scene.node(i, j))] = scene.free_nodes++;
    }
  }
  scene.cell_unknown.assign(std::size_t(n * n), -1);
  for_cells(scene, [&](int, int, std::size_t cell) {
    if (scene.kappa[cell] > 0.0) {
      scene.cell_unknown[cell] = 2 * scene.free_nodes + scene.pressures++;
    }
  });
}

// Second derivatives of L, entry by entry.
class Assembly {
 public:
  explicit Assembly(const OracleScene& scene) : scene_(scene) {}

  void add_cell(const Corners& c, double mu, double P_H) {
    const Matrix4d S = mu * edge_laplacian(), Z = P_H * area_form();
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        add(x(c, a), x(c, b), S(a, b));
        add(y(c, a), y(c, b), S(a, b));
        add_both(x(c, a), y(c, b), Z(a, b));
      }
    }
  }
  void add_pressure(const Corners& c, int p, double kappa) {
    const Vector4d dJ_dX = area_form() * c.Y, dJ_dY = area_form().transpose() * c.X;
    for (int a = 0; a < 4; ++a) {
      add_both(p, x(c, a), dJ_dX[a]);
      add_both(p, y(c, a), dJ_dY[a]);
    }
    add(p, p, -inverse(kappa));
  }
  void add_row(const Corners& c, int r, const std::array<double, 4>& weight) {
    for (int a = 0; a < 4; ++a) {
      add_both(scene_.q_unknown(r, 0), x(c, a), -weight[std::size_t(a)]);
      add_both(scene_.q_unknown(r, 1), y(c, a), -weight[std::size_t(a)]);
    }
  }
  void add_softness() {
    for (const auto& entry : softness_triplets(scene_)) {
      for (int axis = 0; axis < 2; ++axis) {
        add(scene_.q_unknown(entry.row(), axis), scene_.q_unknown(entry.col(), axis),
            -entry.value());
      }
    }
  }
  Eigen::SparseMatrix<double> matrix() const {
    Eigen::SparseMatrix<double> result(scene_.unknowns(), scene_.unknowns());
    result.setFromTriplets(entries_.begin(), entries_.end());
    return result;
  }

 private:
  int x(const Corners& c, int a) const {
    return scene_.node_unknown[std::size_t(c.node[std::size_t(a)])];
  }
  int y(const Corners& c, int a) const { return x(c, a) < 0 ? -1 : x(c, a) + scene_.free_nodes; }
  void add(int row, int column, double value) {
    if (row >= 0 && column >= 0 && value != 0.0) entries_.emplace_back(row, column, value);
  }
  void add_both(int row, int column, double value) {
    add(row, column, value);
    add(column, row, value);
  }

  const OracleScene& scene_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

OracleScene make_scene(const scenes::Scene& scene, int n, double kappa, OracleOptions options) {
  OracleScene result;
  result.n = n;
  result.mu.assign(std::size_t(n * n), 1.0);
  result.kappa = scenes::kappa_cells(scene, n, kappa);
  result.cuts = cut(scene, n);
  result.options = options;
  number_unknowns(result);
  return result;
}

State rest(const OracleScene& scene) {
  const int columns = scene.n + 1;
  State state;
  state.x.resize(columns * columns);
  state.y.resize(columns * columns);
  for (int node = 0; node < columns * columns; ++node) {
    state.x[node] = node % columns;
    state.y[node] = node / columns;
  }
  state.P = VectorXd::Zero(scene.n * scene.n);
  state.q = VectorXd::Zero(2 * Eigen::Index(scene.cuts.rows.size()));
  return state;
}

State moved(const OracleScene& scene, const State& state, const VectorXd& step, double t) {
  State result = state;
  for (std::size_t node = 0; node < scene.node_unknown.size(); ++node) {
    if (const int u = scene.node_unknown[node]; u >= 0) {
      result.x[Eigen::Index(node)] += t * step[u];
      result.y[Eigen::Index(node)] += t * step[u + scene.free_nodes];
    }
  }
  for (std::size_t cell = 0; cell < scene.cell_unknown.size(); ++cell) {
    if (const int u = scene.cell_unknown[cell]; u >= 0) result.P[Eigen::Index(cell)] += t * step[u];
  }
  result.q += t * step.tail(result.q.size());
  return result;
}

double centre_J(const OracleScene& scene, const State& state, int i, int j) {
  const Corners c = corners(scene, state, i, j);
  return c.X.dot(area_form() * c.Y);
}

VectorXd softness_times(const OracleScene& scene, const VectorXd& q) {
  VectorXd result = VectorXd::Zero(q.size());
  for (const auto& entry : softness_triplets(scene)) {
    for (int axis = 0; axis < 2; ++axis) {
      result[2 * entry.row() + axis] += entry.value() * q[2 * entry.col() + axis];
    }
  }
  return result;
}

VectorXd curve_gap(const OracleScene& scene, const State& state) {
  VectorXd gap(state.q.size());
  for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
    const CutRow& row = scene.cuts.rows[r];
    const Corners c = corners(scene, state, row.i, row.j);
    const Eigen::Map<const Vector4d> w(row.weight.data());
    gap.segment<2>(2 * Eigen::Index(r)) = row.target - Vector2d(w.dot(c.X), w.dot(c.Y));
  }
  return gap;
}

double lagrangian(const OracleScene& scene, const State& state) {
  double sum = 0.0;
  for_cells(scene, [&](int i, int j, std::size_t cell) {
    const Corners c = corners(scene, state, i, j);
    const double P = state.P[Eigen::Index(cell)];
    const auto edge2 = [&](int a, int b) {
      return Vector2d(c.X[a] - c.X[b], c.Y[a] - c.Y[b]).squaredNorm();
    };
    sum += scene.mu[cell] / 4.0 * (edge2(1, 0) + edge2(3, 2) + edge2(2, 0) + edge2(3, 1));
    if (scene.cell_unknown[cell] >= 0) {
      const double area =
          0.5 * ((c.X[3] - c.X[0]) * (c.Y[2] - c.Y[1]) - (c.Y[3] - c.Y[0]) * (c.X[2] - c.X[1]));
      sum += P * (area - 1.0) - 0.5 * P * P * inverse(scene.kappa[cell]);
    }
  });
  const VectorXd gap = curve_gap(scene, state);
  const auto& rows = scene.cuts.rows;
  const auto q = [&](int r) { return Vector2d(state.q.segment<2>(2 * r)); };
  for (int r = 0; r < int(rows.size()); ++r) {
    sum += q(r).dot(gap.segment<2>(2 * r)) -
           0.5 * softness(scene, rows[std::size_t(r)]) * q(r).squaredNorm();
  }
  for (const auto& [k, l] : scene.cuts.neighbours) {
    const double len_k = rows[std::size_t(k)].length, len_l = rows[std::size_t(l)].length;
    sum -= scene.options.jump / scene.jump_mu * std::pow(std::min(len_k, len_l), 2) *
           (q(k) / len_k - q(l) / len_l).squaredNorm() / 2.0;
  }
  return sum;
}

VectorXd gradient(const OracleScene& scene, const State& state) {
  VectorXd g = VectorXd::Zero(scene.unknowns());
  const auto add = [&](const Corners& c, const Vector4d& gx, const Vector4d& gy) {
    for (int a = 0; a < 4; ++a) {
      if (const int u = scene.node_unknown[std::size_t(c.node[std::size_t(a)])]; u >= 0) {
        g[u] += gx[a];
        g[u + scene.free_nodes] += gy[a];
      }
    }
  };
  const Matrix4d S = edge_laplacian(), Z = area_form();
  for_cells(scene, [&](int i, int j, std::size_t cell) {
    const Corners c = corners(scene, state, i, j);
    const double P = state.P[Eigen::Index(cell)], mu = scene.mu[cell];
    add(c, mu * S * c.X + P * (Z * c.Y), mu * S * c.Y + P * (Z.transpose() * c.X));
    if (const int u = scene.cell_unknown[cell]; u >= 0) {
      g[u] = c.X.dot(Z * c.Y) - 1.0 - P * inverse(scene.kappa[cell]);
    }
  });
  for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
    const CutRow& row = scene.cuts.rows[r];
    const Vector2d q = state.q.segment<2>(2 * Eigen::Index(r));
    const Eigen::Map<const Vector4d> w(row.weight.data());
    add(corners(scene, state, row.i, row.j), -q.x() * w, -q.y() * w);
  }
  g.tail(state.q.size()) = curve_gap(scene, state) - softness_times(scene, state.q);
  return g;
}

OracleSystem assemble(const OracleScene& scene, const State& state, const VectorXd& P_H) {
  Assembly assembly(scene);
  for_cells(scene, [&](int i, int j, std::size_t cell) {
    const Corners c = corners(scene, state, i, j);
    assembly.add_cell(c, scene.mu[cell], P_H[Eigen::Index(cell)]);
    if (const int p = scene.cell_unknown[cell]; p >= 0) {
      assembly.add_pressure(c, p, scene.kappa[cell]);
    }
  });
  for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
    const CutRow& row = scene.cuts.rows[r];
    assembly.add_row(corners(scene, state, row.i, row.j), int(r), row.weight);
  }
  assembly.add_softness();
  return {assembly.matrix(), gradient(scene, state)};
}

double spring_energy(const OracleScene& scene, const State& state) {
  if (std::isinf(scene.options.weight)) return 0.0;
  const VectorXd gap = curve_gap(scene, state);
  double sum = 0.0;
  for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
    sum += gap.segment<2>(2 * Eigen::Index(r)).squaredNorm() /
           (2.0 * softness(scene, scene.cuts.rows[r]));
  }
  return sum;
}

Energies energies(const OracleScene& scene, const State& state) {
  Energies sums;
  const Matrix4d S = edge_laplacian();
  for_cells(scene, [&](int i, int j, std::size_t cell) {
    const Corners c = corners(scene, state, i, j);
    sums.elastic += 0.5 * scene.mu[cell] * (c.X.dot(S * c.X) + c.Y.dot(S * c.Y));
    if (!std::isinf(scene.kappa[cell])) {
      sums.volume += 0.5 * scene.kappa[cell] * std::pow(centre_J(scene, state, i, j) - 1.0, 2);
    }
  });
  for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
    sums.constraint += 0.5 * softness(scene, scene.cuts.rows[r]) *
                       state.q.segment<2>(2 * Eigen::Index(r)).squaredNorm();
  }
  const double cells = double(scene.n) * scene.n;
  return {sums.elastic / cells, sums.volume / cells, sums.constraint / cells};
}

}  // namespace drumhead::oracle
