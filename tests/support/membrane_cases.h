// SPDX-License-Identifier: MIT
#pragma once
// The study scenes with the membranes of model.h, and how they are solved.
#include <limits>
#include <ostream>
#include <vector>

#include "support/scene_problem.h"

namespace drumhead::scenes {

struct MembraneCase {
  const char* name;
  Scene scene;
  kernels::Model model;
  double kappa = 1.0;
  double weight = std::numeric_limits<double>::infinity();  // of all curves
};
inline void PrintTo(const MembraneCase& c, std::ostream* out) { *out << c.name; }
inline const auto case_name = [](const auto& info) { return info.param.name; };

inline const Scene s1 = sponge(kStudyOffset), s2 = roundabout(45.0, kStudyOffset),
                   s4 = shift(kStudyOffset);

/// Those that settle soon, however curves are met.
inline std::vector<MembraneCase> settling_membranes() {
  using kernels::Model;
  return {{"S1corotated", s1, Model::corotated},
          {"S2corotated", s2, Model::corotated},
          {"S4corotated", s4, Model::corotated},
          {"S1linear", s1, Model::linear},
          {"S2linear", s2, Model::linear},
          {"S4linear", s4, Model::linear},
          {"S1neohookean", s1, Model::neohookean},
          {"S2neohookean", s2, Model::neohookean},
          {"S4neohookean", s4, Model::neohookean},
          {"S1arap", s1, Model::arap},
          {"S2arap", s2, Model::arap},
          {"S4arap", s4, Model::arap},
          {"S2stvk", s2, Model::stvk}};
}

/// Eq. 8 as an inequality.
inline std::vector<MembraneCase> one_sided_membranes() {
  using kernels::Model;
  return {{"S1eq8", s1, Model::arap, 1e4},
          {"S2eq8", s2, Model::arap, 1e4},
          {"S4eq8", s4, Model::arap, 1e4}};
}

/// Along soft curves of every weight.
inline std::vector<MembraneCase> soft_membranes() {
  using kernels::Model;
  return {{"S2corotatedSoft1", s2, Model::corotated, 1.0, 1.0},
          {"S2corotatedSoft1e6", s2, Model::corotated, 10.0, 1e6},
          {"S4linearSoft100", s4, Model::linear, 1.0, 100.0},
          {"S2neohookeanSoft100", s2, Model::neohookean, 10.0, 100.0},
          {"S4neohookeanSoft1e4", s4, Model::neohookean, 1.0, 1e4},
          {"S4arapSoft1", s4, Model::arap, 1.0, 1.0},
          {"S2arapSoft1e4", s2, Model::arap, 1.0, 1e4},
          {"S2eq8Soft100", s2, Model::arap, 1e4, 100.0}};
}

inline multigrid::WarpProblem problem_of(const MembraneCase& c, int n) {
  multigrid::WarpProblem membrane = problem(c.scene, n, c.kappa);
  membrane.material.model = c.model;
  for (grid::CurvePair& curve : membrane.curves) curve.weight = c.weight;
  return membrane;
}

/// The case on n × n cells, to `tolerance_cells` (0: the default error).
inline multigrid::Solution solved(const MembraneCase& c, int n, double tolerance_cells,
                                  multigrid::SolverOptions options) {
  options.tolerance_px = tolerance_cells / n;
  return multigrid::solve(problem_of(c, n), options);
}

}  // namespace drumhead::scenes
