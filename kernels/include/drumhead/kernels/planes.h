// SPDX-License-Identifier: MIT
#pragma once
// Planes (views.h) on memory of one's own, and the way between their split rows and arrays that
// hold row after row: value (i, j) at j·columns + i.
#include <drumhead/kernels/views.h>

#include <type_traits>

namespace drumhead::kernels {

/// The columns·rows values at `data` as a plane without padding.
template <class T>
constexpr Plane<T> plane_of(T* data, int columns, int rows) {
  return {data, columns, half_count(columns, 0), columns, rows};
}

/// plane(i, j) = values[j·columns + i]; they must not overlap.
template <class T>
void copy_from_rows(const T* values, const Plane<T>& plane) {
  for (int j = 0; j < plane.rows; ++j)
    for (int i = 0; i < plane.columns; ++i) plane.at(i, j) = *values++;
}

/// values[j·columns + i] = plane(i, j); they must not overlap.
template <class T>
void copy_to_rows(const Plane<T>& plane, std::remove_const_t<T>* values) {
  for (int j = 0; j < plane.rows; ++j)
    for (int i = 0; i < plane.columns; ++i) *values++ = plane.at(i, j);
}

}  // namespace drumhead::kernels
