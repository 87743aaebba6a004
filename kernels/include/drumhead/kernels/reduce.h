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

/// max |a|; NaN if any value is NaN.
template <class T>
double largest(const Plane<const T>& a);

/// y = a x + b y; with b = 0, y is not read.
template <class T>
void combine(T a, const Plane<const T>& x, T b, const Plane<T>& y);
/// x, y, p, the list and the curve nodes.
template <class T>
void combine(T a, const Unknowns<const T>& x, T b, const Unknowns<T>& y);

}  // namespace drumhead::kernels
