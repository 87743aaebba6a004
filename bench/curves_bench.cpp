// SPDX-License-Identifier: MIT
// The two ways to meet curves, as rows of JSON (results.h): errors, folds, steps and time by
// lattice; the seconds in which errors of 1, 0.3, 0.1 and 0.03 px are reached on any of the
// lattices; and what the list of special cells adds to a product. One thread, default tolerance,
// best of three.
//   curves_bench [--truth FOLDER]      the folder (truth.h) is for the sponge alone
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>

#include <drumhead/kernels/threads.h>

#include "solution_values.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"
#include "truth.h"

namespace drumhead::bench {
namespace {

using multigrid::CurveMethod;

constexpr int kRepeats = 3;
constexpr std::array kTargets{1.0, 0.3, 0.1, 0.03};  // px RMS
// Divisors of Truth::kFinest; those of the order table are each twice the one before.
constexpr std::array kSizes{32, 50, 64, 80, 100, 160, 200, 320, 400, 800};
constexpr std::array kOrderSizes{50, 100, 200, 400, 800};

multigrid::Solution fastest(const multigrid::WarpProblem& problem, CurveMethod curves) {
  multigrid::Solution best;
  double seconds = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    multigrid::Solution solution =
        multigrid::solve(problem, {.curve_method = curves, .threads = 1});
    if (seconds_of(solution) >= seconds) continue;
    seconds = seconds_of(solution);
    best = std::move(solution);
  }
  return best;
}

void run(const scenes::Scene& scene, double kappa, const std::string& folder, Results& results) {
  const Truth truth(scene, kappa, folder);
  for (const CurveMethod curves : {CurveMethod::averaged, CurveMethod::conforming}) {
    const Json keys = joined(keys_of(scene, kappa), {{"curves", multigrid::name(curves)}});
    std::array<double, kTargets.size()> seconds{};
    std::array<int, kTargets.size()> cells{};
    for (const int n : kSizes) {
      if (n > truth.most_cells()) continue;
      const multigrid::Solution solution = fastest(scenes::problem(scene, n, kappa), curves);
      const Truth::Error error = truth.error(n, solution.u_px, solution.v_px);
      const double took = seconds_of(solution);
      for (std::size_t t = 0; t < kTargets.size(); ++t) {
        if (error.rms_px > kTargets[t] || (cells[t] > 0 && seconds[t] <= took)) continue;
        seconds[t] = took;
        cells[t] = n;
      }
      if (std::ranges::find(kOrderSizes, n) == kOrderSizes.end()) continue;
      const Json errors{{"n", n}, {"rms_px", error.rms_px}, {"max_px", error.max_px}};
      results.row("curves", joined(joined(keys, errors), values_of(solution)));
    }
    for (std::size_t t = 0; t < kTargets.size(); ++t) {
      Json row = joined(keys, {{"target_px", kTargets[t]}});
      row["seconds"] = cells[t] > 0 ? Json(seconds[t]) : Json(nullptr);
      row["n"] = cells[t] > 0 ? Json(cells[t]) : Json(nullptr);
      results.row("curves_reach", row);
    }
  }
}

/// Processor time of this thread.
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Least seconds of a product with and without the special cells, alternated.
void list_share(const scenes::Scene& scene, double kappa, int n, Results& results) {
  scenes::NewtonLevel<float> level(scenes::problem(scene, n, kappa), 0.005, 1.0,
                                   CurveMethod::conforming);
  kernels::Membrane<float> with = level.level().membrane(), without = with;
  without.special = nullptr;
  level.level().conforming->rows.linearise(with);
  double seconds[2] = {1e9, 1e9};
  for (int repeat = 0; repeat < 100; ++repeat)
    for (const bool special : {false, true}) {
      const double start = now();
      kernels::apply_hessian<float>(special ? with : without, level.level().d.view(),
                                    level.level().f.view());
      seconds[special] = std::min(seconds[special], now() - start);
    }
  results.row("curves_share",
              joined(keys_of(scene, kappa), {{"n", n},
                                             {"special_cells", with.special->cells().size()},
                                             {"share", 1.0 - seconds[0] / seconds[1]}}));
}

void run_all(const std::string& folder, Results& results) {
  const double offset = scenes::kStudyOffset;
  const scenes::Scene roundabout = scenes::roundabout(90.0, offset), shift = scenes::shift(offset);
  for (const double kappa : {1.0, 10.0, 100.0, 1e4}) run(roundabout, kappa, {}, results);
  for (const double kappa : {1.0, 10.0, 100.0}) run(shift, kappa, {}, results);
  run(scenes::sponge(offset), 1.0, folder, results);
  const kernels::ThreadLimit one(1);
  for (const scenes::Scene& scene : {scenes::sponge(offset), roundabout, shift})
    list_share(scene, 10.0, 400, results);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) try {
  using namespace drumhead::bench;
  const std::string folder = truth_folder(argc, argv);
  if (argc > 1 && (folder.empty() || argc > 3)) {
    std::fputs("usage: curves_bench [--truth FOLDER]\n", stderr);
    return 2;
  }
  Results results(argc, argv);
  run_all(folder, results);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "curves_bench: %s\n", error.what());
  return 1;
}
