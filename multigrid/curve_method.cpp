// SPDX-License-Identifier: MIT
#include "curve_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace drumhead::multigrid {
namespace {

constexpr std::array kNames{std::pair{CurveMethod::automatic, "auto"},
                            std::pair{CurveMethod::averaged, "averaged"},
                            std::pair{CurveMethod::conforming, "conforming"}};

// Isotropic membranes: kappa from which Newton's method on conforming cells often ends elsewhere
// than in a solution (Eq. 8 as an inequality leaves one folded triangle of ML on 96²).
constexpr double kMostStiffness = 300.0;
// Soft curves, crpm: kappa from which stiff ones leave each linear system to GCR (S2 on 400²,
// weights 1e4, 1e5, 1e6, hard: 47, 74, 61, 40 cycles at kappa 100, 131, 1036, 102, 39 at 300; at
// 1e4 with 1e6 none converges).
constexpr double kMostSoftStiffness = 200.0;

/// Where conforming cells are expected to converge. Not with stvk: what its cells do after their
/// collapse takes more Newton steps than there are (S1 and S4, kappa 1, 128²).
bool settles(const WarpProblem& problem) {
  const grid::Material& material = problem.material;
  const double stiffness = grid::largest_stiffness(material);
  const auto soft = [](const grid::CurvePair& curve) { return !std::isinf(curve.weight); };
  if (!kernels::isotropic(material.model))
    return stiffness <= kMostSoftStiffness || std::ranges::none_of(problem.curves, soft);
  return material.model != kernels::Model::stvk && stiffness <= kMostStiffness;
}

}  // namespace

const char* name(CurveMethod method) {
  return std::ranges::find(kNames, method, [](const auto& entry) { return entry.first; })->second;
}

std::optional<CurveMethod> curve_method_named(std::string_view wanted) {
  const auto* found =
      std::ranges::find_if(kNames, [&](const auto& entry) { return wanted == entry.second; });
  if (found == kNames.end()) return std::nullopt;
  return found->first;
}

CurveMethod chosen_method(const WarpProblem& problem, const SolverOptions& options) {
  if (options.curve_method == CurveMethod::averaged) return CurveMethod::averaged;
  const bool possible = options.solver == Solver::gcr;
  if (options.curve_method == CurveMethod::conforming) {
    if (!possible)
      throw std::invalid_argument(std::string("solver ") + name(options.solver) +
                                  ": conforming curves need gcr");
    return CurveMethod::conforming;
  }
  if (!possible || options.exact || !settles(problem)) return CurveMethod::averaged;
  return options.start != nullptr ? options.start->report.curve_method : CurveMethod::conforming;
}

}  // namespace drumhead::multigrid
