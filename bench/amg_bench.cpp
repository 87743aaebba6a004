// SPDX-License-Identifier: MIT
// Algebraic multigrid (amg_solver.h) in the nested Newton iteration beside drumhead: same lattice,
// energy, curve rows, q-jump, globalisation and stopping rule, one thread. Linear systems to a
// hundredth, at kappa/mu 100 to a thousandth: with less Newton stops elsewhere (to a tenth, as
// drumhead takes them, 10 px from the solution there). Rows of the table "amg":
//
//     scene, kappa, n
//     method                   "GAMG, MINRES", "BoomerAMG, MINRES", "drumhead"
//     seconds                  of AMG: setup_seconds + iterate_seconds; assemble_seconds, which the
//                              tests' oracle takes and which is not tuned, is left out
//     newton, newton_all       steps on the finest lattice, on all
//     cycles, cycles_all       iterations of the last system, of all systems
//     bytes, bytes_per_node    of the largest system: matrices, hierarchy, vectors
//     rms_px, max_px           error at the nodes (truth.h)
//     difference_px            RMS from drumhead's solution to a thousandth of the tolerance
//
//   amg_bench [--large] [--truth FOLDER]     lattices to 200², BoomerAMG to 100²; --large: to 400².
//                          At kappa/mu 100 GAMG to half of that and BoomerAMG to 100² with --large
//                          alone: the next lattice takes minutes.
#include <cstdio>
#include <string_view>

#include "amg_solver.h"
#include "solution_values.h"
#include "support/field_difference.h"
#include "support/scene_problem.h"
#include "truth.h"

namespace drumhead::bench {
namespace {

constexpr double kSame = 0.2;  // of the discretisation error
constexpr int kRepeats = 3;

struct Case {
  scenes::Scene scene;
  double kappa;
  Truth truth;
};

/// Whether AMG's solution is drumhead's.
bool run_amg(const Case& c, int n, Amg amg, const multigrid::Solution& exact, Results& results) {
  AmgSolver solver(amg, c.kappa < 100.0 ? 1e-2 : 1e-3);
  const NestedNewton newton = nested_newton(
      c.scene, n, c.kappa, [&](const NewtonSystem& system) { return solver(system); });
  const AmgCost& cost = solver.cost();
  const double inner_seconds = cost.setup_seconds + cost.iterate_seconds;
  const double difference = kPicture / n * oracle::difference(exact, newton.state).rms;
  const bool same = difference <= kSame * kPicture * exact.report.discretisation_rms_px;
  std::vector<double> u, v;
  displacements(newton, u, v);
  const Truth::Error error = c.truth.error(n, u, v);
  results.row("amg",
              {{"scene", c.scene.name},
               {"kappa", c.kappa},
               {"n", n},
               {"method", amg == Amg::gamg ? "GAMG, MINRES" : "BoomerAMG, MINRES"},
               {"status", !cost.solved ? "stalled"
                          : same       ? "converged"
                                       : "another solution"},
               {"seconds", inner_seconds},
               {"setup_seconds", cost.setup_seconds},
               {"iterate_seconds", cost.iterate_seconds},
               {"assemble_seconds", newton.assemble_seconds + newton.solve_seconds - inner_seconds},
               {"newton", newton.newton_finest},
               {"newton_all", newton.newton},
               {"cycles", cost.last_iterations},
               {"cycles_all", cost.iterations},
               {"bytes", cost.bytes},
               {"bytes_per_node", cost.bytes / double(exact.lattice.nodes())},
               {"difference_px", difference},
               {"rms_px", error.rms_px},
               {"max_px", error.max_px}});
  if (!same)
    std::fprintf(stderr, "amg_bench: %s kappa %g, %d²: %g px from drumhead's solution\n",
                 c.scene.name.c_str(), c.kappa, n, difference);
  return same;
}

/// Prints drumhead's row and returns its solution to a smaller tolerance.
multigrid::Solution run_drumhead(const Case& c, int n, Results& results) {
  const multigrid::WarpProblem problem = scenes::problem(c.scene, n, c.kappa);
  multigrid::SolverOptions options{.curve_method = multigrid::CurveMethod::averaged, .threads = 1};
  multigrid::Solution best;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    multigrid::Solution solution = multigrid::solve(problem, options);
    if (repeat == 0 || seconds_of(solution) < seconds_of(best)) best = std::move(solution);
  }
  results.row(
      "amg", joined({{"scene", c.scene.name}, {"kappa", c.kappa}, {"n", n}, {"method", "drumhead"}},
                    values_of(best)));
  options.tolerance_px = 1e-4 * best.report.discretisation_rms_px;
  return multigrid::solve(problem, options);
}

/// The largest lattice that `amg` is asked to solve.
int most_cells(Amg amg, double kappa, bool large) {
  if (amg == Amg::gamg) return (large ? 400 : 200) / (kappa < 100.0 ? 1 : 2);
  return kappa < 100.0 ? (large ? 400 : 100) : (large ? 100 : 0);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) try {
  using namespace drumhead;
  bool large = false;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word == "--large") {
      large = true;
    } else if (word == "--truth" && k + 1 < argc) {
      ++k;
    } else {
      std::fputs("usage: amg_bench [--large] [--truth FOLDER]\n", stderr);
      return 2;
    }
  }
  bench::Results results(argc, argv);
  const std::string folder = bench::truth_folder(argc, argv);
  const double offset = scenes::kStudyOffset;
  const scenes::Scene s2 = scenes::roundabout(90.0, offset);
  bool right = true;
  for (const auto& [scene, kappa] :
       {std::pair{scenes::sponge(offset), 1.0}, std::pair{s2, 10.0},
        std::pair{scenes::shift(offset), 10.0}, std::pair{s2, 100.0}}) {
    const bench::Case c{scene, kappa, bench::Truth(scene, kappa, folder)};
    for (int n = 100; n <= bench::most_cells(bench::Amg::gamg, kappa, large); n *= 2) {
      const multigrid::Solution exact = bench::run_drumhead(c, n, results);
      for (const bench::Amg amg : {bench::Amg::gamg, bench::Amg::boomeramg})
        if (n <= bench::most_cells(amg, kappa, large))
          right &= bench::run_amg(c, n, amg, exact, results);
    }
  }
  return right ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "amg_bench: %s\n", error.what());
  return 1;
}
