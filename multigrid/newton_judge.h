// SPDX-License-Identifier: MIT
#pragma once
// When a run of Newton's method ends: its own header because the rules are many, and each was
// learnt from a scene.
#include <algorithm>
#include <cmath>
#include <limits>

#include "newton.h"
#include "newton_turn.h"

namespace drumhead::multigrid {

/// What a step at full length moves the nodes by, in finest cells.
struct FullMove {
  double rms = 0.0, max = 0.0;
};

/// Files the steps of a run and decides when it ends.
class Judge {
 public:
  /// A linear solution this bad is not worth a step with an unclamped Hessian.
  static constexpr double kStagnated = 0.9;

  Judge(const NewtonOptions& options, NewtonReport& report) : options_(options), report_(report) {}

  /// True if the run ends with this step; the report then has its status. `shortened`: the merit
  /// did not let it have the length that was tried. `rounding`: moves below it are noise;
  /// `volume_gap`: see NewtonReport; `cosine`: between the moves of this step and the one before,
  /// where uneven(), else not a number.
  bool ends_with(const NewtonStep& step, const FullMove& move, bool shortened, double rounding,
                 double volume_gap, double cosine) {
    const double gap_before = report_.volume_gap;
    report_.volume_gap = volume_gap;
    if (only_areas_lack_) {
      report_.steps.push_back(step);
      advance(rounding);
      // Solved, and no better: curves and areas contradict one another, or theta is too large.
      const bool tried = step.step > 0.0 || step.theta <= 1.0 || move.rms <= rounding;
      const bool in_vain = tried && step.residual <= kUnsolved && volume_gap > kInVain * gap_before;
      only_areas_lack_ = step.step > 0.0 && !areas_done();
      areas_fail_ = step.step == 0.0;
      return (areas_done() || in_vain) && end(Status::converged);
    }
    const bool first = report_.steps.empty();
    const NewtonStep before = first ? step : report_.steps.back();
    report_.steps.push_back(step);
    report_.change_rms += step.dx_rms_px;
    report_.change_max += step.dx_max_px;

    // Half a step back and forth is as good as a full one.
    const bool full = ordinary(step) || (uneven_ && !shortened);
    creeping_ = step.step < kCreep ? creeping_ + 1 : 0;
    const bool gcr = options_.linear.solver == Solver::gcr;
    const bool solved = step.residual <= (gcr ? kStagnated : kUnsolved);
    unsolved_ = solved ? 0 : unsolved_ + 1;
    tiny_ = shortened && solved && kTiny * move.rms <= wanted(rounding) ? tiny_ + 1 : 0;
    if (tiny_ >= kMostTiny && areas_done()) {
      set_error(kTiny, move);
      return end(Status::converged);
    }
    if ((step.step == 0.0 && step.theta <= 1.0) || (options_.gives_up && shortened) ||
        creeping_ >= kMostCreeping || unsolved_ >= kMostUnsolved || idles(step.dx_rms_px))
      return end(Status::stalled);
    // No contraction is seen after a larger theta, which slows a step, or where nothing moved.
    const bool comparable = step.theta >= before.theta, moved = before.dx_rms_px > 0.0;
    const bool seen = !first && comparable && moved && ordinary(step) && ordinary(before);
    const bool rounded = seen && no_nearer(step, before, rounding);
    const double ratio = seen ? step.dx_rms_px / before.dx_rms_px : kUnknownRate;
    const double left = moves_left(ratio, step.residual);
    set_error(rounded ? 1.0 : left, {step.dx_rms_px, step.dx_max_px});
    if (uneven_ && step.step > 0.0 && before.step > 0.0 && cosine < kAstray) {
      report_.error_rms = kWandering * mean_move(step.dx_rms_px, step, before.dx_rms_px, before);
      report_.error_max = kWandering * mean_move(step.dx_max_px, step, before.dx_max_px, before);
    }
    uneven_ = uneven_ || (options_.contrast && automatic() && seen &&
                          step.dx_rms_px > kUneven * before.dx_rms_px);
    advance(rounding);
    // Soon after a step was shortened or theta lowered, one small step may be chance.
    calm_ = full && comparable ? calm_ + 1 : 0;
    report_.rounded = rounded && !small(step, rounding);
    const bool near = rounded || (solved && small(step, rounding));
    settled_ = full && comparable && near ? settled_ + 1 : 0;
    const bool enough = int(report_.steps.size()) >= options_.least_steps;
    const bool settled = enough && settled_ >= (calm_ < kCalm ? 2 : 1);
    if (settled && areas_done()) return end(Status::converged);
    only_areas_lack_ = settled;
    const bool may_mend = only_areas_lack_ && !areas_fail_;
    return full && !may_mend && step.dx_rms_px <= rounding && end(Status::stalled);
  }

