// SPDX-License-Identifier: MIT
// Scenes whose mu or kappa differ in a disc: rows of the table "masks" (results.h), one thread,
// default tolerance:
//
//     scene, n
//     kappa_in, kappa_out, mu_in, mu_out   in the disc of radius .25 and outside
//     work_units_per_digit    for a factor of ten of the residual of one Newton system, over a
//                             reduction by 1000, in processor time: support/newton_level.h
//     linear_cycles           that this took
//     …                       values of the whole solve (solution_values.h)
#include <cmath>
#include <ctime>

#include <drumhead/kernels/threads.h>

#include "solution_values.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

/// Processor time of this thread: the rest of a busy machine does not count.
struct Clock {
  using time_point = std::chrono::duration<double>;
  static time_point now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return time_point(double(t.tv_sec) + 1e-9 * double(t.tv_nsec));
  }
};

struct Masked {
  scenes::Scene scene;
  int n = 128;
  float kappa_in = 1000.0F, kappa_out = 0.1F, mu_in = 1.0F, mu_out = 1.0F;
};

multigrid::WarpProblem problem_of(const Masked& c) {
  scenes::Scene scene = c.scene;
  scene.kappa_mask = scenes::pinch(scenes::kStudyOffset).kappa_mask;
  multigrid::WarpProblem problem = scenes::problem(scene, c.n, 1.0);
  const bool varying_mu = c.mu_in != 1.0F || c.mu_out != 1.0F;
  for (float& kappa : problem.material.kappa_cells) {
    const bool inside = kappa > 1.0F;
    kappa = inside ? c.kappa_in : c.kappa_out;
    if (varying_mu) problem.material.mu_cells.push_back(inside ? c.mu_in : c.mu_out);
  }
  return problem;
}

void run(const Masked& c, Results& results) {
  constexpr double kJump = 0.005, kTheta = 1.0, kReduction = 1e-3;
  constexpr int kMostCycles = 60;
  const multigrid::WarpProblem problem = problem_of(c);
  scenes::NewtonLevel<float> level(problem, kJump, kTheta);
  const double unit = level.product_seconds<Clock>();
  const Clock::time_point start = Clock::now();
  const multigrid::LinearReport linear =
      level.solve({.content = kReduction, .reduction = kReduction, .most_cycles = kMostCycles});
  const double seconds = (Clock::now() - start).count();
  const double digits = -std::log10(linear.residual);
  results.row(
      "masks",
      joined({{"scene", c.scene.name},
              {"n", c.n},
              {"kappa_in", c.kappa_in},
              {"kappa_out", c.kappa_out},
              {"mu_in", c.mu_in},
              {"mu_out", c.mu_out},
              {"work_units_per_digit", seconds / unit / digits},
              {"linear_cycles", linear.cycles}},
             values_of(multigrid::solve(
                 problem, {.curve_method = multigrid::CurveMethod::averaged, .threads = 1}))));
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  const kernels::ThreadLimit one(1);
  bench::Results results(argc, argv);
  const double offset = scenes::kStudyOffset;
  const scenes::Scene pinch = scenes::pinch(offset), turn = scenes::roundabout(90.0, offset),
                      shift = scenes::shift(offset);
  for (const int n : {64, 128, 256, 512}) bench::run({pinch, n}, results);
  for (const scenes::Scene& scene : {pinch, turn, shift})
    bench::run({scene, 128, 1e4F, 1.0F}, results);
  for (const scenes::Scene& scene : {turn, shift})
    for (const float mu : {0.01F, 10.0F, 100.0F})
      bench::run({scene, 128, 10.0F, 10.0F, mu}, results);
  for (const scenes::Scene& scene : {turn, shift})
    bench::run({scene, 256, 10.0F, 10.0F, 0.01F}, results);
}
