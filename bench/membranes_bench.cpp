// SPDX-License-Identifier: MIT
// Every membrane on the study scenes (curves clear of lattice lines), as two Markdown tables: whole
// solves at 128², and Eq. 8 on the scenes of many discs.
#include <algorithm>
#include <cstdio>
#include <string>

#include <drumhead/kernels/model.h>

#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

multigrid::Solution solved(const scenes::Scene& scene, int n, kernels::Model model, double kappa) {
  multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  problem.material.model = model;
  return multigrid::solve(problem, {.threads = 1});
}

/// Status, Newton steps on all levels and on the finest, cycles there, work units, product, memory.
void print_cost(const multigrid::Solution& solution) {
  const multigrid::SolveReport& report = solution.report;
  const double nodes = double(solution.lattice.nodes());
  std::size_t steps = 0;
  for (const multigrid::LevelReport& level : report.levels) steps += level.newton.size();
  int cycles = 0;
  for (const multigrid::NewtonStep& step : report.levels.back().newton) cycles += step.krylov;
  std::printf(" %s | %zu, %zu | %d | %.0f | %.3f | %.1f | %.0f |", multigrid::name(report.status),
              steps, report.levels.back().newton.size(), cycles, report.work_units,
              report.cut_seconds + report.solve_seconds, 1e9 * report.work_unit_seconds / nodes,
              double(report.solver_bytes) / nodes);
}

void all_models() {
  std::puts(
      "| model, kappa 1 | scene, 128² | status | Newton steps: all levels, finest | cycles there | "
      "work units | seconds | product, ns per node | B/node | inverted, folded cells |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|");
  const double offset = scenes::kStudyOffset;
  for (const kernels::ModelInfo& info : kernels::kModels)
    for (const scenes::Scene& scene :
         {scenes::sponge(offset), scenes::roundabout(45.0, offset), scenes::shift(offset)}) {
      const multigrid::Solution solution = solved(scene, 128, info.model, 1.0);
      std::printf("| %s | %s |", std::string(info.name).c_str(), scene.name.c_str());
      print_cost(solution);
      std::printf(" %d, %d |\n", solution.report.folds.inverted_cells,
                  solution.report.folds.folded_cells);
      std::fflush(stdout);
    }
}

void fold_free() {
  std::puts(
      "| Eq. 8, eps .2 | kappa | lattice | status | Newton steps: all levels, finest | cycles "
      "there "
      "| work units | seconds | product, ns per node | B/node | most inverted on the way, folded "
      "at the "
      "end | least corner J |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const scenes::Scene& scene : {scenes::many_discs(), scenes::turning_discs()})
    for (const int n : {48, 192})
      for (const double kappa : {1e3, 1e4, 1e6}) {
        const multigrid::Solution solution = solved(scene, n, kernels::Model::arap, kappa);
        const multigrid::SolveReport& report = solution.report;
        int inverted = 0;
        for (const multigrid::LevelReport& level : report.levels)
          for (const multigrid::NewtonStep& step : level.newton)
            inverted = std::max(inverted, step.inverted_cells);
        std::printf("| %s | %g | %d² |", scene.name.c_str(), kappa, n);
        print_cost(solution);
        std::printf(" %d, %d | %.3f |\n", inverted, report.folds.folded_cells,
                    report.folds.min_corner_J);
        std::fflush(stdout);
      }
}

}  // namespace
}  // namespace drumhead::bench

int main() {
  drumhead::bench::all_models();
  std::puts("");
  drumhead::bench::fold_free();
}
