// SPDX-License-Identifier: MIT
// Béziers, their lengths, and how two chains of different segments are matched.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <drumhead/grid/curve.h>

#include "support/refusal.h"

namespace drumhead::grid {
namespace {

const CubicBezier kBow{{{{1, 2}, {4, 9}, {7, -5}, {9, 3}}}};

void expect_near(Point a, Point b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(GridCurve, ABezierRunsFromItsFirstToItsLastControlPoint) {
  EXPECT_EQ(kBow.at(0.0), kBow.control[0]);
  EXPECT_EQ(kBow.at(1.0), kBow.control[3]);
}

TEST(GridCurve, APieceIsTheSameCurveOverAnInterval) {
  for (const double t0 : {0.0, 0.2, 0.7})
    for (const double t1 : {0.75, 1.0}) {
      const CubicBezier piece = kBow.piece(t0, t1);
      for (const double t : {0.0, 0.3, 1.0})
        expect_near(piece.at(t), kBow.at(t0 + t * (t1 - t0)), 1e-14);
    }
}

TEST(GridCurve, TheDerivativeIsThatOfThePoints) {
  // Central differences of a cubic err by its third derivative times the square of the step / 6.
  const double step = 1e-4;
  for (const double t : {0.1, 0.5, 0.9}) {
    const Point difference = (0.5 / step) * (kBow.at(t + step) - kBow.at(t - step));
    expect_near(kBow.derivative(t), difference, 1e-6);
  }
}

TEST(GridCurve, AStraightSegmentHasConstantSpeed) {
  const CubicBezier line = straight({1, 2}, {4, 6});
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    EXPECT_NEAR(length(line.derivative(t)), 5.0, 1e-14);
    expect_near(line.at(t), Point{1 + 3 * t, 2 + 4 * t}, 1e-14);
  }
  EXPECT_NEAR(arc_length(line), 5.0, 1e-14);
}

TEST(GridCurve, ArcLengthAddsUpOverPieces) {
  const double whole = arc_length(kBow);
  for (const double t : {0.1, 0.37, 0.5, 0.9}) {
    const double sum = arc_length(kBow.piece(0, t)) + arc_length(kBow.piece(t, 1));
    EXPECT_NEAR(sum, whole, 1e-9 * whole);
  }
}

TEST(GridCurve, ArcLengthIsTheLimitOfChords) {
  const int chords = 20000;
  double sum = 0.0;
  for (int n = 0; n < chords; ++n)
    sum += length(kBow.at(double(n + 1) / chords) - kBow.at(double(n) / chords));
  EXPECT_NEAR(arc_length(kBow), sum, 1e-7);
}

// The length of a parabola's arc is known: y = x² from 0 to 1.
TEST(GridCurve, ArcLengthOfAParabolaIsExact) {
  const CubicBezier parabola{{{{0, 0}, {1.0 / 3, 0}, {2.0 / 3, 1.0 / 3}, {1, 1}}}};
  const double exact = std::sqrt(5.0) / 2 + std::asinh(2.0) / 4;
  EXPECT_NEAR(arc_length(parabola), exact, 1e-10 * exact);
}

// There and back on a line: the speed vanishes at both turns, where quadrature is worst.
TEST(GridCurve, ArcLengthCountsTheWayBack) {
  const CubicBezier there_and_back{{{{0, 0}, {4, 0}, {-3, 0}, {1, 0}}}};
  // x = 12 t (1−t)² − 9 t² (1−t) + t³ turns where 22 t² − 22 t + 4 = 0.
  const double root = std::sqrt(22.0 * 22.0 - 4 * 22.0 * 4) / 44.0;
  const double x0 = there_and_back.at(0.5 - root).x, x1 = there_and_back.at(0.5 + root).x;
  const double exact = x0 + (x0 - x1) + (1.0 - x1);
  EXPECT_NEAR(arc_length(there_and_back), exact, 1e-8 * exact);
}

TEST(GridCurve, APointHasNoLength) { EXPECT_EQ(arc_length(straight({3, 3}, {3, 3})), 0.0); }

TEST(GridCurve, EqualNumbersOfSegmentsMatchOneToOne) {
  const CurvePair pair{.source = {kBow, straight({9, 3}, {9, 4})},
                       .target = {straight({0, 0}, {1, 0}), straight({1, 0}, {100, 0})}};
  const auto segments = matched(pair);
  ASSERT_EQ(segments.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(segments[n].source.control, pair.source[n].control);
    EXPECT_EQ(segments[n].target.control, pair.target[n].control);
  }
}

/// A chain of uneven segments against a single bow.
CurvePair uneven() {
  return {.name = "bow",
          .source = {straight({0, 0}, {1, 0}), straight({1, 0}, {1, 7}), straight({1, 7}, {5, 5})},
          .target = {kBow}};
}

TEST(GridCurve, MatchedPiecesAreConnectedAndCoverBothChains) {
  const CurvePair pair = uneven();
  const auto segments = matched(pair);
  EXPECT_EQ(segments.front().source.at(0), pair.source.front().at(0));
  EXPECT_EQ(segments.front().target.at(0), pair.target.front().at(0));
  expect_near(segments.back().source.at(1), pair.source.back().at(1), 1e-12);
  expect_near(segments.back().target.at(1), pair.target.back().at(1), 1e-12);
  for (std::size_t n = 0; n + 1 < segments.size(); ++n) {
    expect_near(segments[n].source.at(1), segments[n + 1].source.at(0), 1e-9);
    expect_near(segments[n].target.at(1), segments[n + 1].target.at(0), 1e-9);
  }
}

TEST(GridCurve, MatchedPointsLieAtEqualRelativeLength) {
  const CurvePair pair = uneven();
  const double source_whole = arc_length(pair.source), target_whole = arc_length(pair.target);
  double source_sum = 0.0, target_sum = 0.0;
  for (const SegmentPair& segment : matched(pair)) {
    for (const double t : {0.25, 0.5, 0.75}) {
      const double s = source_sum + arc_length(segment.source.piece(0, t));
      const double on_target = target_sum + arc_length(segment.target.piece(0, t));
      EXPECT_NEAR(s / source_whole, on_target / target_whole, 2e-4);
    }
    source_sum += arc_length(segment.source);
    target_sum += arc_length(segment.target);
  }
  EXPECT_NEAR(source_sum, source_whole, 1e-8 * source_whole);
  EXPECT_NEAR(target_sum, target_whole, 1e-8 * target_whole);
}

TEST(GridCurve, SplittingASegmentOfTheSourceKeepsWhereItsPointsGo) {
  // A straight chain in one piece and in three unequal ones to the same target.
  const CurvePair split{
      .source = {straight({0, 0}, {1, 0}), straight({1, 0}, {4, 0}), straight({4, 0}, {10, 0})},
      .target = {straight({0, 5}, {20, 5})}};
  for (const SegmentPair& segment : matched(split))
    for (const double t : {0.0, 0.5, 1.0})
      EXPECT_NEAR(2.0 * segment.source.at(t).x, segment.target.at(t).x, 1e-8);
}

TEST(GridCurve, AnEmptyChainIsRefused) {
  EXPECT_EQ(tests::refusal([] { (void)matched({.name = "lip", .target = {kBow}}); }),
            "curve 'lip': the source is empty");
  EXPECT_EQ(tests::refusal([] { (void)matched({.name = "lip", .source = {kBow}}); }),
            "curve 'lip': the target is empty");
}

TEST(GridCurve, AChainWithoutLengthIsRefused) {
  const CubicBezier point = straight({2, 2}, {2, 2});
  EXPECT_EQ(
      tests::refusal([&] { (void)matched({.name = "dot", .source = {point}, .target = {kBow}}); }),
      "curve 'dot': the source has no length");
  EXPECT_EQ(
      tests::refusal([&] { (void)matched({.name = "dot", .source = {kBow}, .target = {point}}); }),
      "curve 'dot': the target has no length");
}

TEST(GridCurve, APointThatIsNotFiniteIsRefused) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CubicBezier broken = kBow;
    broken.control[2].y = bad;
    EXPECT_EQ(tests::refusal(
                  [&] { (void)matched({.name = "far", .source = {broken}, .target = {kBow}}); }),
              "curve 'far': the source has a point that is not finite");
    EXPECT_EQ(tests::refusal(
                  [&] { (void)matched({.name = "far", .source = {kBow}, .target = {broken}}); }),
              "curve 'far': the target has a point that is not finite");
  }
}

}  // namespace
}  // namespace drumhead::grid