  /// Where no tolerance was asked for: true if the run ends with a shortened step, beside which
  /// all equations are as close to zero as rounded states bring them, and the merit sees but noise.
  bool ends_rounded(const NewtonStep& step, const FullMove& move) {
    if (!automatic() || !areas_done() || step.residual > kStagnated) return false;
    report_.steps.push_back(step);
    set_error(1.0, move);
    report_.rounded = report_.error_rms > wanted(0.0);
    return end(Status::converged);
  }

  /// Nodes have moved enough, but volume rows leave too much: the next step is for them (and curve
  /// rows) alone, without the momentum that drives the slow rest. Ends with the run or a step of 0.
  bool only_areas_lack() const { return only_areas_lack_; }

  /// A step moved nodes nearly as far as the one before: the ratio of two moves may say little of
  /// what is left, their directions are asked for, too.
  bool uneven() const { return uneven_; }

  /// The share of the run that is done, as the logarithm of the error that is left tells it: 0 for
  /// the first step's move, 1 for the error wanted. Never falls, and stays below 1.
  double share_done() const { return share_; }

 private:
  // So many steps in a row from linear solutions that bad lead nowhere. Solvers other than gcr,
  // whose cycles stop where Newton's method gains no more from them, were asked for a tenth.
  static constexpr int kMostUnsolved = 3;
  static constexpr double kUnsolved = 0.5;
  // Bounds of the contraction that a step is expected to have, and what is taken where none was
  // seen.
  static constexpr double kLeastRate = 0.03, kMostRate = 0.9, kUnknownRate = 0.5;
  // A step that contracts by so much more than on the level before follows another course there,
  // where residuals are compared, too.
  static constexpr double kUnlike = 0.6;
  // So many steps in a row shorter than kCreep lead nowhere.
  static constexpr double kCreep = 1e-2;
  static constexpr int kMostCreeping = 5;
  // Share of the volume gap that a step for areas leaves if it is of no use.
  static constexpr double kInVain = 0.9;
  // At tips beside contrast moves alternate in size and turn back in part: a ratio of two moves is
  // chance there, and the worse of two claims up to nine times the last move. What steps that point
  // elsewhere than the one before leave, in last moves: S3, from the fifth on, 100² .6 to 2.3, 200²
  // 3 to 6, 400² 1.6 to 3.3, 800² 1.4 to 3. S3 800² takes 17 steps by ratios alone, 11 so.
  static constexpr double kUneven = 2.0 / 3.0, kAstray = 0.5, kWandering = 2.5;
  // What each step takes at least of the share that is not done, and where the error's part ends:
  // areas, corners or a second small step may be wanting.
  static constexpr double kLeastShare = 0.06, kMostShare = 0.8;
  // Moves that never end, in units of `rounding`, and their ratios: S2 kappa 10, 800² 7 to 10, .8
  // to 1.3; 1600² 6 to 9; S4 1600² 6 to 15. S4 3200² 17 to 41, long waves whose longest move is 4
  // to 7 times their RMS; where nodes by the curves still settle it is 10 to 60.
  static constexpr double kRounded = 20.0, kNoNearer = 0.9;
  // And the error that they leave, to which share_in_noise holds: S2 kappa 10, conforming, 800² 3.3
  // steps so, six without.
  static constexpr double kSettled = 15.0;
  static constexpr double kRoundedWaves = 60.0, kWaves = 8.0;
  // So many shortened steps in a row whose full moves would be this often in the error wanted: the
  // merit, which weighs what linear solutions leave of volume rows with pressures of a thousand mu,
  // cannot tell better from worse there.
  static constexpr int kMostTiny = 3;
  static constexpr double kTiny = 5.0;
  // So many full steps make up for a shortened one.
  static constexpr int kCalm = 10;

