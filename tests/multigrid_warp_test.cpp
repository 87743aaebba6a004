// SPDX-License-Identifier: MIT
// The façade: what solve() refuses, and with which words.
#include <limits>

#include <drumhead/multigrid/warp.h>
#include <gtest/gtest.h>

#include "support/refusal.h"
#include "support/scene_problem.h"

namespace drumhead::multigrid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

WarpProblem shifted_disc(int cells) {
  return scenes::problem(scenes::shift(scenes::kStudyOffset), cells, 1.0);
}

std::string refused(const WarpProblem& problem, const SolverOptions& options = {}) {
  return tests::refusal([&] { (void)solve(problem, options); });
}

TEST(WarpRefusal, NamesTheLatticesValueAndItsBound) {
  WarpProblem problem = shifted_disc(32);
  problem.lattice.cell_px = -2.0;
  EXPECT_EQ(refused(problem), "cell_px of the lattice = -2.000000: must be positive and finite");
  problem = shifted_disc(32);
  problem.lattice.side_px = 0.0;
  EXPECT_EQ(refused(problem), "side_px of the lattice = 0.000000: must be positive and finite");
  problem = shifted_disc(32);
  problem.lattice.origin_px.y = kNan;
  EXPECT_EQ(refused(problem), "origin_px of the lattice = (0.000000, nan): must be finite");
}

class StartRefusal : public testing::TestWithParam<CurveMethod> {};

TEST_P(StartRefusal, NamesWhatIsMissingOrNotFinite) {
  const WarpProblem problem = shifted_disc(32);
  const Solution good = solve(problem, {.curve_method = GetParam()});
  const auto started = [&](auto change) {
    Solution start = good;
    change(start);
    return refused(problem, {.curve_method = GetParam(), .start = &start});
  };
  const std::string begin = "the solution to start from: ";
  EXPECT_EQ(started([](Solution&) {}), "accepted");
  EXPECT_EQ(started([](Solution& s) { s.pressure.clear(); }), "accepted");
  EXPECT_EQ(started([](Solution& s) { s.u_px.pop_back(); }),
            begin + "1088 values of u_px: must be 1089");
  EXPECT_EQ(started([](Solution& s) { s.v_px.clear(); }), begin + "0 values of v_px: must be 1089");
  EXPECT_EQ(started([](Solution& s) { s.v_px[7] = kNan; }),
            begin + "v_px[7] = nan: must be finite");
  EXPECT_EQ(started([](Solution& s) { s.pressure.resize(5); }),
            begin + "5 values of pressure: must be 1024");
  EXPECT_EQ(started([](Solution& s) { s.pressure[3] = 1.0 / 0.0; }),
            begin + "pressure[3] = inf: must be finite");
  if (GetParam() == CurveMethod::averaged) {
    EXPECT_NE(started([](Solution& s) { s.forces[0].q.x = kNan; }).find("(nan, "),
              std::string::npos);
    return;
  }
  EXPECT_NE(started([](Solution& s) {
              s.split.row_begin.pop_back();
            }).find("split.row_begin of 32 indices: must be 33"),
            std::string::npos);
  EXPECT_NE(started([](Solution& s) {
              s.split.triangle_begin[1] = 1 << 20;
            }).find("split.triangle_begin"),
            std::string::npos);
  EXPECT_NE(started([](Solution& s) { s.split.pressure.pop_back(); }).find("split.pressure"),
            std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(Methods, StartRefusal,
                         testing::Values(CurveMethod::averaged, CurveMethod::conforming));

}  // namespace
}  // namespace drumhead::multigrid
