// SPDX-License-Identifier: MIT
#include "solve_notes.h"

#include <cmath>
#include <string>

#include "corners.h"
#include "words.h"

namespace drumhead::multigrid {
namespace {

// A hard curve that misses its target by more than this many cells deserves a word.
constexpr double kNotableGap = 1.0, kNotableConformingGap = 0.5;

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
