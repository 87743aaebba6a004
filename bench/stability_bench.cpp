// SPDX-License-Identifier: MIT
// How the hard cases of the stability tests end, with averaged and with conforming curves: rows of
// the table "stability" (results.h):
//
//     group, case, method
//     expected, bound      status, and Newton steps on the finest lattice, that the tests demand of
//                          averaged curves
//     ended, newton        what came
//     energy               total, per mu and lattice area
//     gap_max_px           of any curve, px of the picture (of 1000 for the study's unit square)
//     inverted, folded     cells with J < 0 at the centre, at any corner
//     passed               true where the demands are met
// Exit code 1 where a case of averaged curves does not end as expected.
#include <algorithm>

#include "results.h"
#include "support/hard_cases.h"

namespace drumhead::bench {
namespace {

constexpr int kStudyCells = 128;

bool run(const scenes::HardCase& hard, multigrid::CurveMethod method, Results& results) {
  const multigrid::SolveReport report =
      multigrid::solve(hard.problem, {.curve_method = method}).report;
  const bool averaged = method == multigrid::CurveMethod::averaged;
  const int steps = int(report.levels.back().newton.size());
  double gap = 0.0;
  for (const multigrid::CurveReport& curve : report.curves) gap = std::max(gap, curve.gap_max_px);
  const bool passed = report.status == hard.status &&
                      (!averaged || (steps <= hard.most_steps && gap <= hard.most_gap_px));
  Json row = {{"group", hard.group},
              {"case", hard.name},
              {"method", std::string("drumhead, ") + multigrid::name(method)},
              {"expected", multigrid::name(hard.status)},
              {"ended", multigrid::name(report.status)},
              {"newton", steps}};
  if (averaged) row["bound"] = hard.most_steps;
  row.update({{"energy", report.energy.total},
              {"gap_max_px", gap * (hard.group == "study" ? 1000.0 : 1.0)},
              {"inverted", report.folds.inverted_cells},
              {"folded", report.folds.folded_cells},
              {"passed", passed}});
  results.row("stability", row);
  return passed || !averaged;
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  bench::Results results(argc, argv);
  bool right = true;
  for (const auto& cases : {scenes::degenerate_cases(), scenes::study_cases(bench::kStudyCells)})
    for (const scenes::HardCase& hard : cases)
      for (const auto method :
           {multigrid::CurveMethod::averaged, multigrid::CurveMethod::conforming})
        right &= bench::run(hard, method, results);
  return right ? 0 : 1;
}
