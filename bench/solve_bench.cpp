// SPDX-License-Identifier: MIT
// The whole solve on the study scenes (picture of 1000 px): work units, time, memory and errors, as
// rows of JSON (results.h). Where curves lie between the lines of the lattice changes work units by
// more than most changes of the solver do, so scenes are moved by several offsets: values are those
// of the study's (curves clear of lattice lines), but
//
//     work_units, seconds, cut_seconds, newton, cycles, true_share      means over the offsets
//     work_units_least, work_units_most, seconds_least, seconds_most, true_share_most
//     offsets                  how many
//     status                   the worst: of the first that did not converge, if there is one
//
// Beside them
//
//     product_of_streaming     a work unit's Hessian–vector product against the loop that moves its
//                              bytes and computes nothing, in turns with it (roofline.h): 1 is the
//                              speed of memory
//     threads_gain, stream_gain, gain_share      at 800², in turns: seconds on one thread by those
//                              on two, of the solve and of that loop, and the first by the second
//
// and with --large rows of "growth": the sponge's work units on 3200² by those on 800², at each of
// their offsets.
//   solve_bench [--large] [--threads N]      --large: the sponge also on 1600² and 3200²
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/threads.h>

#include "bench_level.h"
#include "roofline.h"
#include "solution_values.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

// Conforming cells leave so little that the reference needs double precision.
constexpr int kMostForError = 800, kMostForConformingError = 200;

// A product reads d, x̂ and P and writes the image of d: three fields each.
constexpr Mix kProduct{6, 3, 0};
constexpr int kThreadCells = 800, kGainPairs = 5;
// Up to kMostRepeated² cells so many solves are made at each offset, of which the one of median
// time counts: the first of a process fetches its memory.
constexpr int kSolves = 3, kMostRepeated = 400;
constexpr std::array kOffsets{scenes::kStudyOffset, 0.001, 0.004, 0.0, 0.002, 0.003, 0.005};
// Beyond that only the first few, of the scene whose growth counts: all scenes on 1600² and 3200²
// took half an hour.
constexpr int kMostForAllOffsets = 800;
constexpr std::size_t kFewOffsets = 3;
constexpr int kGrowthFrom = 800, kGrowthTo = 3200;
const char* const kGrowthScene = "S1";

std::size_t offsets(int n) { return n <= kMostForAllOffsets ? kOffsets.size() : kFewOffsets; }

/// The speed of the Hessian–vector product on n² cells, as a share of its streaming loop's.
double product_of_streaming(int n) {
  const kernels::ThreadLimit one(1);
  BenchLevel<float> level(n);
  const Streams streams(kProduct, level.nodes(), sizeof(float));
  const auto product = [&] {
    kernels::apply_hessian<float>(level.membrane(), level.d.view(), level.out.view());
  };
  return Paired(1, product, [&] { streams.run(1); }).ratio();
}

/// Gains of a second thread, as values of a row.
Json gains(const multigrid::WarpProblem& problem, multigrid::SolverOptions options) {
  const Streams streams(kProduct, problem.lattice.nodes(), sizeof(float));
  std::vector<double> solve, stream;
  for (int pair = 0; pair < kGainPairs; ++pair) {
    double seconds[2];
    for (const int threads : {1, 2}) {
      options.threads = threads;
      seconds[threads - 1] = seconds_of(multigrid::solve(problem, options));
    }
    solve.push_back(seconds[0] / seconds[1]);
    const Paired loops(
        2, [&] { streams.run(2); }, [&] { streams.run(1); });
    stream.push_back(loops.ratio());
  }
  return {{"threads_gain", median(solve)},
          {"stream_gain", median(stream)},
          {"gain_share", median(solve) / median(stream)}};
}

struct Case {
  scenes::Scene (*scene)(double offset);
  double kappa;
};

