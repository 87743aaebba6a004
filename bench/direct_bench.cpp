// SPDX-License-Identifier: MIT
// The same nested Newton iteration with a sparse direct solver (UMFPACK) on the assembled matrix
// beside drumhead's: same lattice, energy, curve rows, q-jump, start and stopping rule, one thread,
// in one run. The matrix and its cut cells are the tests' oracle; the time of its assembly, which
// is not tuned, is listed apart and left out of the ratio.
//   direct_bench [N…]        lattices, default 100 200 400; 800 needs some 6 GB and minutes
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <umfpack.h>

#include "support/oracle_system.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

using Eigen::VectorXd;

constexpr double kShare = 0.1;          // of the discretisation error, left by Newton
constexpr double kErrorOfChange = 0.8;  // discretisation error by what a level changes
constexpr int kStartCells = 32, kMostSteps = 20, kRepeats = 5;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Cost {
  double assemble = 0.0, solve = 0.0, peak_bytes = 0.0;
  int factorisations = 0;
};

/// x of matrix · x = right by UMFPACK, with 64-bit indices.
VectorXd solve_direct(const Eigen::SparseMatrix<double>& matrix, const VectorXd& right,
                      Cost& cost) {
  const std::vector<SuiteSparse_long> columns(matrix.outerIndexPtr(),
                                              matrix.outerIndexPtr() + matrix.cols() + 1);
  const std::vector<SuiteSparse_long> rows(matrix.innerIndexPtr(),
                                           matrix.innerIndexPtr() + matrix.nonZeros());
  const SuiteSparse_long n = matrix.cols();
  double info[UMFPACK_INFO];
  void *symbolic = nullptr, *numeric = nullptr;
  VectorXd x(n);
  const double* values = matrix.valuePtr();
  umfpack_dl_symbolic(n, n, columns.data(), rows.data(), values, &symbolic, nullptr, info);
  const auto status =
      umfpack_dl_numeric(columns.data(), rows.data(), values, symbolic, &numeric, nullptr, info);
  cost.peak_bytes =
      std::max(cost.peak_bytes, info[UMFPACK_PEAK_MEMORY] * info[UMFPACK_SIZE_OF_UNIT]);
  if (status < 0) {
    std::fprintf(stderr, "direct_bench: UMFPACK fails with %d\n", int(status));
    std::exit(1);
  }
  umfpack_dl_solve(UMFPACK_A, columns.data(), rows.data(), values, x.data(), right.data(), numeric,
                   nullptr, info);
  umfpack_dl_free_symbolic(&symbolic);
  umfpack_dl_free_numeric(&numeric);
  ++cost.factorisations;
  return x;
}

/// A full Newton step with the pressure in the Hessian clamped to ±theta about its median.
oracle::State newton_step(const oracle::OracleScene& scene, const oracle::State& state,
                          double theta, double& dx_rms, Cost& cost) {
  const double start = now();
  std::vector<double> sorted(state.P.begin(), state.P.end());
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  VectorXd P_H = state.P.array() - *middle;
  P_H = P_H.cwiseMax(-theta).cwiseMin(theta);
  oracle::OracleSystem system = oracle::assemble(scene, state, P_H);
  system.matrix.makeCompressed();
  const double assembled = now();
  const VectorXd step = solve_direct(system.matrix, -system.gradient, cost);
  cost.assemble += assembled - start;
  cost.solve += now() - assembled;
  dx_rms = step.head(2 * scene.free_nodes).norm() / double(scene.n + 1);
  return oracle::moved(scene, state, step, 1.0);
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

Cost nested_newton(const scenes::Scene& scene, int n, double kappa) {
  const oracle::OracleOptions options{.weight = 1e6, .jump = 0.005};
  std::vector<int> lattices{n};
  while (lattices.back() % 2 == 0 && lattices.back() / 2 >= kStartCells)
    lattices.push_back(lattices.back() / 2);
  Cost cost;
  oracle::OracleScene coarse;
  oracle::State state;
  double theta = 1.0;
  for (std::size_t l = lattices.size(); l-- > 0;) {
    const double start = now();
    const oracle::OracleScene level = oracle::make_scene(scene, lattices[l], kappa, options);
    const bool first = l + 1 == lattices.size();
    state = first ? oracle::rest(level) : prolonged(coarse, state, level);
    cost.assemble += now() - start;
    double change = 0.0, before = 0.0;
    for (int step = 0; step < kMostSteps; ++step) {
      double dx = 0.0;
      state = newton_step(level, state, theta, dx, cost);
      theta = std::min(8.0 * theta, 1e6);
      change += dx;
      // The first step on a level is followed by one more, as its contraction is not known yet.
      const double rate = step > 0 ? std::min(dx / before, 0.9) : 0.5;
      const double left = dx * rate / (1.0 - rate);
      if (left <= (first ? 0.01 : kShare * kErrorOfChange * change)) break;
      before = dx;
    }
    coarse = level;
  }
  return cost;
}

void run(const scenes::Scene& scene, int n, double kappa) {
  const Cost cost = nested_newton(scene, n, kappa);
  const multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  multigrid::Solution ours;
  double seconds = 1e300;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    ours = multigrid::solve(problem, {.threads = 1});
    seconds = std::min(seconds, ours.report.cut_seconds + ours.report.solve_seconds);
  }
  const double nodes = double(ours.lattice.nodes());
  std::printf("| %s kappa %g | %d² | %d | %.2f | %.2f | %.0f | %.0f | %.4f | %.0f | %.0f |\n",
              scene.name.c_str(), kappa, n, cost.factorisations, cost.solve, cost.assemble,
              cost.peak_bytes / 1e6, cost.peak_bytes / nodes, seconds,
              double(ours.report.solver_bytes) / nodes, cost.solve / seconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  std::vector<int> lattices;
  for (int k = 1; k < argc; ++k) lattices.push_back(std::atoi(argv[k]));
  if (lattices.empty()) lattices = {100, 200, 400};
  std::puts(
      "| scene | lattice | factorisations | direct: analyse, factorise, solve, s | assemble, s | "
      "peak, MB | B/node | drumhead, s | B/node | direct by drumhead |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|");
  const double offset = scenes::kStudyOffset;
  for (const int n : lattices) {
    if (n < bench::kStartCells || n % 2) {
      std::fprintf(stderr, "direct_bench: lattice %d: must be even and at least 32\n", n);
      return 2;
    }
    bench::run(scenes::sponge(offset), n, 1.0);
    bench::run(scenes::roundabout(90.0, offset), n, 10.0);
    bench::run(scenes::shift(offset), n, 10.0);
  }
  return 0;
}
