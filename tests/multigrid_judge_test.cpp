// SPDX-License-Identifier: MIT
// When a run of Newton's method ends, and with what error, by its steps alone.
#include <gtest/gtest.h>

#include "newton_judge.h"

namespace drumhead::multigrid {
namespace {

/// A step that the merit shortened to a tenth, of a system solved well.
bool ends_with_shortened(Judge& judge, FullMove full) {
  const NewtonStep step{.step = 0.1,
                        .krylov = 1,
                        .residual = 0.1,
                        .dx_rms_px = 0.1 * full.rms,
                        .dx_max_px = 0.1 * full.max};
  return judge.ends_with(step, full, true, 0.0, 0.0, 1.0);
}

TEST(Judge, TinyFullMovesEndARunWithTheErrorThatTheyTell) {
  NewtonOptions options;
  options.tolerance_rms = 1.0;
  NewtonReport report;
  Judge judge(options, report);
  EXPECT_FALSE(ends_with_shortened(judge, {0.15, 0.9}));
  EXPECT_FALSE(ends_with_shortened(judge, {0.12, 0.9}));
  EXPECT_TRUE(ends_with_shortened(judge, {0.1, 0.8}));
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_NEAR(report.error_rms, 0.5, 1e-12);
  EXPECT_NEAR(report.error_max, 4.0, 1e-12);
}

TEST(Judge, LargeFullMovesOfShortenedStepsEndNoRun) {
  NewtonOptions options;
  options.tolerance_rms = 1.0;
  NewtonReport report;
  Judge judge(options, report);
  for (int n = 0; n < 10; ++n) EXPECT_FALSE(ends_with_shortened(judge, {0.3, 0.9}));
}

TEST(Judge, AShortenedStepAmongRoundedStatesEndsARunWithItsFullMove) {
  const NewtonStep step{.step = 0.01, .krylov = 1, .residual = 0.4, .dx_rms_px = 3e-3};
  for (const double tolerance : {0.0, 1e-3}) {
    NewtonOptions options;
    options.share_of_change = 0.1;
    options.tolerance_rms = tolerance;
    NewtonReport report;
    report.change_rms = 1.0;
    Judge judge(options, report);
    EXPECT_EQ(judge.ends_rounded(step, {0.3, 0.9}), tolerance == 0.0);
    if (tolerance > 0.0) continue;
    EXPECT_EQ(report.status, Status::converged);
    EXPECT_TRUE(report.rounded);
    EXPECT_EQ(report.error_rms, 0.3);
    EXPECT_EQ(report.error_max, 0.9);
    EXPECT_EQ(report.steps.size(), 1u);
  }
}

TEST(Judge, StepsThatComeNoNearerStallWhereThatIsAskedFor) {
  for (const int most_idle : {0, 3}) {
    NewtonOptions options;
    options.tolerance_rms = 1e-3;
    options.most_idle = most_idle;
    NewtonReport report;
    Judge judge(options, report);
    std::size_t ended = 0;
    for (const double move : {8.0, 5.0, 3.0, 2.9, 2.0, 1.6, 1.0}) {
      const NewtonStep step{
          .step = 1.0, .krylov = 1, .residual = 0.1, .dx_rms_px = move, .dx_max_px = move};
      if (ended == 0 && judge.ends_with(step, {move, move}, false, 0.0, 0.0, 1.0))
        ended = report.steps.size();
    }
    EXPECT_EQ(ended, most_idle > 0 ? 6u : 0u);  // 3 is less than half of 8, and none of 3 itself
    EXPECT_EQ(report.status, most_idle > 0 ? Status::stalled : Status::converged);
  }
}

}  // namespace
}  // namespace drumhead::multigrid
