// SPDX-License-Identifier: MIT
#include "oracle_newton.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/SparseLU>

namespace drumhead::oracle {
namespace {

using Eigen::VectorXd;
constexpr double kShift = 1e-9;
constexpr double kExact = 1e6;  // theta above which the pressure is not clamped
constexpr double kMeritKappa =
    100.0;  // km: stiffer volume terms enter the merit with this, over mu

double median(const VectorXd& values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

// P_H = clamp(P − median P, ±theta mu), in every cell: a pressure that is constant over all cells
// has no second derivative, over some of them it has.
VectorXd clamped_pressure(const OracleScene& scene, const VectorXd& P, double theta) {
  if (theta > kExact) return P;
  VectorXd result = P.array() - median(P);
  for (Eigen::Index cell = 0; cell < P.size(); ++cell) {
    const double bound = theta * scene.mu[std::size_t(cell)];
    result[cell] = std::clamp(result[cell], -bound, bound);
  }
  return result;
}

// E_el(x) + sum A [P⁺c + km/2 c²] + nu sum len |r|₁ or, where the rows are soft and there is no
// jump, sum d len/2 |b − W x|²; c = J* − 1 − P⁺/kappa, r = b − W x − M q⁺ with the multipliers of
// the full step.
class Merit {
 public:
  Merit(const OracleScene& scene, const State& full_step) : scene_(scene), P_(full_step.P) {
    Mq_ = softness_times(scene, full_step.q);
    double traction = 0.0;
    for (std::size_t r = 0; r < scene.cuts.rows.size(); ++r) {
      traction = std::max(
          traction, full_step.q.segment<2>(2 * Eigen::Index(r)).norm() / scene.cuts.rows[r].length);
    }
    nu_ = 1.5 * traction;
  }

  double operator()(const State& state) const {
    const double cells = double(scene_.n) * scene_.n;
    double sum = cells * energies(scene_, state).elastic;
    for (int j = 0; j < scene_.n; ++j) {
      for (int i = 0; i < scene_.n; ++i) sum += volume(state, i, j);
    }
    const bool hard = std::isinf(scene_.options.weight) || scene_.options.jump > 0.0;
    if (!hard) return sum + spring_energy(scene_, state);
    const VectorXd r = curve_gap(scene_, state) - Mq_;
    for (std::size_t k = 0; k < scene_.cuts.rows.size(); ++k) {
      sum += nu_ * scene_.cuts.rows[k].length * r.segment<2>(2 * Eigen::Index(k)).lpNorm<1>();
    }
    return sum;
  }

 private:
  double volume(const State& state, int i, int j) const {
    const auto cell = std::size_t(j * scene_.n + i);
    const double kappa = scene_.kappa[cell], stretch = centre_J(scene_, state, i, j) - 1.0;
    if (kappa == 0.0) return 0.0;
    const double km = std::min(kappa, kMeritKappa * scene_.mu[cell]);
    if (kappa <= km) return 0.5 * kappa * stretch * stretch;
    const double P = P_[Eigen::Index(cell)];
    const double c = stretch - (std::isinf(kappa) ? 0.0 : P / kappa);
    return P * c + 0.5 * km * c * c;
  }

  const OracleScene& scene_;
  const VectorXd& P_;
  VectorXd Mq_;
  double nu_ = 0.0;
};

}  // namespace

// A change within rounding counts as a fall.
double line_search(const OracleScene& scene, const State& state, const VectorXd& step) {
  const State full = moved(scene, state, step, 1.0);
  const Merit merit(scene, full);
  const double before = merit(state), slack = 1e-12 * std::abs(before);
  for (double t = 1.0; t > 1e-4; t *= 0.5) {
    if (merit(t == 1.0 ? full : moved(scene, state, step, t)) <= before + slack) return t;
  }
  return 0.0;
}

double solve(const Eigen::SparseMatrix<double>& matrix, const VectorXd& right, int first_multiplier,
             VectorXd& step) {
  Eigen::SparseMatrix<double> shifted = matrix;
  for (Eigen::Index u = first_multiplier; u < matrix.rows(); ++u) shifted.coeffRef(u, u) -= kShift;
  shifted.makeCompressed();
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(shifted);
  if (factor.info() != Eigen::Success) throw std::runtime_error("oracle: singular matrix");
  step = factor.solve(right);
  VectorXd residual = right - matrix * step;
  const double scale = std::max(right.norm(), 1e-300);
  for (int pass = 0; pass < 30 && residual.norm() > 1e-14 * scale; ++pass) {
    const VectorXd better = step + factor.solve(residual);
    const VectorXd left = right - matrix * better;
    if (left.norm() > 0.9 * residual.norm()) break;
    step = better;
    residual = left;
  }
  return residual.norm() / scale;
}

State harmonic(const OracleScene& scene) {
  OracleScene membrane = scene;
  membrane.kappa.assign(scene.kappa.size(), 0.0);
  membrane.cell_unknown.assign(scene.kappa.size(), -1);
  membrane.pressures = 0;
  const State start = rest(membrane);
  const OracleSystem system = assemble(membrane, start, start.P);
  VectorXd step;
  solve(system.matrix, -system.gradient, 2 * membrane.free_nodes, step);
  return moved(membrane, start, step, 1.0);
}

OracleResult newton(const OracleScene& scene, const std::optional<State>& start) {
  constexpr int kMostSteps = 80;
  constexpr double kTolerance = 1e-10;  // largest |dx| of the last step, in cells
  constexpr double kClampGrowth = 8.0;
  OracleResult result;
  result.state = start ? *start : harmonic(scene);
  double theta = 1.0;
  while (result.steps < kMostSteps) {
    const State& now = result.state;
    const OracleSystem system = assemble(scene, now, clamped_pressure(scene, now.P, theta));
    VectorXd step;
    solve(system.matrix, -system.gradient, 2 * scene.free_nodes, step);
    const double t = line_search(scene, now, step);
    ++result.steps;
    if (t == 0.0 && theta == 1.0) break;
    result.state = moved(scene, now, step, t);
    const double dx_max = step.head(2 * scene.free_nodes).lpNorm<Eigen::Infinity>();
    if (t == 1.0 && dx_max < kTolerance) {
      result.converged = true;
      break;
    }
    theta = t == 1.0 ? theta * kClampGrowth : std::max(1.0, theta / kClampGrowth);
  }
  return result;
}

}  // namespace drumhead::oracle
