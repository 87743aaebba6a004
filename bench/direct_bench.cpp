// SPDX-License-Identifier: MIT
// The same nested Newton iteration with sparse direct solvers on the assembled matrix beside
// drumhead's: same lattice, energy, curve rows, q-jump, start and stopping rule, in one run, as
// rows of JSON (results.h). The matrix and its cut cells are the tests' oracle; the time of its
// assembly, which is not tuned, is listed apart and left out of `seconds`.
//   direct_bench [--sponge] [--threads N] [--truth FOLDER] [CELLS…]
// --sponge: that scene alone. CELLS: lattices, 50 100 200 if not given, even from 64 on; 800 takes
// some GB and minutes.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "direct_solvers.h"
#include "nested_newton.h"
#include "solution_values.h"
#include "support/scene_problem.h"
#include "truth.h"

namespace drumhead::bench {
namespace {

constexpr int kRepeats = 5;
constexpr int kWarmUp = 256;  // unknowns

struct Case {
  scenes::Scene scene;
  double kappa;
  Truth truth;
};

double our_seconds(const Case& c, int n, int threads) {
  const multigrid::WarpProblem problem = scenes::problem(c.scene, n, c.kappa);
  double least = 1e300;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    least = std::min(
        least,
        seconds_of(multigrid::solve(
            problem, {.curve_method = multigrid::CurveMethod::averaged, .threads = threads})));
  return least;
}

/// A solution by each solver outside the clock: its first one loads libraries and starts threads.
void warm_up() {
  const Eigen::MatrixXd dense =
      Eigen::MatrixXd::Identity(kWarmUp, kWarmUp) + Eigen::MatrixXd::Ones(kWarmUp, kWarmUp);
  const Eigen::SparseMatrix<double> matrix = dense.sparseView();
  for (const auto& solver : direct_solvers())
    if (!solver->solve(matrix, Eigen::VectorXd::Ones(kWarmUp)).allFinite())
      throw std::runtime_error(std::string(solver->name()) + " cannot solve a small system");
}

void run(const Case& c, DirectSolver& solver, int n, int threads, Results& results) {
  const double ours = our_seconds(c, n, threads);
  const NestedNewton direct =
      nested_newton(c.scene, n, c.kappa, [&](const NewtonSystem& system) -> Eigen::VectorXd {
        return solver.solve(system.linear.matrix, -system.linear.gradient);
      });
  Json row = joined(keys_of(c.scene, c.kappa),
                    {{"method", std::string(solver.name()) + ", same lattice"},
                     {"n", n},
                     {"threads", threads},
                     {"unknowns", direct.scene.unknowns()},
                     {"seconds", direct.solve_seconds},
                     {"assemble_seconds", direct.assemble_seconds},
                     {"newton", direct.newton_finest},
                     {"newton_all", direct.newton},
                     {"bytes", solver.peak_bytes()},
                     {"bytes_per_node", solver.peak_bytes() / ((n + 1.0) * (n + 1.0))},
                     {"our_seconds", ours},
                     {"ratio", direct.solve_seconds / ours}});
  if (n <= c.truth.most_cells() && Truth::kFinest % n == 0) {
    std::vector<double> u, v;
    displacements(direct, u, v);
    const Truth::Error error = c.truth.error(n, u, v);
    row["rms_px"] = error.rms_px;
    row["max_px"] = error.max_px;
  }
  results.row("direct", row);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) try {
  using namespace drumhead;
  std::vector<int> lattices;
  int threads = 1;
  bool all = true;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word == "--sponge") {
      all = false;
      continue;
    }
    if (word == "--truth") {
      ++k;
      continue;
    }
    const bool is_threads = word == "--threads" && k + 1 < argc;
    const int number = std::atoi(argv[is_threads ? ++k : k]);
    if (is_threads ? number < 1 : number < 32 || (number >= 64 && number % 2)) {
      std::fputs(
          "usage: direct_bench [--sponge] [--threads N] [--truth FOLDER] [CELLS…]\n"
          "       CELLS even from 64 on\n",
          stderr);
      return 2;
    }
    if (is_threads)
      threads = number;
    else
      lattices.push_back(number);
  }
  if (lattices.empty()) lattices = {50, 100, 200};
  const double offset = scenes::kStudyOffset;
  std::vector<std::pair<scenes::Scene, double>> cases{{scenes::sponge(offset), 1.0}};
  if (all) {
    cases.push_back({scenes::roundabout(90.0, offset), 10.0});
    cases.push_back({scenes::shift(offset), 10.0});
  }
  const std::string folder = bench::truth_folder(argc, argv);
  bench::Results results(argc, argv);
  bench::set_blas_threads(threads);
  bench::warm_up();
  for (const auto& [scene, kappa] : cases) {
    const bench::Case c{scene, kappa, bench::Truth(scene, kappa, folder)};
    for (const int n : lattices)
      for (const auto& solver : bench::direct_solvers())
        bench::run(c, *solver, n, threads, results);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "direct_bench: %s\n", error.what());
  return 1;
}
