// SPDX-License-Identifier: MIT
#include "kernel_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumhead::oracle {
namespace {

using Eigen::VectorXd;
using fields::RandomLevel;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int index) { return static_cast<std::size_t>(index); }

void number_unknowns(OracleScene& scene, int nx, int ny) {
  const int n = scene.n;
  scene.node_unknown.assign(at((n + 1) * (n + 1)), -1);
  scene.cell_unknown.assign(at(n * n), -1);
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) scene.node_unknown[at(scene.node(i, j))] = scene.free_nodes++;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (scene.kappa[at(j * n + i)] > 0.0)
        scene.cell_unknown[at(j * n + i)] = 2 * scene.free_nodes + scene.pressures++;
}

template <class T>
void set_material(const RandomLevel<T>& level, OracleScene& scene) {
  const int n = scene.n;
  scene.mu.assign(at(n * n), 0.0);
  scene.kappa.assign(at(n * n), 0.0);
  for (int j = 0; j < level.spec.ny; ++j)
    for (int i = 0; i < level.spec.nx; ++i) {
      const kernels::Plane<const T> mu = level.mu.view(), soft = level.compliance.view();
      scene.mu[at(j * n + i)] = double(mu ? mu.at(i, j) : level.mu_value);
      if (!level.spec.pressure) continue;
      const auto compliance = double(soft ? soft.at(i, j) : level.compliance_value);
      scene.kappa[at(j * n + i)] = compliance == 0.0 ? kInfinity : 1.0 / compliance;
    }
}

template <class T>
void set_cuts(const RandomLevel<T>& level, OracleScene& scene) {
  const fields::RandomCuts<T>& cuts = level.cuts;
  for (int k = 0; k < cuts.size(); ++k) {
    CutRow row{.i = cuts.column[at(k)], .j = cuts.row[at(k)]};
    for (int n = 0; n < 4; ++n) row.weight[at(n)] = double(cuts.weight[at(4 * k + n)]);
    row.length = double(cuts.length[at(k)]) / level.spec.spacing;
    scene.cuts.rows.push_back(row);
    for (int l = cuts.link_begin[at(k)]; l < cuts.link_begin[at(k + 1)]; ++l)
      if (cuts.link[at(l)] > k) scene.cuts.neighbours.emplace_back(k, cuts.link[at(l)]);
  }
  scene.options = {.weight = level.spec.stiffness * scene.n * level.spec.spacing,
                   .jump = level.spec.jump};
}

template <class T>
void set_state(const RandomLevel<T>& level, KernelOracle& oracle) {
  oracle.state = rest(oracle.scene);
  oracle.P_H = VectorXd::Zero(oracle.state.P.size());
  for (int j = 0; j <= oracle.ny; ++j)
    for (int i = 0; i <= oracle.nx; ++i) {
      oracle.state.x[oracle.scene.node(i, j)] += double(level.ux.view().at(i, j)) / oracle.h;
      oracle.state.y[oracle.scene.node(i, j)] += double(level.uy.view().at(i, j)) / oracle.h;
    }
  if (!level.spec.pressure) return;
  for (int j = 0; j < oracle.ny; ++j)
    for (int i = 0; i < oracle.nx; ++i) {
      const int c = j * oracle.scene.n + i;
      const auto p = double(level.pressure.view().at(i, j));
      const double bound = double(level.clamp_width) * oracle.scene.mu[at(c)];
      oracle.state.P[c] = p;
      oracle.P_H[c] = std::clamp(p - double(level.clamp_centre), -bound, bound);
    }
}

