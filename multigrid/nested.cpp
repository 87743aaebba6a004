// SPDX-License-Identifier: MIT
#include "nested.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "exact_rows.h"
#include "level_change.h"
#include "volume_gap.h"
#include "words.h"

namespace drumhead::multigrid {
namespace {

// Least cells of the lattice to start on. From 16² a wrong minimum was found; a feature of fewer
// than four cells is not seen as one.
constexpr int kStartCells = 32;
// But this few are tried, and the next lattice taken where a step had to be shortened (S5,
// conforming, kappa/mu 100, otherwise does not end on 96² at most offsets): .79 to 1.0 of the time
// on 96² to 112². Not for exact rows, nor for masks of kappa (S3, 800²: 60 cycles instead of 15).
constexpr int kTrialCells = 24;
constexpr double kCellsPerFeature = 4.0;
// A start finer than this would cost more than it is worth.
constexpr int kMostStartCells = 128;
constexpr int kStartSteps = 60;
// Error left on the start level, in its cells; of averaged rows, with .01 instead: S4 kappa 10,
// 100² takes a fifth more work. Exact rows then end in other minima.
constexpr double kStartError = 0.01, kAveragedStart = 0.03;
// arap with a large kappa: the way out of folds is long, and its steps are cheap.
constexpr int kFoldSteps = 200;
// stvk, which collapses: S1 and S4 take up to 100 steps to the default error, 300 to .01 cells.
constexpr int kCollapseSteps = 300;
// Error there, in cells, where no tolerance was asked for: minima are many and flat.
constexpr double kFoldTolerance = 0.03;
// Onset of the corners' resistance at the end, in J, likewise, and on levels that only start the
// next one; 0 where a tolerance was asked for.
constexpr double kOnset = 0.02, kCoarseOnset = 0.1;
constexpr int kLevelSteps = 20, kFinestSteps = 40;
constexpr int kPathSteps = 12;
constexpr int kStepsPerPathStep = 4;
// Shares of a level's progress: the way to its first state, and exact rows with their jump.
constexpr double kPathShare = 0.5, kJumpShare = 0.7;
// Error left on levels that only start the next one, and on the finest: share of the estimated
// discretisation error.
constexpr double kShare = 0.1;
// Residual that ends the cycles of one Newton step. One cycle a step and more steps reach the same
// error for less than accurate linear solutions: S1 kappa 1, 800²: 121 work units with .1, 77 with
// .6; S2 kappa 10: 157 and 103.
constexpr double kContent = 0.6, kStartContent = 0.3, kHarmonic = 0.05;
// And where cycles alone do not reach that, GCR's. S4, kappa 100, 100²: seven cycles for a step
// with .1, two with .3. So few cycles need few directions: 20 are no better, with 4 S5 does not end
// (kappa 1e4, 128²).
constexpr double kReduction = 0.3, kAccurate = 0.1;
constexpr int kDirections = 6;
// But where a mask of mu makes cells as soft as kappa/mu kSoft, the 20 that there are otherwise: mu
// .01 in a disc, kappa 10, 256²: S2 and S4 stall with 6, S2 at 160² with 12, too.
constexpr double kSoft = 300.0;
// So many cycles in a row that gain nothing end GCR: .78 to 1.0 of the time on 100² to 400². With 4
// S5, kappa/mu 1e4, 400² ends in another minimum. Exact rows need all: S2 by 135°, kappa infinity.
constexpr int kMostIdle = 6;
// From this kappa/mu on contraction is at first better than it stays: S4, kappa 100, 100² ended
// with .26 of the discretisation error, thought to be .08.
constexpr double kStiff = 30.0, kStiffRate = 0.55, kStiffUnknownRate = 0.5;
// Averaged rows below it: S4, kappa 10, 100² ended with .13, thought to be .07.
constexpr double kAveragedRate = 0.35;
// Conforming cells below kStiff: what a cycle leaves is volume rows that no longer move nodes, so
// one cycle a step does, and coarser levels, which only start the next one, stop at more than the
// finest. Milliseconds of S2 kappa 10 at 100², 200², 400², with kContent and kShare everywhere: 35,
// 78, 194, and .04, .06, .06 of the discretisation error left; with these 21, 45, 114 and .12, .15,
// .15. Where cycles come to contract by less, as on fine lattices of stiff scenes, GCR to
// kLooseReduction: kappa 1e4, 800² S2 1143 ms with .8 and .3, 833 so, S4 500 and 400; with .95 for
// both 612 and 336, but S4 is thought to lack .29 of the discretisation error then.
constexpr double kGentleContent = 0.9, kLooseReduction = 0.6, kCoarseShare = 0.3,
                 kGentleStart = 0.02;
// Stiffer ones: likewise after a level of full steps alone, where there is no mask of kappa; S2 and
// S4 at kappa 100 otherwise take 35 and 26 ms instead of 26 and 20 at 100², 219 and 160 instead of
// 140 and 90 at 400². Else, and on the start level, kStartContent, and where cycles do not reach
// that a little of GCR: loosely solved S5, kappa 100, 100² does not end at three of six offsets,
// and S3, 400², takes 48 cycles instead of 29.
constexpr double kStiffReduction = 0.5;
constexpr std::size_t kSmallNodes = 20000;
// Up to these kappa/mu, on the start level and on the others, V-cycles take the place of F-cycles
// on lattices of few nodes, where a visit to a coarse level costs more than its nodes. S1 kappa 1,
// 100²: 149 work units with F-cycles, 105 so; S2 kappa 10, 100²: 256 and 227; S4 kappa 10, 100²,
// with V-cycles on both levels 250, 140 so; S1 kappa 1, 800², 107 instead of 93.
constexpr double kVCyclesFirst = 10.0, kVCycles = 1.0;

template <class T>
int cells(const Level<T>& level) {
  return std::max(level.nx, level.ny);
}

bool shortens(const std::vector<NewtonStep>& steps) {
  return std::ranges::any_of(steps, [](const NewtonStep& s) { return s.step < 1.0; });
}

template <class T>
int start_level(const Hierarchy<T>& hierarchy, const NestedOptions& options) {
  const bool tries = !options.exact && !hierarchy[0].compliance;
  const int least = tries ? kTrialCells : kStartCells;
  int start = 0;
  while (start + 1 < hierarchy.size() && cells(hierarchy[start + 1]) >= least) {
    const double feature = options.smallest_feature / double(hierarchy[start + 1].spacing);
    if (feature < kCellsPerFeature && cells(hierarchy[start]) <= kMostStartCells) break;
    ++start;
  }
  return start;
}

/// Conforming cells that little resists, where Newton's method needs no more than cycles.
template <class T>
bool gentle(const Hierarchy<T>& hierarchy) {
  const SceneTraits& traits = hierarchy.traits();
  return hierarchy.conforming() && !kernels::isotropic(traits.model) && traits.stiffness < kStiff;
}

/// Averaged rows with their jump.
template <class T>
bool averaged(const Hierarchy<T>& hierarchy, const NestedOptions& options) {
  return !hierarchy.conforming() && !options.exact && !kernels::isotropic(hierarchy.traits().model);
}

/// Without contrast moves of successive steps point the same way.
template <class T>
bool aligned(const Hierarchy<T>& hierarchy, const NestedOptions& options) {
  return !options.exact && !kernels::isotropic(hierarchy.traits().model) &&
         !hierarchy[0].compliance;
}

/// Of averaged rows so what is left after a cycle is one smooth field, much the same on every
/// level.
template <class T>
bool smooth(const Hierarchy<T>& hierarchy, const NestedOptions& options) {
  return averaged(hierarchy, options) && aligned(hierarchy, options);
}

/// Conforming cells: whether one cycle a step does on a level after the start. `shortened`: steps
/// on the level before.
template <class T>
bool loose(const Hierarchy<T>& hierarchy, const NestedOptions& options, bool shortened) {
  return gentle(hierarchy) || (hierarchy.conforming() && aligned(hierarchy, options) && !shortened);
}

template <class T>
LinearOptions linear_options(const Hierarchy<T>& hierarchy, int l, bool start, bool shortened,
                             const NestedOptions& options) {
  const Level<T>& level = hierarchy[l];
  LinearOptions linear;
  linear.content = start ? kStartContent : kContent;
  if (gentle(hierarchy)) {
    linear.content = kContent;
    linear.reduction = kReduction;
  } else if (level.conforming && !kernels::isotropic(level.solid.law.model)) {
    linear.content = kStartContent;
    if (!start) linear.reduction = kStiffReduction;
  }
  if (!start && loose(hierarchy, options, shortened)) {
    linear.content = kGentleContent;
    linear.reduction = kLooseReduction;
  }
  if (!options.exact && !kernels::isotropic(level.solid.law.model)) linear.most_idle = kMostIdle;
  const double most_for_v = start ? kVCyclesFirst : kVCycles;
  if (averaged(hierarchy, options) && hierarchy.traits().stiffness <= most_for_v &&
      level.nodes() < kSmallNodes)
    linear.kind = CycleKind::v;
  const bool unseen = !start && !options.exact && options.solver == Solver::gcr;
  linear.lightens = unseen && smooth(hierarchy, options) && hierarchy.traits().stiffness < kStiff;
  linear.unmeasured = linear.lightens || (unseen && loose(hierarchy, options, shortened));
  linear.band = level.conforming || (!start && averaged(hierarchy, options));
  if (!start && !level.conforming && !kernels::isotropic(level.solid.law.model)) {
    linear.reduction = kReduction;
    const bool soft = level.mu && hierarchy.traits().stiffness >= kSoft;
    if (level.nodes() >= kSmallNodes && !soft) linear.directions = kDirections;
  }
  // Small lattices can afford directions, and the states on the way to the first solution need
  // them.
  if (start) {
    linear.directions = level.nodes() < kSmallNodes ? 40 : 10;
    linear.most_cycles = 80;
  }
  return linear;
}

}  // namespace

LevelReport in_pixels(int nx, int ny, std::vector<NewtonStep> steps, double cell_px) {
  for (NewtonStep& step : steps) {
    step.dx_rms_px *= cell_px;
    step.dx_max_px *= cell_px;
  }
  return {nx, ny, std::move(steps)};
}

namespace {

/// Contractions that no step of a finer level is expected to beat.
template <class T>
void set_least_rates(const Hierarchy<T>& hierarchy, const NestedOptions& options,
                     NewtonOptions& newton) {
  const bool stiff = hierarchy.traits().stiffness >= kStiff;
  newton.least_rate = stiff && smooth(hierarchy, options) ? kStiffRate : 0.0;
  newton.least_unknown_rate = stiff ? std::max(kStiffUnknownRate, newton.least_rate)
                              : averaged(hierarchy, options) ? kAveragedRate
                                                             : 0.0;
}

/// The first state on the start level: harmonic, for large rotations on along the load path, for
/// exact rows with kappa from kFirstKappa on; returns the steps.
template <class T>
std::vector<NewtonStep> find_start(Hierarchy<T>& hierarchy, int start, const NestedOptions& options,
                                   const NewtonOptions& newton_options, Newton<T>& newton,
                                   ClampSchedule& clamp, const LevelProgress& progress) {
  LinearOptions harmonic = newton_options.linear;
  harmonic.content = harmonic.reduction = kHarmonic;
  std::vector<NewtonStep> taken;
  if (options.limit_kappa) options.limit_kappa(kFirstKappa);
  if (!options.set_targets) newton.harmonic(harmonic);
  for (int n = 1; options.set_targets && n < kPathSteps; ++n) {
    options.set_targets(start, double(n) / kPathSteps);
    if (n == 1) newton.harmonic(harmonic);
    NewtonOptions part = newton_options;
    part.most_steps = kStepsPerPathStep;
    part.gives_up = false;
    part.tolerance_rms = 0.05 * double(hierarchy[start].spacing);
    clamp = {};
    const LevelProgress share =
        part_of(progress, kPathShare * (n - 1) / kPathSteps, kPathShare * n / kPathSteps);
    const NewtonReport done = newton.run(part, clamp, share);
    taken.insert(taken.end(), done.steps.begin(), done.steps.end());
  }
  if (options.set_targets) {
    options.set_targets(start, 1.0);
    clamp = {};
  }
  if (options.limit_kappa)
    std::ranges::copy(
        stiffen(options, newton_options, newton, clamp, part_of(progress, kPathShare, kPathShare)),
        std::back_inserter(taken));
  return taken;
}

bool ended_early(Status status) {
  return status == Status::not_finite || status == Status::cancelled;
}

/// Takes level l's state, the last that there is, to the finest lattice. What it was found to lack
/// on its own says nothing there.
template <class T>
void end_early(Hierarchy<T>& hierarchy, int l, SolveReport& report) {
  if (l > 0 || report.status == Status::cancelled) forget_errors(report);
  while (--l >= 0) hierarchy.prolong_state(l);
}

/// What the steps of the next level are expected to do, from those observed on this one. `smooth`:
/// beyond the last of them as on the levels before, and where their linear systems are solved as
/// well.
void expect(const std::vector<Contraction>& observed, bool smooth,
            std::vector<Contraction>& expected) {
  const std::size_t count = observed.empty() ? 0 : observed.size() - 1;
  expected.resize(smooth ? std::max(expected.size(), count) : count);
  std::copy_n(observed.begin(), count, expected.begin());
  if (smooth) return;
  for (Contraction& contraction : expected) contraction.residual = 0.0;
}

/// What every level is asked for. `shortened`: steps on the level before; `error_of_moves`: see
/// ErrorEstimate.
template <class T>
void set_options(const Hierarchy<T>& hierarchy, int l, bool start, bool shortened,
                 double error_of_moves, const NestedOptions& options, NewtonOptions& newton) {
  const Level<T>& level = hierarchy[l];
  const bool finest = l == 0;
  newton.linear = linear_options(hierarchy, l, start, shortened, options);
  newton.linear.solver = options.solver;
  newton.most_steps = start ? kStartSteps : finest ? kFinestSteps : kLevelSteps;
  newton.gives_up = start && !finest && cells(level) < kStartCells;
  // Gentle levels end sooner by the contraction of plain steps (S1 kappa 1, 800² 3.5 steps so
  // instead of 2.8, means of six offsets).
  newton.lengthens = !start && aligned(hierarchy, options) && !gentle(hierarchy);
  // What steps on the coarser levels contract by the finest may then count on.
  newton.least_steps = finest ? 1 : !start && l == 1 && smooth(hierarchy, options) ? 3 : 2;
  const bool coarsely = !finest && loose(hierarchy, options, shortened);
  const double share = coarsely ? kCoarseShare : kShare;
  newton.share_in_noise = start ? 0.0 : share * options.discretisation_share;
  const bool told = !start && finest && !shortened;
  newton.share_of_change = told ? share * error_of_moves : newton.share_in_noise;
  const double start_error = gentle(hierarchy)              ? kGentleStart
                             : averaged(hierarchy, options) ? kAveragedStart
                                                            : kStartError;
  newton.tolerance_rms = start ? start_error * double(level.spacing) : 0.0;
  newton.tolerance_max = 0.0;
  newton.most_volume_gap = finest ? kMostVolumeGap : 0.0;
  newton.contrast = bool(level.compliance);
}

/// What the run itself is asked for besides, once it has a state to begin with.
template <class T>
void set_accuracy(const Level<T>& level, bool finest, bool start, const NestedOptions& options,
                  NewtonOptions& newton) {
  if (finest && options.tolerance_cells > 0.0 && !options.exact) {
    newton.most_steps = kStartSteps;
    newton.share_of_change = newton.share_in_noise = 0.0;
    newton.tolerance_rms = options.tolerance_cells;
    // The moves of loosely solved steps say too little of pressures that are slow to settle.
    newton.linear.content = newton.linear.reduction = kAccurate;
    newton.linear.unmeasured = false;
    newton.expected.clear();
    newton.lengthens = false;
  }
  if (level.solid.law.model == kernels::Model::stvk) newton.most_steps = kCollapseSteps;
  if (level.solid.law.relief > T(0)) {
    newton.most_steps = kFoldSteps;
    newton.linear.content = newton.linear.reduction = kAccurate;
    if (start && (!finest || options.tolerance_cells == 0.0))
      newton.tolerance_rms = kFoldTolerance * double(level.spacing);
    newton.onset = !finest ? kCoarseOnset : options.tolerance_cells > 0.0 ? 0.0 : kOnset;
  }
}

void note_rounding(SolveReport& report) {
  report.notes.push_back("single precision: nodes settle to " + figure(report.algebraic_rms_px) +
                         " px RMS, more than a tenth of the discretisation error; a tolerance "
                         "below that is solved in double precision");
}

}  // namespace

void forget_errors(SolveReport& report) {
  report.algebraic_rms_px = report.algebraic_max_px = report.discretisation_rms_px =
      report.discretisation_max_px = report.volume_gap = std::numeric_limits<double>::quiet_NaN();
}

template <class T>
void nested_iteration(Hierarchy<T>& hierarchy, const NestedOptions& options, double cell_px,
                      grid::MemoryMeter& meter, SolveReport& report) {
  const int first = start_level(hierarchy, options);
  int start = first;
  ClampSchedule clamp;
  NewtonOptions newton_options;
  ErrorEstimate estimate(options.discretisation_share, hierarchy.conforming(), options.tips);
  bool rounded = false, shortened = false;
  for (int l = start; l >= 0; --l) {
    Level<T>& level = hierarchy[l];
    const LevelProgress progress = level_progress(options.progress, level.nx, level.ny, l, first);
    Newton<T> newton(hierarchy, l, meter);
    std::optional<LevelCopy<T>> coarse;
    std::vector<NewtonStep> path;  // to the state that the level's own run begins with
    set_options(hierarchy, l, l == start, shortened, estimate.of_next_moves(), options,
                newton_options);
    if (l == start) {
      path = find_start(hierarchy, start, options, newton_options, newton, clamp, progress);
    } else {
      // What a finer level changes is small: the positive definite Hessian does, until it does not.
      clamp.theta = 1.0;
      if (level.conforming) coarse.emplace(hierarchy[l + 1], meter);
      hierarchy.prolong_state(l);
    }
    set_accuracy(level, l == 0, l == start, options, newton_options);
    const bool way = l == start && (options.set_targets || options.limit_kappa);
    const bool exact = l == 0 && options.exact;
    NewtonReport done = newton.run(
        newton_options, clamp, part_of(progress, way ? kPathShare : 0.0, exact ? kJumpShare : 1.0));
    set_least_rates(hierarchy, options, newton_options);
    shortened = shortens(done.steps);
    if (l != start) expect(done.contractions, smooth(hierarchy, options), newton_options.expected);
    if (exact && !ended_early(done.status))
      done = until_at_rest(hierarchy, newton_options.linear, newton, done,
                           part_of(progress, kJumpShare, 1.0), cell_px, report.notes);
    report.status = done.status;
    report.algebraic_rms_px = done.error_rms * cell_px;
    report.algebraic_max_px = done.error_max * cell_px;
    report.volume_gap = done.volume_gap;
    rounded = done.rounded;
    std::optional<LevelChange> change;
    if (coarse) change = coarse->change(hierarchy[l + 1], level);
    const LevelChange error = estimate.of({done.change_rms, done.change_max}, l == start, change);
    report.discretisation_rms_px = error.rms * cell_px;
    report.discretisation_max_px = error.max * cell_px;
    path.insert(path.end(), done.steps.begin(), done.steps.end());
    report.levels.push_back(in_pixels(level.nx, level.ny, std::move(path), cell_px));
    if (newton_options.gives_up && (shortened || report.status == Status::not_finite)) {
      --start;
      clamp = {};
    } else if (ended_early(report.status)) {
      return end_early(hierarchy, l, report);
    }
  }
  note_areas(report);
  if (rounded) note_rounding(report);
}

template void nested_iteration(Hierarchy<float>&, const NestedOptions&, double, grid::MemoryMeter&,
                               SolveReport&);
template void nested_iteration(Hierarchy<double>&, const NestedOptions&, double, grid::MemoryMeter&,
                               SolveReport&);

}  // namespace drumhead::multigrid
