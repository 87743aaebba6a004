// SPDX-License-Identifier: MIT
#include "curve_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace drumhead::multigrid {
namespace {

// Up to here all study scenes and examples converge with conforming cells (stability_cases_test).
constexpr double kMostKappa = 100.0;

constexpr std::array kNames{std::pair{CurveMethod::automatic, "automatic"},
                            std::pair{CurveMethod::averaged, "averaged"},
                            std::pair{CurveMethod::conforming, "conforming"}};

/// A mask may be stiffer in places, as long as the area it keeps can come from elsewhere.
bool gives_way(const grid::Material& material) {
  if (material.model == kernels::Model::harmonic) return true;
  if (material.kappa_cells.empty()) return material.kappa <= kMostKappa;
  return double(*std::ranges::min_element(material.kappa_cells)) <= kMostKappa;
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

std::string why_not_conforming(const WarpProblem& problem, const SolverOptions& options) {
  const kernels::Model model = problem.material.model;
  if (kernels::isotropic(model))
    return "curve method conforming: must be averaged for model " +
           std::string(kernels::name(model)) + "; conforming curves need crpm or harmonic";
  for (const grid::CurvePair& curve : problem.curves)
    if (!std::isinf(curve.weight))
      return "curve '" + curve.name + "': weight = " + std::to_string(curve.weight) +
             ": must be inf with conforming curves";
  if (options.exact) return "exact rows belong to averaged curves, not to conforming ones";
  if (options.solver != Solver::gcr)
    return std::string("solver ") + name(options.solver) + ": conforming curves need gcr";
  return {};
}

CurveMethod chosen_method(const WarpProblem& problem, const SolverOptions& options) {
  if (options.curve_method == CurveMethod::averaged) return CurveMethod::averaged;
  const std::string why_not = why_not_conforming(problem, options);
  if (options.curve_method == CurveMethod::conforming) {
    if (!why_not.empty()) throw std::invalid_argument(why_not);
    return CurveMethod::conforming;
  }
  const bool possible = why_not.empty() && gives_way(problem.material);
  if (possible && options.start != nullptr) return options.start->report.curve_method;
  return possible ? CurveMethod::conforming : CurveMethod::averaged;
}

}  // namespace drumhead::multigrid
