// SPDX-License-Identifier: MIT
#include "solve_notes.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "corners.h"
#include "words.h"

namespace drumhead::multigrid {
namespace {

// A hard curve that misses its target by more than this many cells deserves a word.
constexpr double kNotableGap = 1.0, kNotableConformingGap = 0.5;
// And a share of its area that a closed one gains or loses.
constexpr double kNotableArea = 0.01;

/// ∮ ½ (x dy − y dx), positive where the chain runs clockwise on the screen; of an open chain, 0.
double enclosed_area(const std::vector<grid::CubicBezier>& chain) {
  const grid::Point start = chain.front().control[0];
  const double gap = grid::length(chain.back().control[3] - start);
  if (gap > 1e-9 * grid::arc_length(chain)) return 0.0;
  double area = 0.0;
  for (const grid::CubicBezier& segment : chain)
    for (int n = 0; n < 3; ++n) {  // Gauss: exact, a polynomial of degree 5
      const double t = 0.5 + 0.5 * (n - 1) * std::sqrt(0.6), weight = n == 1 ? 4.0 / 9 : 5.0 / 18;
      area += 0.5 * weight * grid::cross(segment.at(t) - start, segment.derivative(t));
    }
  return area;
}

}  // namespace

void note_gaps(const WarpProblem& problem, SolveReport& report) {
  const bool conforming = report.curve_method == CurveMethod::conforming;
  const double notable_px =
      (conforming ? kNotableConformingGap : kNotableGap) * problem.lattice.cell_px;
  for (std::size_t n = 0; n < report.curves.size(); ++n) {
    const CurveReport& curve = report.curves[n];
    if (!std::isinf(problem.curves[n].weight)) continue;
    if (curve.gap_max_px > notable_px)
      report.notes.push_back("curve '" + curve.name + "' misses its target by up to " +
                             in_words(curve.gap_max_px) + " at " + in_words(curve.worst_px));
  }
}

void note_changed_area(const WarpProblem& problem, SolveReport& report) {
  const EnergyReport& energy = report.energy;
  if (!(energy.volume > energy.elastic)) return;
  const grid::CurvePair* worst = nullptr;
  double change = kNotableArea;
  for (const grid::CurvePair& curve : problem.curves) {
    const double before = std::abs(enclosed_area(curve.source)),
                 length = grid::arc_length(curve.source);
    // The areas of loops that cross cancel, and a flat one has none to compare with.
    const bool flat = before < 0.01 * length * length / (4.0 * std::numbers::pi);
    if (flat || !std::isinf(curve.weight)) continue;
    const double gain = std::abs(enclosed_area(curve.target)) / before - 1.0;
    if (std::abs(gain) <= std::abs(change)) continue;
    change = gain;
    worst = &curve;
  }
  if (!worst) return;
  report.notes.push_back("curve '" + worst->name + "' encloses " + percent(std::abs(change)) +
                         (change > 0.0 ? " more" : " less") +
                         " area at its target, which kappa resists: areas hold " +
                         percent(energy.volume / energy.total) + " of the energy");
}

void note_folds(const grid::Material& material, SolveReport& report) {
  const FoldReport& folds = report.folds;
  const bool free = material.model == kernels::Model::fold_free ||
                    (material.model == kernels::Model::arap && material.kappa >= kAsInequality);
  const bool collapses = material.model == kernels::Model::stvk;
  if (folds.folded_cells == 0 || (!free && !collapses)) return;
  report.notes.push_back(
      std::string(free ? "no state without folds was found: "
                       : "stvk yields where it is pressed below 1/√3 of its length: ") +
      std::to_string(folds.folded_cells) + " cells are folded, one at " +
      in_words(folds.places_px.front()));
}

}  // namespace drumhead::multigrid