std::vector<Case> cases() {
  const auto s2 = [](double offset) { return scenes::roundabout(90.0, offset); };
  return {{scenes::sponge, 1.0},  {s2, 10.0}, {scenes::shift, 10.0}, {s2, 100.0},
          {scenes::shift, 100.0}, {s2, 1e4},  {scenes::shift, 1e4},  {scenes::pinch, 1.0}};
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

/// The algebraic error against a solve to a hundredth of the tolerance that the first one had.
double true_error(const multigrid::WarpProblem& problem, const multigrid::Solution& solution,
                  multigrid::SolverOptions options) {
  options.tolerance_px = 1e-3 * solution.report.discretisation_rms_px;
  return difference(solution, multigrid::solve(problem, options));
}

multigrid::Solution median_solve(const multigrid::WarpProblem& problem,
                                 const multigrid::SolverOptions& options) {
  const int solves = problem.lattice.nx <= kMostRepeated ? kSolves : 1;
  std::vector<multigrid::Solution> all;
  for (int k = 0; k < solves; ++k) all.push_back(multigrid::solve(problem, options));
  std::ranges::nth_element(all, all.begin() + solves / 2, {}, seconds_of);
  return all[std::size_t(solves / 2)];
}

/// Values of one solve, the algebraic error's true share among them where it can be had.
Json solve_values(const multigrid::WarpProblem& problem, const multigrid::SolverOptions& options) {
  const multigrid::Solution solution = median_solve(problem, options);
  Json values = values_of(solution);
  const bool conforming = options.curve_method == multigrid::CurveMethod::conforming;
  if (problem.lattice.nx <= (conforming ? kMostForConformingError : kMostForError))
    values["true_share"] =
        true_error(problem, solution, options) / (kPicture * solution.report.discretisation_rms_px);
  return values;
}

std::vector<double> all_of(const std::vector<Json>& rows, const char* key) {
  std::vector<double> values;
  for (const Json& row : rows) values.push_back(row.at(key));
  return values;
}
double mean(const std::vector<double>& values) {
  return std::reduce(values.begin(), values.end()) / double(values.size());
}

/// The first offset's values, those that depend on chance over all of them.
Json over_offsets(const std::vector<Json>& rows) {
  Json out = rows.front();
  for (const char* key : {"work_units", "seconds", "cut_seconds", "newton", "cycles", "true_share"})
    if (out.contains(key)) out[key] = mean(all_of(rows, key));
  for (const std::string key : {"work_units", "seconds"}) {
    out[key + "_least"] = std::ranges::min(all_of(rows, key.c_str()));
    out[key + "_most"] = std::ranges::max(all_of(rows, key.c_str()));
  }
  if (out.contains("true_share"))
    out["true_share_most"] = std::ranges::max(all_of(rows, "true_share"));
  for (const Json& row : rows)
    if (out["status"] == "converged") out["status"] = row["status"];
  out["offsets"] = rows.size();
  return out;
}

/// Work units at each offset.
std::vector<double> run(const Case& c, multigrid::CurveMethod curves, int n, int threads,
                        double streaming, Results& results) {
  const multigrid::SolverOptions options{.curve_method = curves, .threads = threads};
  const scenes::Scene scene = c.scene(kOffsets[0]);
  std::vector<Json> rows;
  for (std::size_t k = 0; k < offsets(n); ++k)
    rows.push_back(solve_values(scenes::problem(c.scene(kOffsets[k]), n, c.kappa), options));
  Json row = joined(joined(keys_of(scene, c.kappa),
                           {{"curves", multigrid::name(curves)}, {"n", n}, {"threads", threads}}),
                    over_offsets(rows));
  row["product_of_streaming"] = streaming;
  if (n == kThreadCells && threads == 1)
    row.update(gains(scenes::problem(scene, n, c.kappa), options));
  results.row("solve", row);
  return all_of(rows, "work_units");
}

/// A case on all lattices by one way to meet curves; of the first case also the growth.
void run_all(const Case& c, multigrid::CurveMethod curves, const std::vector<int>& sizes,
             int threads, const std::vector<double>& streaming, Results& results) {
  const scenes::Scene scene = c.scene(kOffsets[0]);
  std::vector<double> before, growth;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (sizes[k] > kMostForAllOffsets && scene.name != kGrowthScene) break;
    const std::vector<double> units = run(c, curves, sizes[k], threads, streaming[k], results);
    if (sizes[k] == kGrowthFrom) before = units;
    for (std::size_t o = 0; sizes[k] == kGrowthTo && o < units.size(); ++o)
      growth.push_back(units[o] / before[o]);
  }
  if (growth.empty()) return;
  results.row("growth", joined(keys_of(scene, c.kappa), {{"curves", multigrid::name(curves)},
                                                         {"n", kGrowthTo},
                                                         {"threads", threads},
                                                         {"growth", mean(growth)},
                                                         {"growth_least", std::ranges::min(growth)},
                                                         {"growth_most", std::ranges::max(growth)},
                                                         {"offsets", growth.size()}}));
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
  bench::Results results(argc, argv);
  std::vector<int> sizes{100, 200, 400, 800};
  if (large) sizes.insert(sizes.end(), {1600, 3200});
  std::vector<double> streaming;
  for (const int n : sizes) streaming.push_back(bench::product_of_streaming(n));
  for (const bench::Case& c : bench::cases())
    for (const auto curves : {multigrid::CurveMethod::averaged, multigrid::CurveMethod::conforming})
      bench::run_all(c, curves, sizes, threads, streaming, results);
  return 0;
}
