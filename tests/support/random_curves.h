// SPDX-License-Identifier: MIT
#pragma once
// Random scenes for the conforming cells: every kind of curve that has made such constructions
// fail, several at once, in cells of an nx × ny lattice of unit cells.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cut_checks.h"

namespace drumhead::grid {

class RandomCurves {
 public:
  RandomCurves(unsigned seed, int nx, int ny) : bits_(seed), nx_(nx), ny_(ny) {}

  double number(double low, double high) {
    return low + (high - low) * double(bits_()) / double(std::mt19937::max());
  }
  int whole(int low, int high) { return low + int(bits_() % unsigned(high - low + 1)); }
  Point place(double margin) {
    return {number(margin, nx_ - margin), number(margin, ny_ - margin)};
  }

  /// Any kind.
  CurvePair any() {
    switch (whole(0, 9)) {
      case 0:
        return circle(number(0.02, 0.6));
      case 1:
        return circle(number(0.6, 0.4 * std::min(nx_, ny_)));
      case 2:
        return pinned({straight(place(0.0), place(0.0))});
      case 3:
        return bow();
      case 4:
        return aligned();
      case 5:
        return corners();
      case 6:
        return shorter_than_a_cell();
      case 7:
        return figure_of_eight();
      case 8:
        return wave();
      default:
        return to_the_boundary();
    }
  }
  /// Any closed kind.
  CurvePair closed() {
    switch (whole(0, 3)) {
      case 0:
        return circle(number(0.02, 0.6));
      case 1:
        return circle(number(0.6, 0.4 * std::min(nx_, ny_)));
      case 2:
        return rectangle();
      default:
        return figure_of_eight();
    }
  }
  /// The curve a short way off.
  CurvePair parallel(const CurvePair& curve) {
    const Point away{number(-0.3, 0.3), number(-0.3, 0.3)};
    CurvePair out = curve;
    for (CubicBezier& segment : out.source)
      for (Point& p : segment.control)
        p = {std::clamp(p.x + away.x, 0.0, double(nx_)),
             std::clamp(p.y + away.y, 0.0, double(ny_))};
    return out;
  }
  CurvePair circle(double radius) { return pinned(round(place(radius), radius)); }

  std::vector<CurvePair> scene(bool only_closed) {
    std::vector<CurvePair> curves;
    const int count = whole(1, 4);
    while (int(curves.size()) < count) {
      if (!curves.empty() && whole(0, 3) == 0)
        curves.push_back(parallel(curves.back()));
      else
        curves.push_back(only_closed ? closed() : any());
      if (whole(0, 3) == 0) curves.back().weight = number(1.0, 1e4);
    }
    return curves;
  }

 private:
  CurvePair bow() {
    const double m = 0.3;
    return pinned({{{{place(m), place(m), place(m), place(m)}}}});
  }
  /// On lattice lines or within rounding of them, through nodes.
  CurvePair aligned() {
    const double off = std::vector<double>{0.0, 1e-12, 3e-9, 1e-5}[std::size_t(whole(0, 3))];
    const int i = whole(1, nx_ - 1), j = whole(1, ny_ - 1);
    const double end = whole(0, 1) ? nx_ - 1.0 : number(1.0, nx_ - 1.0);
    switch (whole(0, 2)) {
      case 0:
        return pin({{1.0, j + off}, {end, j - off}});
      case 1:
        return pin({{i + off, 1.0}, {i + off, ny_ - 1.0}});
      default: {
        const int n = std::min(nx_, ny_) - 1;
        return pin({{1.0 + off, 1.0}, {double(n) + off, double(n)}});
      }
    }
  }
  CurvePair corners() {
    std::vector<Point> points;
    for (int n = whole(3, 7); n > 0; --n) points.push_back(place(0.2));
    if (whole(0, 1)) points.push_back(points.front());
    return pin(points);
  }
  CurvePair rectangle() {
    const Point a = place(0.3), b = place(0.3);
    return pin({a, {b.x, a.y}, b, {a.x, b.y}, a});
  }
  CurvePair shorter_than_a_cell() {
    const Point a = place(0.5);
    return pin({a, a + Point{number(-0.4, 0.4), number(-0.4, 0.4)}});
  }
  CurvePair figure_of_eight() {
    const Point c = place(1.5);
    const double size = number(0.2, 1.4);
    std::vector<Point> points;
    for (int n = 0; n <= 64; ++n) {
      const double a = 2.0 * 3.14159265358979 * (n % 64) / 64;
      points.push_back({c.x + size * std::sin(a), c.y + size * std::sin(2.0 * a)});
    }
    return pin(points);
  }
  CurvePair wave() {
    const double y = number(1.0, ny_ - 1.0), height = number(0.0, 0.9), turns = number(1.0, 40.0);
    std::vector<Point> points;
    for (int n = 0; n <= 200; ++n)
      points.push_back({0.5 + (nx_ - 1.0) * n / 200, y + height * std::sin(turns * n / 200)});
    return pin(points);
  }
  CurvePair to_the_boundary() {
    const Point a = place(0.0);
    switch (whole(0, 3)) {
      case 0:
        return pin({{0.0, a.y}, {double(nx_), number(0.0, ny_)}});
      case 1:
        return pin({{a.x, 0.0}, a});
      case 2:
        return pin({a, {double(nx_), double(ny_)}});
      default:
        return pin({{0.0, 0.0}, {0.0, a.y}, a});
    }
  }

  std::mt19937 bits_;
  int nx_, ny_;
};

}  // namespace drumhead::grid
