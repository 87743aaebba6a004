// SPDX-License-Identifier: MIT
#include "exact_rows.h"

#include <algorithm>

#include "words.h"

namespace drumhead::multigrid {
namespace {

// No node moves further than this in the last step, in finest cells.
constexpr double kExactMove = 1e-7;
constexpr int kExactSteps = 400;
constexpr double kExactReduction = 1e-2;
// Isotropic membranes, steps that come no nearer: the 22 exact runs of stability_membranes_test
// have up to 10 in a row and converge. stvk, which collapses, does not on 312 × 224 cells: curves
// like those of S1, S2 and S4 took 400 steps each, 171, 80 and 66 so.
constexpr int kMostIdle = 40;
// Full steps after which a lowered clamp rises again.
constexpr int kPatience = 4;
// kappa grows to its value from kFirstKappa by kKappaGrows at a time.
constexpr double kKappaGrows = 10.0, kMostLimit = 2e4;
// An exact row that is off by more than this many cells at the end could not be met.
constexpr double kRowMet = 1e-3;
// GCR's directions: as many as take 48 bytes kDirectionNodes times, within bounds. With 100 at 32²,
// where 300 are had now, S2 turned by 135° stalls at kappa infinity.
constexpr std::size_t kDirectionNodes = 2500000;
constexpr int kLeastDirections = 20, kMostDirections = 300, kCycles = 200;
// And where a strip is solved: what 60 cycles do not solve an easier Hessian (a smaller theta)
// does.
constexpr int kStripDirections = 8, kStripCycles = 60;
// The exact Hessian: steps, residual of its systems, and directions.
constexpr int kUnclampedSteps = 12, kUnclampedDirections = 400;
constexpr double kUnclampedReduction = 1e-3;
// Of the progress, what comes before them.
constexpr double kClampedShare = 0.8;
// Steps that a note looks back on.
constexpr std::size_t kLastSteps = 5;

/// `rows`: averaged ones; `most`: GCR's directions. The rest is as `before`.
LinearOptions linear_options(const LinearOptions& before, double reduction, std::size_t nodes,
                             bool rows, int most) {
  const bool strip = rows && nodes >= kStripNodes;
  const int directions =
      strip ? kStripDirections : std::clamp(int(kDirectionNodes / nodes), kLeastDirections, most);
  return {.solver = before.solver,
          .content = reduction,
          .reduction = reduction,
          .most_cycles = strip ? kStripCycles : std::max(kCycles, directions),
          .directions = directions};
}

void append(const NewtonReport& more, NewtonReport& done) {
  done.status = more.status;
  done.steps.insert(done.steps.end(), more.steps.begin(), more.steps.end());
  done.error_rms = more.error_rms;
  done.error_max = more.error_max;
  done.change_rms += more.change_rms;
  done.change_max += more.change_max;
  done.volume_gap = more.volume_gap;
}

/// What is left where a run did not end as it should; `rows`: averaged ones.
std::string statement(const NewtonReport& done, bool rows, double row_gap, double cell_px) {
  if (done.status == Status::infeasible)
    return "exact curve rows contradict one another: one is missed by " +
           figure(row_gap * cell_px) + " px";
  const std::string met = "rows are met to " + figure(row_gap * cell_px) + " px";
  if (done.status == Status::not_finite)
    return std::string("exact curve") + (rows ? " rows" : "s") +
           ": a number that is not finite appeared" + (rows ? "; " + met : "");
  double move = 0.0, residual = 0.0;
  std::size_t last = 0;
  for (auto step = done.steps.rbegin(); step != done.steps.rend() && last < kLastSteps; ++step) {
    if (step->step == 0.0) continue;  // was tried, and not taken
    ++last;
    move = std::max(move, step->dx_max_px);
    residual = std::max(residual, step->residual);
  }
  return "exact curve" + (rows ? ' ' + met + ", but" : "s:") + " nodes moved by up to " +
         figure(move * cell_px) + " px in the last " + std::to_string(last) +
         " steps taken, of whose linear systems " + figure(residual) + " was left at worst";
}

}  // namespace

template <class T>
std::vector<NewtonStep> stiffen(const NestedOptions& options, NewtonOptions newton_options,
                                Newton<T>& newton, ClampSchedule& clamp,
                                const LevelProgress& progress) {
  std::vector<NewtonStep> taken;
  clamp.patience = kPatience;
  newton_options.linear.content = newton_options.linear.reduction = kExactReduction;
  newton_options.adaptive = true;
  const double last = std::min(options.largest_kappa, kMostLimit);
  for (double kappa = kFirstKappa; kappa < last; kappa *= kKappaGrows) {
    options.limit_kappa(kappa);
    const NewtonReport part = newton.run(newton_options, clamp, progress);
    taken.insert(taken.end(), part.steps.begin(), part.steps.end());
    clamp.theta = 1.0;
  }
  options.limit_kappa(options.largest_kappa);
  return taken;
}

template <class T>
NewtonReport until_at_rest(Hierarchy<T>& hierarchy, const LinearOptions& linear, Newton<T>& newton,
                           const NewtonReport& before, const LevelProgress& progress,
                           double cell_px, std::vector<std::string>& notes) {
  const std::size_t nodes = hierarchy[0].nodes();
  const bool rows = !hierarchy.conforming();
  if (rows) hierarchy.drop_jump(jump_kept(nodes, hierarchy.traits().jump_inside));
  NewtonOptions options;
  options.most_steps = kExactSteps;
  if (kernels::isotropic(hierarchy.traits().model)) options.most_idle = kMostIdle;
  options.tolerance_rms = options.tolerance_max = kExactMove;
  options.linear = linear_options(linear, kExactReduction, nodes, rows, kMostDirections);
  options.adaptive = true;
  NewtonReport done = before;
  ClampSchedule clamp{.patience = kPatience};
  append(newton.run(options, clamp, part_of(progress, 0.0, kClampedShare)), done);
  const bool ended = done.status == Status::stalled || done.status == Status::limit;
  if (ended && newton.largest_row_gap() < kRowMet) {
    // Clamped pressures make another Hessian, which may go back and forth around a solution; the
    // exact one converges there, but is indefinite and needs many directions.
    options.most_steps = kUnclampedSteps;
    options.linear = linear_options(linear, kUnclampedReduction, nodes, rows, kUnclampedDirections);
    options.adaptive = false;
    ClampSchedule open{.theta = ClampSchedule{}.most};
    append(newton.run(options, open, part_of(progress, kClampedShare, 1.0)), done);
  }
  if (done.status == Status::cancelled) return done;
  const double row_gap = newton.largest_row_gap();
  if (!(row_gap < kRowMet) && done.status != Status::not_finite) done.status = Status::infeasible;
  if (done.status != Status::converged) notes.push_back(statement(done, rows, row_gap, cell_px));
  return done;
}

#define DRUMHEAD_INSTANTIATE(T)                                                             \
  template std::vector<NewtonStep> stiffen(const NestedOptions&, NewtonOptions, Newton<T>&, \
                                           ClampSchedule&, const LevelProgress&);           \
  template NewtonReport until_at_rest(Hierarchy<T>&, const LinearOptions&, Newton<T>&,      \
                                      const NewtonReport&, const LevelProgress&, double,    \
                                      std::vector<std::string>&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::multigrid
