// SPDX-License-Identifier: MIT
#pragma once
// How accurately the linear systems of a run are solved: as asked for, more accurately where steps
// had to be shortened, and with exact rows as far as Newton's method converges by itself.
#include <algorithm>
#include <limits>

#include "newton.h"

namespace drumhead::multigrid {

class LinearAccuracy {
 public:
  LinearAccuracy(const NewtonOptions& options)
      : asked_(options.linear),
        adaptive_(options.adaptive),
        forgets_(options.share_of_change > 0.0 ? kForgets : kNever),
        full_steps_(forgets_),
        least_(adaptive_ ? kLeastExact : kLeast),
        much_shortened_(adaptive_ ? kMuchShortenedExact : kMuchShortened),
        most_(adaptive_ ? asked_.reduction : kCareful),
        wanted_(most_) {}

  /// Sets the residual wanted of the system at a state whose force has this norm; `all`: of all
  /// equations.
  void set(double norm, bool all, LinearOptions& options) {
    const bool first = !(before_ > 0.0);
    const double rate = first ? 1.0 : norm / before_;
    before_ = norm;
    if (adaptive_) {
      options.reduction = options.content =
          std::clamp(kOfRate * rate * rate, std::min(kQuadratic, wanted_), wanted_);
    } else if (full_steps_ < forgets_ || wanted_ < most_) {
      options.content = std::min(asked_.content, wanted_);
      options.reduction = std::min(asked_.reduction, wanted_);
    } else {
      options.content = asked_.content;
      options.reduction = asked_.reduction;
    }
    const bool careful = options.content < asked_.content;
    options.unmeasured = asked_.unmeasured && all && !careful && (first || rate <= kTrusted);
    const bool light = asked_.lightens && options.unmeasured && steps_ >= kFCycles;
    options.kind = light ? CycleKind::v : asked_.kind;
    ++steps_;
  }
  /// True if a step of length 0 deserves another trial with a more accurate solution; it is then
  /// filed in the report. `shortened`: see Judge.
  bool raised_by(const NewtonStep& step, bool shortened, NewtonReport& report) {
    if (shortened)
      full_steps_ = 0;
    else if (full_steps_ < forgets_)
      ++full_steps_;
    if (step.step == 1.0) wanted_ = std::min(kRelaxes * wanted_, most_);
    if (step.step >= much_shortened_ || wanted_ <= least_) return false;
    wanted_ = std::max(0.1 * wanted_, least_);
    before_ = 0.0;
    if (step.step > 0.0 || step.theta > 1.0) return false;
    report.steps.push_back(step);
    return true;
  }

 private:
  // After a shortened step linear systems are solved to this residual at least, by cycles or by
  // GCR. (Also where the norm of all equations did not show a step to be good: S1 kappa 10, 400²,
  // 912 work units, 379 without.)
  static constexpr double kCareful = 0.1;
  // Until so many full steps in a row, on levels that begin from a coarser one and end at a share
  // of their change; elsewhere S5 finds another minimum and stvk's last digits stall. Cycles of the
  // finest level, all levels together, with 1, 2, 3 and for ever: S4 kappa 1e4, 800², conforming
  // 60, 51, 62, 88; S1 kappa 10, 400² 23, 29, 32, 27.
  static constexpr int kForgets = 2, kNever = std::numeric_limits<int>::max();
  // And after one shortened much, further: the merit weighs what the solution leaves of volume rows
  // with their pressures, which are a thousand mu where a stiff membrane's closed curve changes its
  // area. Of 52 random scenes with targets that fit together, kappa/mu 1e4 or infinity, 24 to 256
  // cells, conforming, 21 stalled without; with it 4 take more steps than there are. To 1e-3 and
  // 1e-5 one scene more and the same end so, in .84 and 1.13 of the time.
  static constexpr double kLeast = 1e-4, kLeastExact = 2e-6;
  static constexpr double kOfRate = 0.3, kQuadratic = 1e-4;
  // After a step that left at most this share of all equations' norm one cycle is not looked at, if
  // it may go so: the norm after the next step tells as much. Of the time .93 to .97 at 200² to
  // 800², with the same steps.
  static constexpr double kTrusted = 0.5;
  // Steps with F-cycles before V-cycles do, where options say so. Gentle averaged rows, 100² to
  // 800², take .90 (S1 kappa 1) to 1.0 (S2 kappa 10) of the time, with a step more at some offsets;
  // with V-cycles from the second step on .82 to 2.0, from the first on to 2.9. Conforming cells,
  // and averaged rows from kappa/mu 30 on, lose where S4's disc moves: up to 14 steps instead of 5.
  static constexpr int kFCycles = 2;
  static constexpr double kRelaxes = 3.0, kMuchShortened = 0.02, kMuchShortenedExact = 0.1;
  const LinearOptions asked_;
  bool adaptive_;
  int forgets_, full_steps_;  ///< since a step was shortened
  int steps_ = 0;
  double least_, much_shortened_, most_, wanted_, before_ = 0.0;
};

}  // namespace drumhead::multigrid
