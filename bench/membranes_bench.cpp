// SPDX-License-Identifier: MIT
// Every membrane on the study scenes (curves clear of lattice lines), as rows of JSON (results.h):
// whole solves at 128², and Eq. 8 on the scenes of many discs.
#include <algorithm>
#include <string>

#include <drumhead/kernels/model.h>

#include "solution_values.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

multigrid::Solution solved(const scenes::Scene& scene, int n, kernels::Model model, double kappa) {
  multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  problem.material.model = model;
  return multigrid::solve(problem,
                          {.curve_method = multigrid::CurveMethod::averaged, .threads = 1});
}

void all_models(Results& results) {
  const double offset = scenes::kStudyOffset;
  for (const kernels::ModelInfo& info : kernels::kModels)
    for (const scenes::Scene& scene :
         {scenes::sponge(offset), scenes::roundabout(45.0, offset), scenes::shift(offset)})
      results.row("membranes", joined({{"model", std::string(info.name)}, {"scene", scene.name}},
                                      values_of(solved(scene, 128, info.model, 1.0))));
}

void fold_free(Results& results, const scenes::Scene& scene, int n, double kappa) {
  const multigrid::Solution solution = solved(scene, n, kernels::Model::arap, kappa);
  int most = 0;
  std::string inverted;  // after each step
  for (const multigrid::LevelReport& level : solution.report.levels) {
    inverted += (inverted.empty() ? "" : ", ") + std::to_string(level.nx) + "²:";
    for (const multigrid::NewtonStep& step : level.newton) {
      most = std::max(most, step.inverted_cells);
      inverted += " " + std::to_string(step.inverted_cells);
    }
  }
  Json row = joined({{"scene", scene.name}, {"kappa", kappa}, {"n", n}}, values_of(solution));
  row["most_inverted"] = most;
  row["inverted_after_steps"] = inverted;
  results.row("eq8", row);
}

void fold_free(Results& results) {
  for (const scenes::Scene& scene : {scenes::many_discs(), scenes::turning_discs()})
    for (const int n : {48, 192})
      for (const double kappa : {1e3, 1e4, 1e6}) fold_free(results, scene, n, kappa);
  // Beside locally injective maps, which the study timed on this lattice.
  fold_free(results, scenes::sponge(scenes::kStudyOffset), 200, 1e4);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  drumhead::bench::Results results(argc, argv);
  drumhead::bench::all_models(results);
  drumhead::bench::fold_free(results);
}
