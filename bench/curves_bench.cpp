// SPDX-License-Identifier: MIT
// The two ways to meet curves on the roundabout (S2), against its exact radial solution: error,
// folds, steps and time by lattice, as rows of JSON (results.h). One thread, default tolerance,
// best of three.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>

#include "solution_values.h"
#include "support/radial_reference.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

constexpr int kRepeats = 3;

struct Error {
  double rms = 0.0, max = 0.0;  // px
};

Error error_of(const multigrid::Solution& solution, const oracle::RadialReference& exact) {
  const int n = solution.lattice.nx;
  const double offset = scenes::kStudyOffset;
  const std::complex<double> centre(.5 + offset, .5 + .7 * offset);
  Error error;
  double sum = 0.0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = std::size_t(j) * std::size_t(n + 1) + std::size_t(i);
      const std::complex<double> rest(double(i) / n, double(j) / n);
      const std::complex<double> moved(solution.u_px[k], solution.v_px[k]);
      const double miss = kPicture * std::abs(rest + moved - centre - exact.at(rest - centre));
      sum += miss * miss;
      error.max = std::max(error.max, miss);
    }
  error.rms = std::sqrt(sum) / (n + 1);
  return error;
}

void run(double kappa, multigrid::CurveMethod method, int n, Results& results) {
  const multigrid::WarpProblem problem =
      scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), n, kappa);
  multigrid::SolverOptions options;
  options.threads = 1;
  options.curve_method = method;
  multigrid::Solution best;
  double seconds = 1e300;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    multigrid::Solution solution = multigrid::solve(problem, options);
    if (seconds_of(solution) >= seconds) continue;
    seconds = seconds_of(solution);
    best = std::move(solution);
  }
  const Error error = error_of(best, {.22, .40, std::acos(0.0), kappa});
  results.row("curves", joined({{"scene", "S2"},
                                {"kappa", kappa},
                                {"curves", multigrid::name(method)},
                                {"n", n},
                                {"rms_px", error.rms},
                                {"max_px", error.max}},
                               values_of(best)));
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using drumhead::multigrid::CurveMethod;
  drumhead::bench::Results results(argc, argv);
  for (const double kappa : {1.0, 10.0})
    for (const CurveMethod method : {CurveMethod::averaged, CurveMethod::conforming})
      for (const int n : {50, 100, 200, 400}) drumhead::bench::run(kappa, method, n, results);
}
