// SPDX-License-Identifier: MIT
#pragma once
// Sums and vector updates over fields. Sums are taken in double, sixteen a row, rows added in
// order: the same bits for every instruction set and number of threads.
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// Σ a b over all values.
template <class T>
double dot(const Plane<const T>& a, const Plane<const T>& b);
/// x, y and (where present) p.
template <class T>
double dot(const Unknowns<const T>& a, const Unknowns<const T>& b);
/// The pressures of parts of special cells, where pressures are present.
template <class T>
double dot_listed(const Unknowns<const T>& a, const Unknowns<const T>& b);
/// The curve nodes of soft curves.
template <class T>
double dot_curve(const Unknowns<const T>& a, const Unknowns<const T>& b);

/// Σ a²/b over all values where b > 0.
template <class T>
double squares_over(const Plane<const T>& a, const Plane<const T>& b);

/// y = a x + b y; with b = 0, y is not read.
template <class T>
void combine(T a, const Plane<const T>& x, T b, const Plane<T>& y);
/// What a step moved.
struct Moved {
  double squares = 0.0;  ///< Σ x²: not finite where any x is not
  double most = 0.0;     ///< max |x|; NaN if any is
  double reach = 0.0;    ///< max |y| after the step; NaN if any is
};
/// y += a x, but where x is not finite y stays: the same step backwards takes all of it back, up to
/// rounding.
template <class T>
Moved move(T a, const Plane<const T>& x, const Plane<T>& y);
/// x, y, p, the list and the curve nodes.
template <class T>
void combine(T a, const Unknowns<const T>& x, T b, const Unknowns<T>& y);

}  // namespace drumhead::kernels
