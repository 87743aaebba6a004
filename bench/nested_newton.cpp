// SPDX-License-Identifier: MIT
#include "nested_newton.h"

#include <algorithm>
#include <chrono>

#include "support/oracle_newton.h"

namespace drumhead::bench {
namespace {

using Eigen::VectorXd;

constexpr double kShare = 0.1;          // of the discretisation error, left by Newton
constexpr double kErrorOfChange = 0.8;  // discretisation error by what a level changes
constexpr double kCoarsestLeft = 0.01;  // cells
constexpr int kStartCells = 32, kMostSteps = 40;

NewtonStep take_step(const LinearSolver& solve, double theta, NestedNewton& newton) {
  const double start = now();
  oracle::OracleSystem linear =
      oracle::assemble(newton.scene, newton.state, clamped(newton.state.P, theta));
  linear.matrix.makeCompressed();
  const double assembled = now();
  const VectorXd step = solve({newton.scene, newton.state, linear, theta});
  newton.assemble_seconds += assembled - start;
  const double solved = now();
  newton.solve_seconds += solved - assembled;
  const double t = oracle::line_search(newton.scene, newton.state, step);
  newton.state = oracle::moved(newton.scene, newton.state, step, t);
  newton.assemble_seconds += now() - solved;
  return {step.head(2 * newton.scene.free_nodes).norm() / double(newton.scene.n + 1), t};
}

/// Bilinear x̂ and the parent's pressure on the next finer lattice; q is found by the first step.
oracle::State prolonged(const oracle::OracleScene& coarse, const oracle::State& from,
                        const oracle::OracleScene& fine) {
  oracle::State to = oracle::rest(fine);
  for (int j = 1; j < fine.n; ++j)
    for (int i = 1; i < fine.n; ++i) {
      const int a = coarse.node(i / 2, j / 2), b = coarse.node((i + 1) / 2, j / 2);
      const int c = coarse.node(i / 2, (j + 1) / 2), d = coarse.node((i + 1) / 2, (j + 1) / 2);
      to.x[fine.node(i, j)] = 0.5 * (from.x[a] + from.x[b] + from.x[c] + from.x[d]);
      to.y[fine.node(i, j)] = 0.5 * (from.y[a] + from.y[b] + from.y[c] + from.y[d]);
    }
  for (int j = 0; j < fine.n; ++j)
    for (int i = 0; i < fine.n; ++i) to.P[j * fine.n + i] = from.P[(j / 2) * coarse.n + i / 2];
  return to;
}

}  // namespace

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

VectorXd clamped(const VectorXd& P, double theta) {
  std::vector<double> sorted(P.begin(), P.end());
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const VectorXd centred = P.array() - *middle;
  return centred.cwiseMax(-theta).cwiseMin(theta);
}

int newton_steps(bool coarsest, double& theta, const std::function<NewtonStep(double)>& step) {
  double change = 0.0, before = 0.0;
  for (int k = 0; k < kMostSteps; ++k) {
    const auto [dx, t] = step(theta);
    theta = t == 1.0 ? std::min(8.0 * theta, 1e6) : std::max(1.0, theta / 8.0);
    change += t * dx;
    // The first step on a level is followed by one more, as its contraction is not known yet.
    const double rate = before > 0.0 ? std::min(dx / before, 0.9) : 0.5;
    const double left = dx * rate / (1.0 - rate);
    if (t == 1.0 && left <= (coarsest ? kCoarsestLeft : kShare * kErrorOfChange * change))
      return k + 1;
    before = dx;
  }
  return kMostSteps;
}

std::vector<int> nested_lattices(int n) {
  std::vector<int> lattices{n};
  while (lattices.back() % 2 == 0 && lattices.back() / 2 >= kStartCells)
    lattices.push_back(lattices.back() / 2);
  std::reverse(lattices.begin(), lattices.end());
  return lattices;
}

NestedNewton nested_newton(const scenes::Scene& scene, int n, double kappa,
                           const LinearSolver& solve) {
  NestedNewton newton;
  double theta = 1.0;
  for (const int cells : nested_lattices(n)) {
    const double start = now();
    oracle::OracleScene level =
        oracle::make_scene(scene, cells, kappa, {.weight = 1e6, .jump = 0.005});
    const bool coarsest = newton.newton == 0;
    newton.state = coarsest ? oracle::rest(level) : prolonged(newton.scene, newton.state, level);
    newton.scene = std::move(level);
    newton.assemble_seconds += now() - start;
    newton.newton_finest =
        newton_steps(coarsest, theta, [&](double t) { return take_step(solve, t, newton); });
    newton.newton += newton.newton_finest;
  }
  return newton;
}

void displacements(const NestedNewton& newton, std::vector<double>& u, std::vector<double>& v) {
  const int n = newton.scene.n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const int node = newton.scene.node(i, j);
      u.push_back((newton.state.x[node] - i) / n);
      v.push_back((newton.state.y[node] - j) / n);
    }
}

}  // namespace drumhead::bench
