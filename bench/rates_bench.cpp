// SPDX-License-Identifier: MIT
// What each linear solver takes to reduce the residual of a Newton system by ten, in work units
// (one Hessian–vector product timed in the same run), as rows of JSON (results.h): all solvers,
// scenes, kappa and weights d of the curves: soft ones; hard ones as the default path takes them
// (d 1e6, q-jump); exact rows ("exact": true), 1/d = 0 and without the jump, in double precision.
//   rates_bench [N]      cells a side, 128 if not given
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

#include <drumhead/kernels/threads.h>

#include "solution_values.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

using multigrid::LinearReport;
using multigrid::Solver;

/// Processor time of this thread: the rest of a busy machine does not count.
struct Clock {
  using time_point = std::chrono::duration<double>;
  static time_point now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return time_point(double(t.tv_sec) + 1e-9 * double(t.tv_nsec));
  }
};

constexpr double kJump = 0.005, kTheta = 1.0;
constexpr double kReduction = 1e-3;
constexpr int kEverything = 128, kAll = 512;
constexpr double kMostKappa = 100.0;
// Cycles after which an entry is given up; MINRES takes several iterations for one, and plain
// MINRES, whose iterations grow with n, as many more as the lattice has cells a side.
constexpr int kMostCycles = 60;

constexpr Solver kSolvers[] = {Solver::gcr, Solver::kaczmarz, Solver::coloured_kaczmarz,
                               Solver::minres, Solver::minres_multigrid};

struct Entry {
  double seconds = 0.0;
  LinearReport report;
};

template <class T>
Entry measure(scenes::NewtonLevel<T>& level, Solver solver) {
  const int more = solver == Solver::minres ? std::max(1, level.level().nx / kEverything) : 1;
  multigrid::LinearOptions options{.solver = solver,
                                   .content = kReduction,
                                   .reduction = kReduction,
                                   .most_cycles = more * kMostCycles};
  Entry entry;
  const Clock::time_point start = Clock::now();
  entry.report = level.solve(options);
  entry.seconds = (Clock::now() - start).count();
  return entry;
}

/// What `solver` takes for the system, as a row that begins with `keys`.
template <class T>
void add(const Json& keys, scenes::NewtonLevel<T>& level, Solver solver, const std::string& name,
         Results& results) {
  const double unit = level.template product_seconds<Clock>();
  const Entry entry = measure(level, solver);
  const double digits = -std::log10(entry.report.residual);
  // What gains less than an eighth has no rate.
  const double rate =
      digits > 0.05 ? entry.seconds / unit / digits : std::numeric_limits<double>::quiet_NaN();
  results.row("rates", joined(keys, {{"solver", name},
                                     {"work_units_per_digit", rate},
                                     {"cycles", entry.report.cycles},
                                     {"converged", entry.report.residual <= kReduction}}));
}

/// Whether a solver is asked for curves of this weight on n × n cells.
bool taken(Solver solver, double weight, int n) {
  return solver == Solver::gcr || n <= kEverything || (n <= kAll && std::isinf(weight));
}

/// `weight`: of the curves, d.
void run(const scenes::Scene& scene, double kappa, double weight, int n, Results& results) {
  multigrid::WarpProblem problem = scenes::problem(scene, n, kappa);
  for (grid::CurvePair& curve : problem.curves) curve.weight = weight;
  Json keys = joined(keys_of(scene, kappa), {{"n", n}});
  if (std::isfinite(weight)) keys["weight"] = weight;
  scenes::NewtonLevel<float> conforming(problem, kJump, kTheta, multigrid::CurveMethod::conforming);
  add(keys, conforming, Solver::gcr, "gcr, conforming curves", results);
  scenes::NewtonLevel<float> averaged(problem, kJump, kTheta);
  for (const Solver solver : kSolvers)
    if (taken(solver, weight, n)) add(keys, averaged, solver, multigrid::name(solver), results);
}

void run_exact(const scenes::Scene& scene, double kappa, int n, Results& results) {
  scenes::NewtonLevel<double> level(scenes::problem(scene, n, kappa), kJump, kTheta,
                                    multigrid::CurveMethod::averaged,
                                    std::numeric_limits<double>::infinity());
  level.drop_jump();
  const Json keys = joined(keys_of(scene, kappa), {{"n", n}, {"exact", true}});
  for (const Solver solver : kSolvers)
    if (n <= kEverything || solver == Solver::gcr)
      add(keys, level, solver, multigrid::name(solver), results);
}

/// Soft curves, hard ones, exact rows.
void run_all(const scenes::Scene& scene, double kappa, int n, Results& results) {
  if (n <= kAll)
    for (const double weight : {1e2, 1e4}) run(scene, kappa, weight, n, results);
  run(scene, kappa, std::numeric_limits<double>::infinity(), n, results);
  if (n <= kAll) run_exact(scene, kappa, n, results);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  const int n = argc > 1 ? std::atoi(argv[1]) : 128;
  if (n < 32) {
    std::fprintf(stderr, "usage: rates_bench [N]      N >= 32\n");
    return 2;
  }
  const kernels::ThreadLimit one(1);
  bench::Results results(argc, argv);
  const double offset = scenes::kStudyOffset, infinite = std::numeric_limits<double>::infinity();
  for (const scenes::Scene& scene :
       {scenes::sponge(offset), scenes::roundabout(90.0, offset), scenes::shift(offset)}) {
    for (const double kappa : {0.0, 1.0, 10.0, 100.0, 1e4, infinite})
      if (n <= bench::kAll || kappa <= bench::kMostKappa) bench::run_all(scene, kappa, n, results);
  }
  bench::run_all(scenes::pinch(offset), 1.0, n, results);
  return 0;
}
