// SPDX-License-Identifier: MIT
// One control point of one curve is moved by 5 px of a picture of 1000 px, and the scene solved
// again from its solution, to half a pixel: 256² cells, kappa/mu 10, one thread, circles of four
// segments. With all cut and built anew and with what is kept (SolverOptions::kept), in turns,
// medians; the solutions are compared, bit for bit. Rows of JSON (results.h) in table "drag":
//
//     circles              1 or 100
//     moved                a point of the target, or of the source
//     kept                 whether
//     seconds              of cutting and solving, cut_seconds and cut_share of it
//     call_seconds         of the whole call: what the report says of curves and folds, too
//     left_px              RMS distance from the solution of the changed scene, px
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <drumhead/multigrid/warp.h>

#include "results.h"
#include "roofline.h"

namespace drumhead::bench {
namespace {

constexpr double kPicturePx = 1000.0, kDragPx = 5.0, kTolerancePx = 0.5, kTruthPx = 1e-2;
constexpr int kCells = 256, kRepeats = 15;

std::vector<grid::CubicBezier> circle(grid::Point centre, double radius, double turn) {
  const double quarter = std::numbers::pi / 2.0, reach = 4.0 / 3.0 * std::tan(quarter / 4.0);
  std::vector<grid::CubicBezier> chain;
  for (int n = 0; n < 4; ++n) {
    const double a = turn + n * quarter, b = a + quarter;
    const grid::Point from{std::cos(a), std::sin(a)}, to{std::cos(b), std::sin(b)};
    const grid::Point leave{from.x - reach * from.y, from.y + reach * from.x},
        arrive{to.x + reach * to.y, to.y - reach * to.x};
    chain.push_back({{centre + radius * from, centre + radius * leave, centre + radius * arrive,
                      centre + radius * to}});
  }
  return chain;
}

/// side² circles in rows, turned and some of them moved.
multigrid::WarpProblem scene(int side) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(kPicturePx, kPicturePx, {.cells = kCells, .margin = 0.0});
  problem.material.kappa = 10.0;
  const double apart = kPicturePx / side, radius = side == 1 ? 200.0 : 0.3 * apart;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const grid::Point at{apart * (i + 0.5) + 1.3, apart * (j + 0.5) + 0.7};
      const grid::Point to = at + grid::Point{0.06 * apart * ((i + j) % 3 - 1), 0.0};
      problem.curves.push_back({.name = "circle " + std::to_string(j * side + i),
                                .source = circle(at, radius, 0.1),
                                .target = circle(to, radius, 0.4)});
    }
  return problem;
}

double rms_px(const multigrid::Solution& a, const multigrid::Solution& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.u_px.size(); ++k)
    sum += std::pow(a.u_px[k] - b.u_px[k], 2) + std::pow(a.v_px[k] - b.v_px[k], 2);
  return std::sqrt(sum / double(a.u_px.size()));
}

/// Solves of one kind: the times they took, and the last solution.
struct Solves {
  std::vector<double> cut, all, call;
  multigrid::Solution solution;

  void solve(const multigrid::WarpProblem& problem, const multigrid::SolverOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    solution = multigrid::solve(problem, options);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
    cut.push_back(solution.report.cut_seconds);
    all.push_back(solution.report.cut_seconds + solution.report.solve_seconds);
    call.push_back(whole.count());
  }
  Json values(const multigrid::Solution& truth) const {
    const multigrid::LevelReport& level = solution.report.levels.back();
    int cycles = 0;
    for (const multigrid::NewtonStep& step : level.newton) cycles += step.krylov;
    return {{"status", multigrid::name(solution.report.status)},
            {"seconds", median(all)},
            {"cut_seconds", median(cut)},
            {"cut_share", median(cut) / median(all)},
            {"call_seconds", median(call)},
            {"newton", level.newton.size()},
            {"cycles", cycles},
            {"left_px", rms_px(solution, truth)}};
  }
};

void run(int side, multigrid::CurveMethod method, bool source, Results& results) {
  const multigrid::WarpProblem before = scene(side);
  multigrid::WarpProblem after = before;
  grid::CurvePair& curve = after.curves[after.curves.size() / 2];
  grid::Point& point = (source ? curve.source : curve.target)[1].control[1];
  point = point + grid::Point{kDragPx, 0.0};
  multigrid::SolverOptions options{.curve_method = method, .threads = 1};
  const multigrid::Solution first = multigrid::solve(before, options);
  options.tolerance_px = kTruthPx;
  const multigrid::Solution truth = multigrid::solve(after, options);
  options.tolerance_px = kTolerancePx;
  options.start = &first;
  multigrid::KeptLevels kept;
  multigrid::SolverOptions keeping = options;
  keeping.kept = &kept;
  Solves anew, again;
  for (int n = 0; n < kRepeats; ++n) {
    anew.solve(after, options);
    (void)multigrid::solve(before, keeping);
    again.solve(after, keeping);
  }
  if (anew.solution.u_px != again.solution.u_px || anew.solution.v_px != again.solution.v_px) {
    std::fprintf(stderr, "drag_bench: what was kept has changed the solution\n");
    std::exit(1);
  }
  for (const Solves* solves : {&anew, &again}) {
    Json row{{"circles", side * side},
             {"curves", multigrid::name(method)},
             {"n", kCells},
             {"moved", source ? "source" : "target"},
             {"kept", solves == &again}};
    row.update(solves->values(truth));
    results.row("drag", row);
  }
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  bench::Results results(argc, argv);
  for (const auto curves : {multigrid::CurveMethod::averaged, multigrid::CurveMethod::conforming})
    for (const int side : {1, 10})
      for (const bool source : {false, true}) bench::run(side, curves, source, results);
}
