// SPDX-License-Identifier: MIT
#pragma once
// The study scenes with the membranes of model.h, and how they are solved.
#include <ostream>
#include <vector>

#include <drumhead/kernels/model.h>

#include "support/scene_problem.h"

namespace drumhead::scenes {

struct MembraneCase {
  const char* name;
  Scene scene;
  kernels::Model model;
  double kappa = 1.0;
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

/// The case on n × n cells, to `tolerance_cells` (0: the default error).
inline multigrid::Solution solved(const MembraneCase& c, int n, double tolerance_cells,
                                  multigrid::SolverOptions options) {
  multigrid::WarpProblem membrane = problem(c.scene, n, c.kappa);
  membrane.material.model = c.model;
  options.tolerance_px = tolerance_cells / n;
  return multigrid::solve(membrane, options);
}

}  // namespace drumhead::scenes
