// SPDX-License-Identifier: MIT
// The whole solve on the study scenes (curves clear of lattice lines, picture of 1000 px): work
// units, time, memory and errors, as rows of JSON (results.h), of the median of three solves.
// Beside them
//
//     product_of_streaming     a work unit's Hessian–vector product against the loop that moves its
//                              bytes and computes nothing, in turns with it (roofline.h): 1 is the
//                              speed of memory
//     threads_gain, stream_gain, gain_share      at 800², in turns: seconds on one thread by those
//                              on two, of the solve and of that loop, and the first by the second
//   solve_bench [--large] [--threads N]      --large: also 1600² and 3200²
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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
// Up to kMostRepeated² cells so many solves are made, of which the one of median time counts: the
// first of a process fetches its memory.
constexpr int kSolves = 3, kMostRepeated = 800;

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

void run(const Case& c, multigrid::CurveMethod curves, int n, int threads, double streaming,
         Results& results) {
  const multigrid::WarpProblem problem = scenes::problem(c.scene, n, c.kappa);
  const multigrid::SolverOptions options{.curve_method = curves, .threads = threads};
  const multigrid::Solution solution = median_solve(problem, options);
  Json row = joined(joined(keys_of(c.scene, c.kappa),
                           {{"curves", multigrid::name(curves)}, {"n", n}, {"threads", threads}}),
                    values_of(solution));
  const bool conforming = curves == multigrid::CurveMethod::conforming;
  if (n <= (conforming ? kMostForConformingError : kMostForError))
    row["true_share"] =
        true_error(problem, solution, options) / (kPicture * solution.report.discretisation_rms_px);
  row["product_of_streaming"] = streaming;
  if (n == kThreadCells && threads == 1) row.update(gains(problem, options));
  results.row("solve", row);
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
      for (std::size_t k = 0; k < sizes.size(); ++k)
        bench::run(c, curves, sizes[k], threads, streaming[k], results);
  return 0;
}
