// SPDX-License-Identifier: MIT
#include "newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

#include "corners.h"
#include "newton_accuracy.h"
#include "newton_judge.h"
#include "newton_turn.h"
#include "volume_gap.h"

namespace drumhead::multigrid {
namespace {

constexpr double kGrow = 8.0;
constexpr double kExactTheta = 1e6;
// Pressures looked at for the median; the clamp does not need it exactly.
constexpr int kMedianSamples = 1 << 12;
// neohookean: no J of a solution is below this.
constexpr double kLeastFloor = 1e-3;
// A full step is taken without asking the merit when the norm of all equations falls below this
// share.
constexpr double kSolves = 0.75;
// Exact rows, so close to a solution (cells): any decrease suffices. The merit then sees little but
// what linear solutions leave of the rows' gaps (S2 turned by 135°, kappa 1e4: stalled otherwise).
constexpr double kTail = 1e-2;
// The Hessian is too much clamped where a full step leaves kModelError times what the linear solver
// left and, where that was much, more than kSlow of the residual. Less clamping than that takes
// more cycles than it saves steps (S4 kappa 10, 800²: 131 work units with theta growing at every
// full step, 62 so).
constexpr double kModelError = 2.0, kSlow = 0.5;
// Of a schedule that lets theta rise again: where the linear solver leaves more than kUnsolved,
// theta was too large.
constexpr double kUnsolved = 0.3;
constexpr int kMostPatience = 32;
// The norm of all equations that rounded states leave, in units of their precision, a row: S2 kappa
// 10, conforming, 3200² 2.3; steps begin to be shortened at 4.
constexpr double kNoise = 5.0;
// A linear solution counts as accurate.
constexpr double kAccurate = 0.1;

}  // namespace

template <class T>
Newton<T>::Newton(Hierarchy<T>& hierarchy, int top, grid::MemoryMeter& meter)
    : hierarchy_(hierarchy),
      level_(hierarchy[top]),
      meter_(meter),
      stiffness_(total_stiffness(level_)) {}

template <class T>
void Newton<T>::set_force(bool pressure) {
  const kernels::Cuts<T> cuts = level_.cuts.view(T(hierarchy_.traits().jump));
  kernels::Unknowns<T> f = level_.f.view();
  inverted_cells_ = kernels::force<T>(pressure ? level_.membrane() : level_.harmonic(), f);
  kernels::add_curve_force<T>(cuts, level_.q.data(), T(1), f);
  const kernels::Unknowns<const T> u{level_.ux.view(), level_.uy.view(), {}};
  kernels::apply_cuts<T>(cuts, u, level_.q.data(), level_.fq.data());
  for (std::size_t k = 0; k < level_.wanted.size(); ++k) {
    level_.fq[2 * k] = T(-(level_.wanted[k].x + double(level_.fq[2 * k])));
    level_.fq[2 * k + 1] = T(-(level_.wanted[k].y + double(level_.fq[2 * k + 1])));
  }
}

/// J* < 0 at the state whose force was set last.
template <class T>
int Newton<T>::inverted_cells() const {
  if (level_.pressure) return inverted_cells_;
  return int(kernels::energy<T>(level_.harmonic(), {}, T(0)).inverted_cells);
}

template <class T>
double Newton<T>::median_pressure() const {
  const kernels::Plane<const T> p = level_.pressure.view();
  const std::size_t cells = std::size_t(p.columns) * std::size_t(p.rows);
  const int stride = int(cells / kMedianSamples + 1);
  std::vector<T> sample;
  for (int i = stride / 2, j = 0; j < p.rows; i += stride) {
    for (; i >= p.columns && j < p.rows; i -= p.columns) ++j;
    if (j < p.rows) sample.push_back(p.at(i, j));
  }
  const auto middle = sample.begin() + std::ptrdiff_t(sample.size() / 2);
  std::ranges::nth_element(sample, middle);
  return double(*middle);
}

template <class T>
void Newton<T>::set_clamp(double theta) {
  if (level_.pressure) level_.clamp_centre = T(median_pressure());
  level_.clamp_width = theta >= kExactTheta ? T(1e30) : T(theta);
}

template <class T>
double Newton<T>::force_norm(bool pressure) {
  set_force(pressure);
  const auto f = level_.f.view();
  double sum = kernels::dot<T>(f.x, f.x) + kernels::dot<T>(f.y, f.y) + kernels::dot_curve<T>(f, f);
  if (pressure) {
    volume_squares_ = kernels::dot<T>(f.p, f.p);
    sum +=
        (volume_squares_ + kernels::dot_listed<T>(f, f)) / double(level_.spacing * level_.spacing);
  }
  for (const T value : level_.fq) sum += double(value) * double(value);
  return std::sqrt(sum);
}

/// Moves the state along d, and sets the force there: by `lengthened`, if that is longer and brings
/// all equations closer to zero, else by `longest` at most. A full step that brings them closer is
/// taken without asking the merit, which costs two energies, and which counts gaps absolutely:
/// close to a solution the linear solver may leave one that is larger than before, yet negligible.
/// 0 where d is not finite.
template <class T>
double Newton<T>::take_step(double norm_before, double longest, double lengthened) {
  const bool pressure = level_.nonlinear();
  if (lengthened > longest) {
    update(lengthened, pressure);
    if (moves_.finite) norm_ = force_norm(pressure);
    if (moves_.finite && norm_ < norm_before) return lengthened;
    update(-lengthened, pressure);
  }
  // arap: from folds on, equations closer to zero may be further from the minimum.
  const double tried = level_.solid.law.relief == T(0) ? longest : 0.0;
  update(tried, pressure);
  if (tried > 0.0) {
    if (moves_.finite) norm_ = force_norm(pressure);
    const bool exact = hierarchy_.traits().jump == 0.0 && !level_.conforming;
    const bool tail = exact && moves_.largest < kTail;
    if (moves_.finite && norm_ < (tail ? 1.0 : kSolves) * norm_before) return longest;
    update(-longest, pressure);
  }
  if (!moves_.finite) return 0.0;
  const double step = line_search(longest);
  if (step > 0.0) update(step, pressure);
  norm_ = force_norm(pressure);
  return step;
}

/// Leaves volume and curve rows alone in the force that was set last; returns its norm.
template <class T>
double Newton<T>::drop_momentum() {
  const kernels::Unknowns<T> f = level_.f.view();
  const kernels::Unknowns<T> nodes{f.x, f.y, {}, nullptr, 0, f.curve, f.curve_count};
  kernels::combine<T>(T(0), nodes, T(0), nodes);
  double sum = (kernels::dot<T>(f.p, f.p) + kernels::dot_listed<T>(f, f)) /
               double(level_.spacing * level_.spacing);
  for (const T value : level_.fq) sum += double(value) * double(value);
  return std::sqrt(sum);
}

/// A step that mends areas alone is taken if it does.
template <class T>
double Newton<T>::take_area_step(double gap, double enough) {
  update(1.0, true);
  if (moves_.finite) {
    norm_ = force_norm(true);
    if (volume_gap(level_, volume_squares_, stiffness_, enough) < gap) return 1.0;
  }
  update(-1.0, true);
  norm_ = force_norm(true);
  return 0.0;
}

/// Moves the state by a share of d and takes the measure of d and of the state on the way.
template <class T>
void Newton<T>::update(double step, bool pressure) {
  const auto d = level_.d.view();
  const kernels::Moved x = kernels::move<T>(T(step), d.x, level_.ux.view());
  const kernels::Moved y = kernels::move<T>(T(step), d.y, level_.uy.view());
  kernels::Moved p;
  if (pressure) p = kernels::move<T>(T(step), d.p, level_.pressure.view());
  moves_ = {.rms = std::sqrt((x.squares + y.squares) / double(level_.nodes())),
            .longest = std::hypot(x.most, y.most),
            .largest = std::max(x.most, y.most),
            .reach = std::max(x.reach, y.reach),
            .finite = std::isfinite(x.squares + y.squares + p.squares)};
  for (std::size_t k = 0; pressure && k < level_.d.listed.size(); ++k)
    level_.conforming->pressure[k] += T(step) * level_.d.listed[k];
  if (level_.conforming)
    move_held<T>(*level_.conforming, d, T(step), level_.ux.view(), level_.uy.view());
  for (std::size_t k = 0; k < level_.q.size(); ++k) level_.q[k] += T(step) * level_.dq[k];
}

/// A start with folds that the floor of a coarser level would not let go of: as at first.
template <class T>
void Newton<T>::raise_floor() {
  kernels::Law<T>& law = level_.solid.law;
  if (law.model != kernels::Model::neohookean || !(double(law.eps) < kFirstFloor)) return;
  if (kernels::energy<T>(level_.membrane(), {}, T(0)).least_J < double(law.eps))
    law.eps = T(kFirstFloor);
}

/// neohookean: true if the law had to be brought closer to the logarithm than it was for the state,
/// which is no help to a run that stalled (ML, kappa 30: an energy of 3e16 instead of 4e3).
template <class T>
bool Newton<T>::lower_floor() {
  kernels::Law<T>& law = level_.solid.law;
  if (law.model != kernels::Model::neohookean) return false;
  const double least_J = kernels::energy<T>(level_.membrane(), {}, T(0)).least_J;
  if (!(least_J < double(law.eps)) || double(law.eps) <= kLeastFloor) return false;
  law.eps = T(std::max(kLeastFloor,
                       std::clamp(0.5 * least_J, 0.1 * double(law.eps), 0.5 * double(law.eps))));
  norm_ = force_norm(true);
  return true;
}

template <class T>
LinearReport Newton<T>::harmonic(const LinearOptions& options) {
  const double norm = force_norm(false);
  const LinearReport report =
      solve_linear(hierarchy_, hierarchy_.index_of(level_), false, norm, options, meter_);
  update(1.0, false);
  return report;
}

/// Moves below this are rounding: the state's largest displacement (at least a cell) times the
/// precision of T.
template <class T>
double Newton<T>::precision() const {
  return double(std::numeric_limits<T>::epsilon()) * std::max(1.0, moves_.reach);
}

/// Whether rounding of the state accounts for all that its equations lack.
template <class T>
bool Newton<T>::lost_in_rounding() const {
  return level_.pressure && norm_ <= kNoise * precision() * std::sqrt(2.0 * double(level_.nodes()));
}

template <class T>
double Newton<T>::largest_row_gap() {
  set_force(level_.nonlinear());
  double largest = 0.0;
  for (const T gap : level_.fq) {
    const double size = std::abs(double(gap));
    largest = size <= largest ? largest : size;  // keeps a NaN
  }
  return largest;
}

/// Solves the linear system at the state; lowers theta where that stagnates.
template <class T>
LinearReport Newton<T>::solve_step(double norm, const LinearOptions& options,
                                   ClampSchedule& clamp) {
  const bool pressure = level_.nonlinear();
  const int top = hierarchy_.index_of(level_);
  LinearReport linear = solve_linear(hierarchy_, top, pressure, norm, options, meter_);
  if (linear.residual > Judge::kStagnated && clamp.theta > 1.0) {
    // Indefinite far from a solution: a smaller theta is closer to the positive definite Hessian.
    clamp.theta = clamp.most = std::max(1.0, clamp.theta / (kGrow * kGrow));
    set_clamp(clamp.theta);
    set_force(pressure);
    const int wasted = linear.cycles;
    linear = solve_linear(hierarchy_, top, pressure, norm, options, meter_);
    linear.cycles += wasted;
  }
  return linear;
}

/// Of d what take_step does not look at, and the residual.
template <class T>
bool Newton<T>::finite(const LinearReport& linear, bool unmeasured) const {
  const kernels::Unknowns<const T> d = level_.d.view();
  const double lists = kernels::dot_listed<T>(d, d) + kernels::dot_curve<T>(d, d);
  return std::isfinite(lists + (unmeasured ? 0.0 : linear.residual));
}

/// theta of the next step; it does not grow while `corners` act.
template <class T>
void Newton<T>::adapt(ClampSchedule& clamp, const NewtonStep& step, bool shortened, bool corners,
                      double norm_before) const {
  const bool accurate = step.residual <= kAccurate;
  if (clamp.patience > 0) {
    if (step.residual > kUnsolved && clamp.theta > 1.0) {
      clamp.patience = std::min(2 * clamp.patience, kMostPatience);
      clamp.theta = clamp.most = std::max(1.0, clamp.theta / kGrow);
      clamp.full_steps = 0;
    } else if (++clamp.full_steps > clamp.patience) {
      clamp.most = std::min(clamp.most * kGrow, kExactTheta);
      clamp.theta = std::min(clamp.theta * kGrow, clamp.most);
      clamp.full_steps = 0;
    }
    if (shortened) clamp.full_steps = 0;
  }
  if (shortened && clamp.theta > 1.0)
    clamp.theta = clamp.most = std::max(1.0, clamp.theta / kGrow);
  else if (step.step == 1.0 && !corners &&
           norm_ > std::max(accurate ? 0.0 : kSlow, kModelError * step.residual) * norm_before)
    clamp.theta = std::min(clamp.theta * kGrow, kExactTheta);
}

template <class T>
NewtonReport Newton<T>::run(const NewtonOptions& options, ClampSchedule& clamp,
                            const LevelProgress& progress) {
  NewtonReport report;
  Judge judge(options, report);
  LinearOptions linear_options = options.linear;
  LinearAccuracy accuracy(options);
  StepLength length;
  Turn<T> turn(level_, meter_);
  Corners<T> corners(level_, options.onset);
  bool followed = false;
  const auto ended = [&](Status status) {
    report.status = status;
    return report;
  };
  raise_floor();
  norm_ = force_norm(level_.nonlinear());
  corners.moved_to(norm_);
  for (int n = 0; n < options.most_steps; ++n) {
    if (progress && !progress(n + 1, judge.share_done())) return ended(Status::cancelled);
    clamp.theta = std::min(clamp.theta, clamp.most);
    set_clamp(clamp.theta);
    const bool areas = judge.only_areas_lack();
    const double norm = areas ? drop_momentum() : norm_;
    accuracy.set(norm, !areas, linear_options);
    const LinearReport linear = solve_step(norm, linear_options, clamp);
    const auto d = level_.d.view();
    if (!finite(linear, linear_options.unmeasured)) return ended(Status::not_finite);
    NewtonStep step{.theta = clamp.theta, .krylov = linear.cycles, .residual = linear.residual};
    Turned turned;
    if (options.lengthens && !areas) turned = turn.from_last_to(d);
    step.step = areas ? take_area_step(report.volume_gap, options.most_volume_gap)
                      : take_step(norm, length.longest(), length.lengthened(turned));
    if (!moves_.finite) return ended(Status::not_finite);
    const FullMove full{moves_.rms, moves_.longest};
    const bool shortened = step.step < std::min(1.0, length.longest());
    if (linear_options.unmeasured && norm > 0.0) step.residual = norm_ / norm;
    step.inverted_cells = inverted_cells();
    step.dx_rms_px = step.step * full.rms;
    step.dx_max_px = step.step * moves_.longest;
    if (!areas && !options.gives_up && accuracy.raised_by(step, shortened, report)) continue;
    if (!options.lengthens && ((!options.adaptive && length.slow(full.rms)) || judge.uneven()))
      turned = turn.from_last_to(d);
    const double cosine = turned.cosine;
    const double gap = volume_gap(level_, volume_squares_, stiffness_, options.most_volume_gap);
    const bool ends = (shortened && lost_in_rounding() && judge.ends_rounded(step, full)) ||
                      judge.ends_with(step, full, shortened, precision(), gap, cosine);
    const bool there = !corners.act() || (followed && corners.last());
    if (ends && there && (report.status == Status::stalled || !lower_floor()))
      return corners.act() && !corners.unfolded() ? ended(Status::stalled) : report;
    length.note(full.rms, step.step, shortened, n > 0 && !(step.residual <= kAccurate), cosine);
    followed = corners.act() && !shortened && (ends || corners.followed(norm_));
    if (followed) {
      corners.move();
      norm_ = force_norm(true);
      corners.moved_to(norm_);
    }
    adapt(clamp, step, shortened, corners.act(), norm);
  }
  return ended(Status::limit);
}

template class Newton<float>;
template class Newton<double>;

}  // namespace drumhead::multigrid
