// SPDX-License-Identifier: MIT
// Every membrane on the study scenes (curves clear of lattice lines), as rows of JSON (results.h):
// whole solves at 128², Eq. 8 on the scenes of many discs, and what crpm's folds cost to avoid.
#include <algorithm>
#include <cmath>
#include <string>

#include <drumhead/kernels/model.h>

#include "solution_values.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

using multigrid::CurveMethod;

constexpr CurveMethod kMethods[] = {CurveMethod::averaged, CurveMethod::conforming};

multigrid::Solution solved(const scenes::Scene& scene, int n, kernels::Model model, double kappa,
                           CurveMethod curves = CurveMethod::averaged) {
  multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  problem.material.model = model;
  return multigrid::solve(problem, {.curve_method = curves, .threads = 1});
}

void all_models(Results& results) {
  const double offset = scenes::kStudyOffset;
  for (const kernels::ModelInfo& info : kernels::kModels)
    for (const scenes::Scene& scene :
         {scenes::sponge(offset), scenes::roundabout(45.0, offset), scenes::shift(offset)})
      for (const CurveMethod method : kMethods) {
        results.row("membranes", joined({{"model", std::string(info.name)},
                                         {"scene", scene.name},
                                         {"curves", multigrid::name(method)}},
                                        values_of(solved(scene, 128, info.model, 1.0, method))));
      }
}

void eq8(Results& results, const scenes::Scene& scene, int n, double kappa, CurveMethod method) {
  const multigrid::Solution solution = solved(scene, n, kernels::Model::arap, kappa, method);
  int most = 0;
  std::string inverted;  // after each step
  for (const multigrid::LevelReport& level : solution.report.levels) {
    inverted += (inverted.empty() ? "" : ", ") + std::to_string(level.nx) + "²:";
    for (const multigrid::NewtonStep& step : level.newton) {
      most = std::max(most, step.inverted_cells);
      inverted += " " + std::to_string(step.inverted_cells);
    }
  }
  Json row = joined(
      {{"scene", scene.name}, {"kappa", kappa}, {"n", n}, {"curves", multigrid::name(method)}},
      values_of(solution));
  row["most_inverted"] = most;
  row["inverted_after_steps"] = inverted;
  results.row("eq8", row);
}

void eq8(Results& results) {
  for (const scenes::Scene& scene : {scenes::many_discs(), scenes::turning_discs()})
    for (const int n : {48, 192})
      for (const double kappa : {1e3, 1e4, 1e6})
        for (const CurveMethod method : kMethods) eq8(results, scene, n, kappa, method);
  // Beside locally injective maps, which the study timed on this lattice.
  for (const CurveMethod method : kMethods)
    eq8(results, scenes::sponge(scenes::kStudyOffset), 200, 1e4, method);
}

/// RMS distance of two solutions over the nodes of their lattice, px.
double change_px(const multigrid::Solution& a, const multigrid::Solution& b) {
  double squares = 0.0;
  for (std::size_t k = 0; k < a.u_px.size(); ++k)
    squares += std::pow(a.u_px[k] - b.u_px[k], 2) + std::pow(a.v_px[k] - b.v_px[k], 2);
  return kPicture * std::sqrt(squares / double(a.u_px.size()));
}

/// crpm, as it is and with either remedy for its folded cells.
void fold_free(Results& results, int n) {
  const double offset = scenes::kStudyOffset;
  for (const scenes::Scene& scene :
       {scenes::sponge(offset), scenes::roundabout(90.0, offset), scenes::shift(offset)})
    for (const double kappa : {1.0, 10.0}) {
      const multigrid::Solution averaged = solved(scene, n, kernels::Model::crpm, kappa);
      for (const auto& [model, curves] :
           {std::pair{kernels::Model::crpm, CurveMethod::averaged},
            std::pair{kernels::Model::fold_free, CurveMethod::averaged},
            std::pair{kernels::Model::crpm, CurveMethod::conforming},
            std::pair{kernels::Model::fold_free, CurveMethod::conforming}}) {
        const multigrid::Solution solution = solved(scene, n, model, kappa, curves);
        Json row = joined({{"scene", scene.name},
                           {"kappa", kappa},
                           {"n", n},
                           {"model", std::string(kernels::name(model))},
                           {"curves", multigrid::name(curves)}},
                          values_of(solution));
        row["change_px"] = change_px(solution, averaged);
        results.row("fold_free", row);
      }
    }
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  drumhead::bench::Results results(argc, argv);
  drumhead::bench::all_models(results);
  drumhead::bench::eq8(results);
  drumhead::bench::fold_free(results, 200);
}
