// SPDX-License-Identifier: MIT
// Only curves that changed are made anew.
#include "made_of_curves.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace drumhead::grid {
namespace {

CurvePair line(const char* name, double x) {
  const std::vector<CubicBezier> chain{straight({x, 1.0}, {x, 2.0})};
  return {name, chain, chain};
}

class Counted : public ::testing::Test {
 protected:
  /// Names of the curves that are made for a scene.
  std::vector<std::string> made_for(const std::vector<CurvePair>& curves) {
    std::vector<std::string> names;
    last_ = made_.of(curves, [&](const CurvePair& curve) {
      if (curve.name == "bad") throw std::invalid_argument("bad");
      names.push_back(curve.name);
      return curve.source[0].control[0].x;
    });
    EXPECT_EQ(last_.size(), curves.size());
    for (std::size_t n = 0; n < curves.size(); ++n)
      EXPECT_EQ(*last_[n], curves[n].source[0].control[0].x);
    return names;
  }
  MadeOfCurves<double> made_;
  MadeOfCurves<double>::Pointers last_;
};

using Names = std::vector<std::string>;

TEST_F(Counted, AllOfTheFirstScene) {
  EXPECT_EQ(made_for({line("a", 1.0), line("b", 2.0)}), (Names{"a", "b"}));
}

TEST_F(Counted, NothingIfNothingChanged) {
  (void)made_for({line("a", 1.0), line("b", 2.0)});
  const auto before = last_;
  EXPECT_EQ(made_for({line("a", 1.0), line("b", 2.0)}), Names{});
  EXPECT_EQ(last_, before);
}

TEST_F(Counted, TheOneWhoseTargetMoved) {
  std::vector<CurvePair> curves{line("a", 1.0), line("b", 2.0), line("c", 3.0)};
  (void)made_for(curves);
  curves[1].target[0].control[1].y += 1e-15;
  EXPECT_EQ(made_for(curves), Names{"b"});
}

TEST_F(Counted, TheOneThatWasAdded) {
  (void)made_for({line("a", 1.0), line("b", 2.0)});
  EXPECT_EQ(made_for({line("new", 4.0), line("a", 1.0), line("b", 2.0)}), Names{"new"});
}

TEST_F(Counted, NoneWhereCurvesWereTakenAwayOrChangedPlaces) {
  (void)made_for({line("a", 1.0), line("b", 2.0), line("c", 3.0)});
  EXPECT_EQ(made_for({line("c", 3.0), line("a", 1.0)}), Names{});
}

TEST_F(Counted, TheSceneBeforeIsKeptWhereOneIsRefused) {
  (void)made_for({line("a", 1.0), line("b", 2.0)});
  EXPECT_THROW((void)made_for({line("a", 1.0), line("bad", 2.0)}), std::invalid_argument);
  EXPECT_EQ(made_for({line("a", 1.0), line("b", 2.0)}), Names{});
}

}  // namespace
}  // namespace drumhead::grid
