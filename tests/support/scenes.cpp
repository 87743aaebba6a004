// SPDX-License-Identifier: MIT
#include "scenes.h"

#include <array>
#include <cmath>
#include <numbers>

namespace drumhead::scenes {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;
constexpr int kCircleChords = 2880;
constexpr int kOpenChords = 2000;

double radians(double degrees) { return degrees * (kPi / 180.0); }

Vector2d circle_point(Vector2d centre, double radius, double angle) {
  return centre + radius * Vector2d(std::cos(angle), std::sin(angle));
}

// A circle carried to the circle of the same radius about `target_centre`, turned by `turn`
// radians.
Polyline circle(std::string name, Vector2d centre, Vector2d target_centre, double radius,
                double turn = 0.0, int chords = kCircleChords) {
  Polyline curve{std::move(name), {}, {}, turn * (180.0 / kPi)};
  for (int k = 0; k <= chords; ++k) {
    const double angle = 2.0 * kPi * (k % chords) / chords;
    curve.source.push_back(circle_point(centre, radius, angle));
    curve.target.push_back(circle_point(target_centre, radius, angle + turn));
  }
  return curve;
}

using Path = std::function<Vector2d(double s)>;

Polyline open_curve(std::string name, const Path& source, const Path& target) {
  Polyline curve{std::move(name), {}, {}};
  for (int k = 0; k <= kOpenChords; ++k) {
    const double s = double(k) / kOpenChords;
    curve.source.push_back(source(s));
    curve.target.push_back(target(s));
  }
  return curve;
}

Vector2d centre_of_square(double offset) { return {0.5 + offset, 0.5 + 0.7 * offset}; }

}  // namespace

Scene sponge(double offset) {
  const auto segment = [=](double x, double bulge) -> Path {
    return
        [=](double s) { return Vector2d(x + offset + bulge * std::sin(kPi * s), 0.25 + 0.5 * s); };
  };
  return {"S1",
          {open_curve("left", segment(0.35, 0.0), segment(0.20, -0.05)),
           open_curve("right", segment(0.65, 0.0), segment(0.80, 0.05))},
          {}};
}

Scene roundabout(double degrees, double offset) {
  const Vector2d centre = centre_of_square(offset);
  return {"S2",
          {circle("island", centre, centre, 0.22, radians(degrees)),
           circle("overpass", centre, centre, 0.40)},
          {}};
}

Scene pinch(double offset) {
  const Vector2d centre = centre_of_square(offset);
  const auto arc = [=](double middle, double move) -> Path {
    return [=](double s) {
      const double angle = middle + radians(25.0) * (2.0 * s - 1.0);
      return Vector2d(circle_point(centre, 0.25, angle) + Vector2d(move, 0.0));
    };
  };
  Scene scene{"S3",
              {open_curve("right finger", arc(0.0, 0.0), arc(0.0, -0.1)),
               open_curve("left finger", arc(kPi, 0.0), arc(kPi, 0.1))},
              {}};
  scene.kappa_mask = [centre](double x, double y) {
    return (Vector2d(x, y) - centre).norm() < 0.25 ? 1000.0 : 0.1;
  };
  return scene;
}

Scene shift(double offset) {
  const Vector2d centre(0.35 + offset, 0.5 + 0.7 * offset);
  return {"S4", {circle("disc", centre, centre + Vector2d(0.3, 0.0), 0.1)}, {}};
}

Scene fold(double offset) {
  const auto segment = [=](double x) -> Path {
    return [=](double s) { return Vector2d(x + offset, 0.3 + 0.4 * s); };
  };
  return {"S5",
          {open_curve("left", segment(0.45), segment(0.55)),
           open_curve("right", segment(0.55), segment(0.45))},
          {}};
}

Scene many_discs() {
  const std::array<Vector2d, 8> from{{{.25, .30},
                                      {.40, .30},
                                      {.55, .30},
                                      {.35, .60},
                                      {.60, .60},
                                      {.75, .65},
                                      {.50, .80},
                                      {.50, .45}}};
  const std::array<Vector2d, 8> to{{{.15, .50},
                                    {.60, .18},
                                    {.80, .42},
                                    {.20, .80},
                                    {.45, .66},
                                    {.82, .80},
                                    {.55, .88},
                                    {.38, .36}}};
  Scene scene{"ML", {}, {}};
  for (std::size_t k = 0; k < from.size(); ++k) {
    scene.curves.push_back(circle("disc " + std::to_string(k), from[k], to[k], 0.025, 0.0, 360));
  }
  return scene;
}

Scene turning_discs() {
  const Vector2d middle(0.5, 0.5);
  Scene scene{"ML2", {}, {}};
  for (int k = 0; k < 6; ++k) {
    const double angle = radians(60.0 * k);
    scene.curves.push_back(circle("disc " + std::to_string(k), circle_point(middle, 0.22, angle),
                                  circle_point(middle, 0.30, angle + radians(75.0)), 0.03));
  }
  return scene;
}

std::vector<double> kappa_cells(const Scene& scene, int n, double kappa) {
  std::vector<double> cells(std::size_t(n) * std::size_t(n), kappa);
  if (scene.kappa_mask) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        cells[std::size_t(j * n + i)] = scene.kappa_mask((i + 0.5) / n, (j + 0.5) / n);
      }
    }
  }
  return cells;
}

}  // namespace drumhead::scenes
