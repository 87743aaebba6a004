// SPDX-License-Identifier: MIT
// Speed against error of whole solves, as rows of JSON (results.h).
//   speed_bench table1 [--large]             the paper's Table 1: the sponge, on one and all
//                                            processors; --large: also 1600² and 3200²
//   speed_bench precision [--truth FOLDER]   error against time over lattices, curves met both
//                                            ways; without truth.h's folder to 400², S2 to 1600²
//   speed_bench tolerances                   error against time over tolerances, on one lattice
//   speed_bench solvers [--truth FOLDER]     error against time by the paper's linear solvers
#include <cstdio>
#include <string_view>
#include <thread>

#include "solution_values.h"
#include "support/scene_problem.h"
#include "truth.h"

namespace drumhead::bench {
namespace {

using multigrid::CurveMethod;
using multigrid::Solver;

// A solve is repeated until it was run so often or this time is over; the fastest counts.
constexpr int kMostRuns = 5;
constexpr double kEnoughSeconds = 3.0;
// A solver that took longer on a lattice is not asked for the next.
constexpr double kMostSeconds = 10.0;

struct Case {
  scenes::Scene scene;
  double kappa;
};
std::vector<Case> cases() {
  const double offset = scenes::kStudyOffset;
  return {{scenes::sponge(offset), 1.0},
          {scenes::roundabout(90.0, offset), 10.0},
          {scenes::shift(offset), 10.0}};
}

multigrid::Solution fastest(const Case& c, int n, const multigrid::SolverOptions& options) {
  const multigrid::WarpProblem problem = scenes::problem(c.scene, n, c.kappa);
  multigrid::Solution best = multigrid::solve(problem, options);
  double spent = seconds_of(best);
  for (int run = 1; run < kMostRuns && spent < kEnoughSeconds; ++run) {
    multigrid::Solution again = multigrid::solve(problem, options);
    spent += seconds_of(again);
    if (seconds_of(again) < seconds_of(best)) best = std::move(again);
  }
  return best;
}

Json row_of(const Case& c, const std::string& method, int n, const multigrid::Solution& solution) {
  const Json keys = joined(keys_of(c.scene, c.kappa),
                           {{"method", method}, {"n", n}, {"threads", solution.report.threads}});
  return joined(keys, values_of(solution));
}

Json errors_of(const Truth& truth, int n, const multigrid::Solution& solution) {
  const Truth::Error error = truth.error(n, solution.u_px, solution.v_px);
  return {{"rms_px", error.rms_px}, {"max_px", error.max_px}};
}

std::string method_of(CurveMethod curves) { return std::string("drumhead, ") + name(curves); }

void table1(bool large, Results& results) {
  std::vector<int> sizes{50, 100, 150, 200, 300, 400, 800};
  if (large) sizes.insert(sizes.end(), {1600, 3200});
  const int all = int(std::thread::hardware_concurrency());
  const Case sponge = cases().front();
  for (const CurveMethod curves : {CurveMethod::averaged, CurveMethod::conforming})
    for (const int n : sizes)
      for (const int threads : {1, all})
        results.row("table1",
                    row_of(sponge, method_of(curves), n,
                           fastest(sponge, n, {.curve_method = curves, .threads = threads})));
}

void precision(const std::string& folder, Results& results) {
  for (const Case& c : cases()) {
    const Truth truth(c.scene, c.kappa, folder);
    for (const CurveMethod curves : {CurveMethod::averaged, CurveMethod::conforming})
      for (const int n : {50, 100, 200, 400, 800, 1600}) {
        if (n > truth.most_cells()) continue;
        const multigrid::Solution solution = fastest(c, n, {.curve_method = curves, .threads = 1});
        results.row("work_precision", joined(row_of(c, method_of(curves), n, solution),
                                             errors_of(truth, n, solution)));
      }
  }
}

void tolerances(Results& results) {
  const Case c = cases()[1];
  const Truth truth(c.scene, c.kappa);
  for (const CurveMethod curves : {CurveMethod::averaged, CurveMethod::conforming})
    for (const double tolerance_px : {10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) {
      const multigrid::Solution solution = fastest(
          c, 400, {.curve_method = curves, .tolerance_px = tolerance_px / kPicture, .threads = 1});
      Json row =
          joined(row_of(c, method_of(curves), 400, solution), errors_of(truth, 400, solution));
      row["tolerance_px"] = tolerance_px;
      results.row("tolerances", row);
    }
}

void solvers(const std::string& folder, Results& results) {
  for (const Case& c : cases()) {
    const Truth truth(c.scene, c.kappa, folder);
    for (const Solver solver :
         {Solver::kaczmarz, Solver::coloured_kaczmarz, Solver::minres, Solver::minres_multigrid})
      for (const int n : {50, 100, 200, 400}) {
        const multigrid::Solution solution =
            fastest(c, n, {.solver = solver, .curve_method = CurveMethod::averaged, .threads = 1});
        const std::string method = std::string("drumhead, ") + multigrid::name(solver);
        results.row("work_precision",
                    joined(row_of(c, method, n, solution), errors_of(truth, n, solution)));
        if (seconds_of(solution) > kMostSeconds) break;
      }
  }
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) try {
  using namespace drumhead::bench;
  const std::string_view what = argc > 1 ? argv[1] : "";
  const std::string folder = truth_folder(argc, argv);
  const bool large = argc == 3 && std::string_view(argv[2]) == "--large";
  const bool judged = argc == 4 && !folder.empty();
  const bool known = what == "table1"                           ? argc == 2 || large
                     : what == "precision" || what == "solvers" ? argc == 2 || judged
                                                                : what == "tolerances" && argc == 2;
  if (!known) {
    std::fputs(
        "usage: speed_bench table1 [--large]\n"
        "       speed_bench precision|solvers [--truth FOLDER]\n"
        "       speed_bench tolerances\n",
        stderr);
    return 2;
  }
  Results results(argc, argv);
  if (what == "table1") table1(large, results);
  if (what == "precision") precision(folder, results);
  if (what == "tolerances") tolerances(results);
  if (what == "solvers") solvers(folder, results);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "speed_bench: %s\n", error.what());
  return 1;
}
