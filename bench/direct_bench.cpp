// SPDX-License-Identifier: MIT
// The same nested Newton iteration with a sparse direct solver (UMFPACK) on the assembled matrix
// beside drumhead's: same lattice, energy, curve rows, q-jump, start and stopping rule, one thread,
// in one run. The matrix and its cut cells are the tests' oracle; the time of its assembly, which
// is not tuned, is listed apart and left out of the ratio.
//   direct_bench [N…]        lattices, default 100 200 400; 800 needs some 6 GB and minutes
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <umfpack.h>

#include "nested_newton.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

using Eigen::VectorXd;

constexpr int kRepeats = 5;

struct Cost {
  double peak_bytes = 0.0;
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

void run(const scenes::Scene& scene, int n, double kappa) {
  Cost cost;
  const NestedNewton direct = nested_newton(scene, n, kappa, [&](const NewtonSystem& system) {
    return solve_direct(system.linear.matrix, -system.linear.gradient, cost);
  });
  const multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  multigrid::Solution ours;
  double seconds = 1e300;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    ours = multigrid::solve(problem, {.threads = 1});
    seconds = std::min(seconds, ours.report.cut_seconds + ours.report.solve_seconds);
  }
  const double nodes = double(ours.lattice.nodes());
  std::printf("| %s kappa %g | %d² | %d | %.2f | %.2f | %.0f | %.0f | %.4f | %.0f | %.0f |\n",
              scene.name.c_str(), kappa, n, cost.factorisations, direct.solve_seconds,
              direct.assemble_seconds, cost.peak_bytes / 1e6, cost.peak_bytes / nodes, seconds,
              double(ours.report.solver_bytes) / nodes, direct.solve_seconds / seconds);
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
    if (n < 32 || n % 2) {
      std::fprintf(stderr, "direct_bench: lattice %d: must be even and at least 32\n", n);
      return 2;
    }
    bench::run(scenes::sponge(offset), n, 1.0);
    bench::run(scenes::roundabout(90.0, offset), n, 10.0);
    bench::run(scenes::shift(offset), n, 10.0);
  }
  return 0;
}