  /// What the steps to come will move nodes by, in moves of the step just taken, from the
  /// contraction expected of the next one: that of the same step on the level before, made worse by
  /// as much as this step and its linear solution were worse than there; without such a model, the
  /// worse of the last two.
  double moves_left(double seen, double residual) {
    const std::vector<Contraction>& expected = options_.expected;
    std::vector<Contraction>& observed = report_.contractions;
    const std::size_t n = observed.size();  // steps before this one
    if (n > 0) observed.back().rate = seen;
    observed.push_back({0.0, residual});
    double rate = std::max({seen, seen_before_, options_.least_unknown_rate}), least = residual;
    seen_before_ = n > 0 ? seen : 0.0;
    const double before = n > 0 && n <= expected.size() ? expected[n - 1].rate : 0.0;
    const bool smooth = n < expected.size() && expected[n].residual > 0.0;
    if (n < expected.size() && !(smooth && seen < kUnlike * before)) {
      double worse = before > 0.0 ? std::max(1.0, seen / before) : 1.0;
      if (smooth) {
        worse = std::max(worse, residual / expected[n].residual);
        least = 0.0;
      }
      rate = std::max(options_.least_rate, worse * expected[n].rate);
    }
    rate = std::clamp(rate, kLeastRate, kMostRate);
    return std::max(rate, least) / (1.0 - rate);
  }

  double wanted(double rounding) const {
    const double wanted = options_.tolerance_rms;
    if (options_.share_of_change <= 0.0) return wanted;
    const double noise =
        std::min(options_.share_in_noise * report_.change_rms, kSettled * rounding);
    return std::max({wanted, options_.share_of_change * report_.change_rms, noise, rounding});
  }
  bool small(const NewtonStep& step, double rounding) const {
    return report_.error_rms <= wanted(rounding) &&
           (options_.tolerance_max == 0.0 || step.dx_max_px <= options_.tolerance_max);
  }
  /// Where no tolerance was asked for: a step as long as the one before, of the size that rounded
  /// states leave in the equations, says that there is nothing more to gain.
  bool no_nearer(const NewtonStep& step, const NewtonStep& before, double rounding) const {
    const bool waves = step.dx_max_px <= kWaves * step.dx_rms_px;
    return automatic() && step.dx_rms_px <= (waves ? kRoundedWaves : kRounded) * rounding &&
           step.dx_rms_px >= kNoNearer * before.dx_rms_px;
  }
  /// No tolerance was asked for.
  bool automatic() const { return options_.share_of_change > 0.0 && options_.tolerance_rms == 0.0; }
  /// Geometric mean of what two steps would have moved at full length.
  static double mean_move(double move, const NewtonStep& step, double move_before,
                          const NewtonStep& before) {
    return std::sqrt(move / step.step * (move_before / before.step));
  }
  /// As long as steps are where nothing holds them back.
  bool ordinary(const NewtonStep& step) const {
    return step.step == 1.0 || (options_.lengthens && step.step > 1.0);
  }
  bool idles(double move) {
    const bool nearer = move > 0.0 && move < 0.5 * least_move_;
    if (nearer) least_move_ = move;
    idle_ = nearer ? 0 : idle_ + 1;
    return options_.most_idle > 0 && idle_ >= options_.most_idle;
  }
  bool areas_done() const {
    return options_.most_volume_gap == 0.0 || report_.volume_gap <= options_.most_volume_gap;
  }
  void advance(double rounding) {
    const double first = report_.steps.front().dx_rms_px, last = wanted(rounding);
    share_ += kLeastShare * (1.0 - share_);
    if (last > 0.0 && last < first && report_.error_rms < first)
      share_ = std::max(share_, std::min(kMostShare, std::log(first / report_.error_rms) /
                                                         std::log(first / last)));
  }
  void set_error(double moves, const FullMove& move) {
    report_.error_rms = moves * move.rms;
    report_.error_max = moves * move.max;
  }
  bool end(Status status) {
    report_.status = status;
    // A step of length 0, or a linear solution that is 0, tells nothing of what is left.
    if (status == Status::stalled && report_.error_rms == 0.0)
      report_.error_rms = report_.error_max = std::numeric_limits<double>::quiet_NaN();
    return true;
  }