/// The jump term of the volume rows in the kernels' units, edge by edge.
template <class T>
void add_pressure_jump(const RandomLevel<T>& level, KernelOracle& oracle) {
  if (!level.spec.pressure || level.spec.pressure_jump == 0.0) return;
  const auto position = [&](int i, int j) {
    return Eigen::Vector2d(oracle.h * i + double(level.ux.view().at(i, j)),
                           oracle.h * j + double(level.uy.view().at(i, j)));
  };
  const auto mu = [&](int i, int j) { return oracle.scene.mu[at(j * oracle.scene.n + i)]; };
  const auto edge = [&](int i, int j, int east, int north) {
    const Eigen::Vector2d from = position(i + east, j + north);
    const double squared = (position(i + 1, j + 1) - from).squaredNorm();
    const double weight =
        level.spec.pressure_jump * squared / (8.0 * (mu(i, j) + mu(i + east, j + north)));
    const int a = oracle.cell(i, j), b = oracle.cell(i + east, j + north);
    oracle.matrix.coeffRef(a, a) -= weight;
    oracle.matrix.coeffRef(b, b) -= weight;
    oracle.matrix.coeffRef(a, b) += weight;
    oracle.matrix.coeffRef(b, a) += weight;
  };
  for (int j = 0; j < oracle.ny; ++j)
    for (int i = 0; i < oracle.nx; ++i) {
      if (i + 1 < oracle.nx) edge(i, j, 1, 0);
      if (j + 1 < oracle.ny) edge(i, j, 0, 1);
    }
}

/// D: 1 for x, y and q, h for P.
VectorXd scales(const KernelOracle& oracle) {
  VectorXd scale = VectorXd::Ones(oracle.scene.unknowns());
  scale.segment(oracle.first_multiplier(), oracle.scene.pressures).setConstant(oracle.h);
  return scale;
}

}  // namespace

VectorXd KernelOracle::force() const {
  State unpulled = state;
  unpulled.q.setZero();
  VectorXd result = -gradient(scene, unpulled).cwiseProduct(h * scales(*this));
  result.tail(state.q.size()).setZero();
  return result;
}

template <class T>
VectorXd KernelOracle::packed(const kernels::Unknowns<const T>& fields,
                              const std::vector<T>& q) const {
  VectorXd z = VectorXd::Zero(scene.unknowns());
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) {
      const int u = scene.node_unknown[at(scene.node(i, j))];
      z[u] = double(fields.x.at(i, j));
      z[u + scene.free_nodes] = double(fields.y.at(i, j));
    }
  for (int j = 0; fields.p && j < ny; ++j)
    for (int i = 0; i < nx; ++i) z[cell(i, j)] = double(fields.p.at(i, j));
  const Eigen::Index first = scene.q_unknown(0, 0);
  for (std::size_t n = 0; n < q.size(); ++n) z[first + Eigen::Index(n)] = double(q[n]);
  return z;
}

std::vector<int> KernelOracle::nodes(const std::function<bool(int, int)>& wanted) const {
  std::vector<int> rows;
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) {
      if (!wanted(i, j)) continue;
      const int u = scene.node_unknown[at(scene.node(i, j))];
      rows.insert(rows.end(), {u, u + scene.free_nodes});
    }
  return rows;
}

template <class T>
KernelOracle kernel_oracle(const RandomLevel<T>& level) {
  KernelOracle oracle;
  oracle.nx = level.spec.nx;
  oracle.ny = level.spec.ny;
  oracle.h = level.spec.spacing;
  oracle.scene.n = std::max(oracle.nx, oracle.ny);
  set_material(level, oracle.scene);
  set_cuts(level, oracle.scene);
  number_unknowns(oracle.scene, oracle.nx, oracle.ny);
  set_state(level, oracle);
  const VectorXd scale = scales(oracle);
  oracle.matrix = assemble(oracle.scene, oracle.state, oracle.P_H).matrix;
  oracle.matrix = scale.asDiagonal() * oracle.matrix * scale.asDiagonal();
  add_pressure_jump(level, oracle);
  return oracle;
}

double relative_error(const VectorXd& found, const VectorXd& expected) {
  if (!found.allFinite()) return kInfinity;
  const double largest = expected.lpNorm<Eigen::Infinity>();
  const double error = (found - expected).lpNorm<Eigen::Infinity>();
  return largest > 0.0 ? error / largest : error;
}

template VectorXd KernelOracle::packed(const kernels::Unknowns<const float>&,
                                       const std::vector<float>&) const;
template VectorXd KernelOracle::packed(const kernels::Unknowns<const double>&,
                                       const std::vector<double>&) const;
template KernelOracle kernel_oracle(const RandomLevel<float>&);
template KernelOracle kernel_oracle(const RandomLevel<double>&);

}  // namespace drumhead::oracle
