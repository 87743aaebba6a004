// SPDX-License-Identifier: MIT
// The whole solve on the study scenes (curves clear of lattice lines, picture of 1000 px): work
// units, time, memory and errors, as a Markdown table.
//   solve_bench [--large] [--threads N]      --large: also 1600² and 3200²
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

constexpr double kPicture = 1000.0;  // px of the unit square
constexpr int kMostForError = 800;

struct Case {
  scenes::Scene scene;
  double kappa;
};

std::vector<Case> cases() {
  const double offset = scenes::kStudyOffset;
  const scenes::Scene s1 = scenes::sponge(offset), s2 = scenes::roundabout(90.0, offset),
                      s3 = scenes::pinch(offset), s4 = scenes::shift(offset);
  return {{s1, 1.0},   {s2, 10.0}, {s4, 10.0}, {s2, 100.0},
          {s4, 100.0}, {s2, 1e4},  {s4, 1e4},  {s3, 1.0}};
}

/// RMS over the nodes of |u − u'|, px.
double difference(const multigrid::Solution& a, const multigrid::Solution& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.u_px.size(); ++k) {
    const double u = a.u_px[k] - b.u_px[k], v = a.v_px[k] - b.v_px[k];
    sum += u * u + v * v;
  }
  return kPicture * std::sqrt(sum / double(a.u_px.size()));
}

/// The algebraic error against a solve to a thousandth of the tolerance that the first one had.
double true_error(const multigrid::WarpProblem& problem, const multigrid::Solution& solution,
                  multigrid::SolverOptions options) {
  options.tolerance_px = 1e-4 * solution.report.discretisation_rms_px;
  return difference(solution, multigrid::solve(problem, options));
}

void run(const Case& c, int n, int threads) {
  const multigrid::WarpProblem problem = scenes::problem(c.scene, n, c.kappa);
  const multigrid::SolverOptions options{.threads = threads};
  const multigrid::Solution solution = multigrid::solve(problem, options);
  const multigrid::SolveReport& report = solution.report;
  std::size_t newton = 0;
  int cycles = 0;
  for (const multigrid::NewtonStep& step : report.levels.back().newton) cycles += step.krylov;
  newton = report.levels.back().newton.size();
  double gap = 0.0, length = 0.0;
  for (const multigrid::CurveReport& curve : report.curves) {
    gap += curve.length_px * curve.gap_rms_px * curve.gap_rms_px;
    length += curve.length_px;
  }
  gap = kPicture * std::sqrt(gap / length);
  const double discretisation = kPicture * report.discretisation_rms_px;
  if (c.scene.kappa_mask)
    std::printf("| %s mask | %d² ", c.scene.name.c_str(), n);
  else
    std::printf("| %s kappa %g | %d² ", c.scene.name.c_str(), c.kappa, n);
  std::printf("| %s | %.0f | %.3f + %.3f | %zu | %d | %.0f | %.3f | %.3f | %.3f |",
              multigrid::name(report.status), report.work_units, report.cut_seconds,
              report.solve_seconds, newton, cycles,
              double(report.solver_bytes) / double(solution.lattice.nodes()), gap, discretisation,
              kPicture * report.algebraic_rms_px / discretisation);
  if (n <= kMostForError)
    std::printf(" %.3f |\n", true_error(problem, solution, options) / discretisation);
  else
    std::printf(" – |\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  bool large = false;
  int threads = 1;
  for (int k = 1; k < argc; ++k) {
    const std::string_view argument = argv[k];
    if (argument == "--large") {
      large = true;
    } else if (argument == "--threads" && k + 1 < argc) {
      threads = std::atoi(argv[++k]);
    } else {
      std::fprintf(stderr, "usage: solve_bench [--large] [--threads N]\n");
      return 2;
    }
  }
  std::puts(
      "| scene | lattice | status | work units | seconds, cut + solve | Newton steps | "
      "cycles | B/node | curve gap, px | discretisation error, px | algebraic error, "
      "estimated share of it | true share |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|");
  std::vector<int> sizes{100, 200, 400, 800};
  if (large) sizes.insert(sizes.end(), {1600, 3200});
  for (const bench::Case& c : bench::cases())
    for (const int n : sizes) bench::run(c, n, threads);
  return 0;
}