  const NewtonOptions& options_;
  NewtonReport& report_;
  int creeping_ = 0, settled_ = 0, unsolved_ = 0, tiny_ = 0, calm_ = kCalm;
  int idle_ = 0;  // steps since one moved nodes by less than half the least before
  double least_move_ = std::numeric_limits<double>::infinity();
  double seen_before_ = 0.0, share_ = 0.0;
  bool only_areas_lack_ = false, uneven_ = false;
  bool areas_fail_ = false;  // the last step for areas alone was not taken
};

/// Lengths of the steps tried. A clamped Hessian may overshoot by twice, back and forth for ever,
/// most at tips: half a step ends in the middle. Or it is too stiff for one mode, and steps of one
/// direction creep: the step then goes where they would end.
class StepLength {
 public:
  /// What is tried next.
  double longest() const { return longest_; }

  /// Where a step that is `turned` so from the one before goes on to, its cycles being too weak for
  /// what they have in common: Aitken's extrapolation (Irons and Tuck 1969).
  double lengthened(const Turned& turned) const {
    if (!(turned.cosine > kSomewhat) || !(taken_ >= 1.0)) return longest_;
    const double along = turned.ratio * turned.cosine;
    const double difference = 1.0 + turned.ratio * turned.ratio - 2.0 * along;
    return std::clamp(taken_ * (1.0 - along) / difference, 1.0, kHalf);
  }

  /// From the first step on that moves nodes nearly as far as the one before, their directions are
  /// asked for.
  bool slow(double rms) { return slow_ = slow_ || rms > kSlow * rms_before_; }

  /// Notes a step by its full move; `shortened`: see Judge; `counts`: it can have undone the one
  /// before; `cosine`: between the two moves, not a number where it is not known.
  void note(double rms, double taken, bool shortened, bool counts, double cosine) {
    taken_ = shortened ? 0.0 : taken;
    const double rate = rms / rms_before_;
    const bool full = !shortened && longest_ == 1.0;
    const double factor = std::copysign(rate, cosine);  // of the mode that is left, if it is one
    const bool one_mode = full && rate > kSlow && factor < 1.0 && std::abs(cosine) > kAligned;
    const bool undone = counts && !shortened && rate > kBackAndForth;
    in_circles_ = undone && full && !one_mode ? in_circles_ + 1 : 0;
    longest_ = one_mode           ? std::clamp(1.0 / (1.0 - factor), 0.5, kLongest)
               : in_circles_ >= 2 ? 0.5
                                  : 1.0;
    rms_before_ = rms;
  }

 private:
  // A full step this large beside the one before may well undo it; two in a row do.
  static constexpr double kBackAndForth = 0.9;
  // Creeping: S3, conforming, 400² 23 steps without longer ones, 16 so; 800² 18 and 14. The merit
  // lets most of them be twice as long. Back and forth: the scenes of kLeast in newton_accuracy.h
  // with averaged rows, 19 of 52 did not end so, 13 with it.
  static constexpr double kAligned = 0.9, kSlow = 0.75, kLongest = 8.0;
  // What lengthened() takes for the same direction, and its bound.
  static constexpr double kSomewhat = 0.3, kHalf = 1.5;
  double taken_ = 0.0;  ///< length of the last step, 0 where it was shortened
  double longest_ = 1.0, rms_before_ = std::numeric_limits<double>::infinity();
  bool slow_ = false;
  int in_circles_ = 0;
};

}  // namespace drumhead::multigrid
