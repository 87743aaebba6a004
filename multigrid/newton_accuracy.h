// SPDX-License-Identifier: MIT
#pragma once
// How accurately the linear systems of a run with exact rows are solved: as far as Newton's method
// converges by itself, more accurately where a step had to be shortened much.
#include <algorithm>

#include "newton.h"

namespace drumhead::multigrid {

class LinearAccuracy {
 public:
  LinearAccuracy(const NewtonOptions& options) : most_(options.linear.reduction), wanted_(most_) {}

  /// Sets the residual wanted of the system at a state whose force has this norm.
  void set(double norm, LinearOptions& options) {
    const double rate = before_ > 0.0 ? norm / before_ : 1.0;
    before_ = norm;
    options.reduction = options.content =
        std::clamp(kOfRate * rate * rate, std::min(kQuadratic, wanted_), wanted_);
  }
  /// True if a step of length 0 deserves another trial with a more accurate solution; it is then
  /// filed in the report.
  bool raised_by(const NewtonStep& step, NewtonReport& report) {
    if (step.step == 1.0) wanted_ = std::min(kRelaxes * wanted_, most_);
    if (step.step >= kMuchShortened || wanted_ <= kLeast) return false;
    wanted_ *= 0.1;
    before_ = 0.0;
    if (step.step > 0.0 || step.theta > 1.0) return false;
    report.steps.push_back(step);
    return true;
  }

 private:
  static constexpr double kOfRate = 0.3, kQuadratic = 1e-4, kLeast = 2e-6;
  static constexpr double kRelaxes = 3.0, kMuchShortened = 0.1;
  double most_, wanted_, before_ = 0.0;
};

}  // namespace drumhead::multigrid
