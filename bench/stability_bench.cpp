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
//
// and the 31 cases of the study at 32² with exact rows, at 128² with exact rows and with both ways
// to meet curves: rows of the table "study":
//
//     case, n, method      "exact rows", "averaged", "conforming"
//     ended, newton, newton_all, cycles, energy
//     known, unique        least energy known at 32² with exact rows; whether minima are unique
//     passed               exact rows: converged and, at 32² where minima are unique, with no more
//                          than that energy
//     note                 exact rows that did not converge: what is left
//   stability_bench                    all but exact rows
//   stability_bench --exact N ...      exact rows alone, on N² cells; several --exact are possible
// Exit code 1 where a case of averaged curves does not end as expected, or one of exact rows at 32²
// neither that nor with a note.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "results.h"
#include "support/hard_cases.h"

namespace drumhead::bench {
namespace {

constexpr int kStudyCells = 128, kKnownCells = 32;
// Energies are known to eight digits.
constexpr double kRounding = 1e-7;

/// Values of the table "study" but what only exact rows have.
Json study_row(const scenes::HardCase& hard, int n, const char* method,
               const multigrid::SolveReport& report) {
  std::size_t steps = 0;
  int cycles = 0;
  for (const multigrid::LevelReport& level : report.levels) steps += level.newton.size();
  for (const multigrid::NewtonStep& step : report.levels.back().newton) cycles += step.krylov;
  return {{"case", hard.name},
          {"n", n},
          {"method", method},
          {"ended", multigrid::name(report.status)},
          {"newton", report.levels.back().newton.size()},
          {"newton_all", steps},
          {"cycles", cycles},
          {"energy", report.energy.total},
          {"known", hard.energy_at_32},
          {"unique", hard.unique}};
}

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
  if (hard.group == "study")
    results.row("study", study_row(hard, kStudyCells, multigrid::name(method), report));
  return passed || !averaged;
}

/// The study's cases with exact rows; false where one on kKnownCells cells is not as expected.
bool run_exact(int n, Results& results) {
  bool right = true;
  for (const scenes::HardCase& hard : scenes::study_cases(n)) {
    const multigrid::SolveReport report = multigrid::solve(hard.problem, {.exact = true}).report;
    const bool least = n != kKnownCells || !hard.unique ||
                       report.energy.total <= (1.0 + kRounding) * hard.energy_at_32;
    const bool passed = least && report.status == multigrid::Status::converged;
    Json row = study_row(hard, n, "exact rows", report);
    row["passed"] = passed;
    if (report.status != multigrid::Status::converged)
      for (const std::string& note : report.notes)
        if (note.starts_with("exact curve rows")) row["note"] = note;
    results.row("study", row);
    right &= n != kKnownCells || passed || (least && row.contains("note"));
  }
  return right;
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  std::vector<int> exact;
  for (int k = 1; k + 1 < argc && std::string_view(argv[k]) == "--exact"; k += 2)
    exact.push_back(std::atoi(argv[k + 1]));
  if (2 * int(exact.size()) + 1 != argc ||
      std::ranges::any_of(exact, [](int n) { return n < bench::kKnownCells; })) {
    std::fprintf(stderr, "usage: stability_bench [--exact N]...      N >= %d\n",
                 bench::kKnownCells);
    return 2;
  }
  bench::Results results(argc, argv);
  bool right = true;
  for (const int n : exact) right &= bench::run_exact(n, results);
  if (!exact.empty()) return right ? 0 : 1;
  for (const auto& cases : {scenes::degenerate_cases(), scenes::study_cases(bench::kStudyCells)})
    for (const scenes::HardCase& hard : cases)
      for (const auto method :
           {multigrid::CurveMethod::averaged, multigrid::CurveMethod::conforming})
        right &= bench::run(hard, method, results);
  return right ? 0 : 1;
}
