// SPDX-License-Identifier: MIT
#pragma once
// Gauss–Legendre quadrature: two points are exact for polynomials of degree 3, eight for 15.
#include <array>

namespace drumhead::grid {

/// Calls f(t, weight) at the points of [t0, t1]; Σ weight = t1 − t0.
template <class F>
void for_gauss_points(double t0, double t1, F&& f) {
  constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                       0.9602898564975363};
  constexpr std::array<double, 4> weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                         0.1012285362903763};
  const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0);
  for (std::size_t n = 0; n < node.size(); ++n) {
    f(middle - half * node[n], half * weight[n]);
    f(middle + half * node[n], half * weight[n]);
  }
}

/// The same with two points.
template <class F>
void for_two_gauss_points(double t0, double t1, F&& f) {
  constexpr double node = 0.5773502691896258;  // 1/√3
  const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0);
  f(middle - half * node, half);
  f(middle + half * node, half);
}

}  // namespace drumhead::grid
