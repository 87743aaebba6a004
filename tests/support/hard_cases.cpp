// SPDX-License-Identifier: MIT
#include "hard_cases.h"

#include <array>
#include <cmath>
#include <utility>

#include "scene_problem.h"

namespace drumhead::scenes {
namespace {

using grid::CurvePair;
using grid::Point;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const grid::LatticeOptions kTenPixels{.cells = 64, .margin = 0.0};  // on a picture of 640 × 640

CurvePair line(const char* name, Point a, Point b, Point to_a, Point to_b) {
  CurvePair pair;
  pair.name = name;
  pair.source = {grid::straight(a, b)};
  pair.target = {grid::straight(to_a, to_b)};
  return pair;
}

CurvePair disc(const char* name, Point centre, double radius, Point to) {
  CurvePair pair;
  pair.name = name;
  constexpr int kChords = 36;
  const auto at = [&](Point middle, int k) {
    const double a = 2.0 * std::acos(-1.0) * (k % kChords) / kChords;
    return Point{middle.x + radius * std::cos(a), middle.y + radius * std::sin(a)};
  };
  for (int k = 0; k < kChords; ++k) {
    pair.source.push_back(grid::straight(at(centre, k), at(centre, k + 1)));
    pair.target.push_back(grid::straight(at(to, k), at(to, k + 1)));
  }
  return pair;
}

struct Picture {
  double width = 640, height = 640;
  grid::LatticeOptions lattice = kTenPixels;
  double kappa = 10.0;
};

HardCase degenerate(const char* name, std::vector<CurvePair> curves, int most_steps,
                    double most_gap_px, const Picture& picture = {}) {
  HardCase hard{.group = "degenerate", .name = name, .problem = {}};
  hard.problem.lattice = grid::make_lattice(picture.width, picture.height, picture.lattice);
  hard.problem.material.kappa = picture.kappa;
  hard.problem.curves = std::move(curves);
  hard.most_steps = most_steps;
  hard.most_gap_px = most_gap_px;
  return hard;
}

std::vector<HardCase> smallest_cases() {
  const Picture thousand{1000, 1000, {.cells = 64}, 1};
  const auto diagonal = line("a", {100, 100}, {900, 900}, {100, 200}, {900, 900});
  return {
      degenerate("NoCurves", {}, 2, 0, thousand),
      degenerate("OnePixel", {}, 2, 0, {1, 1, {.cells = 64}, 1}),
      degenerate("OneCell", {diagonal}, 2, 110, {1000, 1000, {.cells = 1, .margin = 0}, 1}),
      degenerate("ThreeCellsIncompressible", {diagonal}, 8, 110,
                 {1000, 1000, {.cells = 3, .margin = 0}, kInfinity}),
      degenerate("ThreeRows", {line("a", {100, 10}, {900, 20}, {150, 10}, {900, 20})}, 6, 10,
                 {1000, 30, {.cells = 100, .margin = 0}, 1}),
      degenerate("OddCounts", {line("a", {300, 300}, {700, 400}, {320, 330}, {700, 440})}, 6, 5,
                 {990, 770, {.cells = 99, .margin = 0}, 10}),
  };
}

std::vector<HardCase> place_cases() {
  const auto lifted = line("a", {100, 320}, {540, 320}, {100, 360}, {540, 360});
  return {
      degenerate("OnAGridLine", {lifted}, 6, 5),
      degenerate("AlmostOnAGridLine",
                 {line("a", {100, 319.99}, {540, 320.01}, {100, 359.99}, {540, 360.01})}, 6, 5),
      degenerate("ToACornerOfACell", {line("a", {200, 200}, {320, 320}, {210, 200}, {330, 310})}, 6,
                 5),
      degenerate("ThroughCornersOfCells",
                 {line("a", {160, 160}, {480, 480}, {180, 140}, {500, 460})}, 6, 5),
      degenerate("SliversBesideCorners",
                 {line("a", {160.03, 160}, {480.03, 480}, {180.03, 140}, {500.03, 460})}, 6, 5),
      degenerate("ShorterThanACell", {line("a", {322, 322}, {325, 325}, {352, 322}, {355, 325})}, 6,
                 1),
      degenerate("TooShortToCount",
                 {line("a", {322, 322}, {322.001, 322}, {352, 322}, {352.001, 322})}, 6, 31),
      degenerate("DiscInsideACell", {disc("a", {325, 325}, 3, {345, 325})}, 6, 1),
      degenerate("IntoTheBoundary", {line("a", {320, 320}, {640, 320}, {320, 360}, {640, 330})}, 6,
                 12),
      degenerate("AlongTheBoundary", {line("a", {100, 0}, {540, 0}, {100, 30}, {540, 30})}, 6, 31),
      degenerate("TargetNearlyAPoint",
                 {line("a", {100, 320}, {540, 320}, {300, 320}, {300.1, 320})}, 6, 20,
                 {640, 640, {.cells = 64}, 10}),
  };
}

std::vector<HardCase> company_cases() {
  const auto lifted = [](const char* name, double y, double to) {
    return line(name, {100, y}, {540, y}, {100, to}, {540, to});
  };
  const auto upright = [](const char* name, double x, double to) {
    return line(name, {x, 100}, {x, 540}, {to, 100}, {to, 540});
  };
  return {
      degenerate("Duplicates", {lifted("a", 320, 360), lifted("b", 320, 360)}, 6, 5),
      degenerate("ConflictingDuplicatesMeetInTheMiddle",
                 {lifted("a", 325, 360), lifted("b", 325, 290)}, 6, 35.1),
      degenerate("InAdjacentColumns", {upright("a", 325, 305), upright("b", 335, 355)}, 30, 20),
      degenerate("InOneColumn", {upright("a", 323, 303), upright("b", 327, 347)}, 6, 21),
      degenerate("Crossing",
                 {line("a", {155, 325}, {495, 325}, {165, 267}, {485, 383}),
                  line("b", {325, 155}, {325, 495}, {383, 165}, {267, 485})},
                 6, 5),
      degenerate("CrossingInConflict", {lifted("a", 325, 365), upright("b", 325, 325)}, 10, 22),
  };
}

}  // namespace

std::vector<HardCase> degenerate_cases() {
  std::vector<HardCase> all = smallest_cases();
  for (const auto& cases : {place_cases(), company_cases()})
    all.insert(all.end(), cases.begin(), cases.end());
  return all;
}

std::vector<HardCase> study_cases(int n) {
  struct Study {
    const char* name;
    Scene scene;
    std::array<int, 5> most_steps;  // at kappa/mu 1, 10, 100, 1e4, infinity
    std::array<double, 5> energy_at_32;
    bool unique = true;  // up to kappa 100
  };
  const std::array studies = {
      Study{"S1",
            sponge(),
            {8, 14, 14, 16, 16},
            {1.3920794, 2.1374697, 2.7298491, 2.8245018, 2.8254928}},
      Study{"S2 90 degrees",
            roundabout(90.0),
            {8, 8, 10, 10, 10},
            {2.0827889, 2.2187105, 2.2846214, 2.3213859, 2.3536}},
      Study{"S2 135 degrees",
            roundabout(135.0),
            {8, 8, 10, 10, 10},
            {3.0430186, 3.6812226, 3.916544, 4.0385807, 4.1455}},
      Study{"S2 180 degrees",
            roundabout(180.0),
            {8, 14, 10, 10, 10},
            {3.5492704, 5.5049, 6.0679, 6.3629, 6.4931},
            false},
      Study{"S4", shift(), {8, 8, 12, 12, 12}, {1.2596883, 1.530912, 1.7914657, 1.8856549, 1.9029}},
      Study{"S5", fold(), {8, 18, 28, 28, 28}, {1.2695584, 1.9815, 2.4678, 2.5723, 2.5597}, false}};
  constexpr std::array kKappas = {1.0, 10.0, 100.0, 1e4, kInfinity};
  constexpr std::array kNames = {"1", "10", "100", "1e4", "infinity"};
  std::vector<HardCase> all;
  for (std::size_t k = 0; k < kKappas.size(); ++k)
    for (const Study& study : studies)
      all.push_back({.group = "study",
                     .name = std::string(study.name) + ", kappa " + kNames[k],
                     .problem = problem(study.scene, n, kKappas[k]),
                     .most_steps = study.most_steps[k],
                     .energy_at_32 = study.energy_at_32[k],
                     .unique = study.unique && kKappas[k] <= 100.0});
  all.push_back({.group = "study",
                 .name = "S3, kappa 1000 in 0.1",
                 .problem = problem(pinch(), n, 1.0),
                 .most_steps = 14,
                 .energy_at_32 = 1.1267049,
                 .unique = true});
  return all;
}

}  // namespace drumhead::scenes
