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

}  // namespace
}  // namespace drumhead::multigrid
