// SPDX-License-Identifier: MIT
#include <drumhead/kernels/reduce.h>

#include <algorithm>
#include <vector>

#include "kernel_table.h"
#include "parallel.h"

namespace drumhead::kernels {
namespace {

/// One value a row, of the calling thread, kept from call to call: solvers reduce without
/// allocating.
template <class V = double>
V* row_buffer(int rows) {
  thread_local std::vector<V> values;
  if (values.size() < std::size_t(rows)) values.resize(std::size_t(rows));
  return values.data();
}

template <class T, class F>
double sum_of_rows(const Plane<const T>& plane, F&& of_row) {
  if (!plane) return 0.0;
  double* const sums = row_buffer(plane.rows);
  for_rows(0, plane.rows, plane.columns, [&](int j) { sums[j] = of_row(j); });
  double sum = 0.0;
  for (int j = 0; j < plane.rows; ++j) sum += sums[j];
  return sum;
}

}  // namespace

template <class T>
double dot(const Plane<const T>& a, const Plane<const T>& b) {
  return sum_of_rows(a, [&](int j) { return table<T>().dot(a, b, j); });
}

template <class T>
double squares_over(const Plane<const T>& a, const Plane<const T>& b) {
  return sum_of_rows(a, [&](int j) { return table<T>().squares_over(a, b, j); });
}

template <class T>
double dot(const Unknowns<const T>& a, const Unknowns<const T>& b) {
  return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.p, b.p);
}

template <class T>
void combine(T a, const Plane<const T>& x, T b, const Plane<T>& y) {
  if (!x) return;
  const KernelTable<T>& kernels = table<T>();
  for_rows(0, x.rows, x.columns, [&](int j) { kernels.combine(a, x, b, y, j); });
}

template <class T>
Moved move(T a, const Plane<const T>& x, const Plane<T>& y) {
  Moved all;
  if (!x) return all;
  const KernelTable<T>& kernels = table<T>();
  Moved* const of_row = row_buffer<Moved>(x.rows);
  for_rows(0, x.rows, x.columns, [&](int j) { kernels.move(a, x, y, of_row[j], j); });
  auto larger = [](double a, double b) { return b > a || b != b ? b : a; };
  for (int j = 0; j < x.rows; ++j) {
    all.squares += of_row[j].squares;
    all.most = larger(all.most, of_row[j].most);
    all.reach = larger(all.reach, of_row[j].reach);
  }
  return all;
}

template <class T>
void combine(T a, const Unknowns<const T>& x, T b, const Unknowns<T>& y) {
  combine(a, x.x, b, y.x);
  combine(a, x.y, b, y.y);
  combine(a, x.p, b, y.p);
  const int count = x.p && y.p ? std::min(x.listed_count, y.listed_count) : 0;
  for (int k = 0; k < count; ++k)
    y.listed[k] = a * x.listed[k] + (b == T(0) ? T(0) : b * y.listed[k]);
  for (int k = 0; k < std::min(x.curve_count, y.curve_count); ++k)
    y.curve[k] = a * x.curve[k] + (b == T(0) ? T(0) : b * y.curve[k]);
}

template <class T>
double dot_listed(const Unknowns<const T>& a, const Unknowns<const T>& b) {
  double sum = 0.0;
  const int count = a.p && b.p ? std::min(a.listed_count, b.listed_count) : 0;
  for (int k = 0; k < count; ++k) sum += double(a.listed[k]) * double(b.listed[k]);
  return sum;
}

template <class T>
double dot_curve(const Unknowns<const T>& a, const Unknowns<const T>& b) {
  double sum = 0.0;
  for (int k = 0; k < std::min(a.curve_count, b.curve_count); ++k)
    sum += double(a.curve[k]) * double(b.curve[k]);
  return sum;
}

#define DRUMHEAD_INSTANTIATE(T)                                                   \
  template double dot_curve(const Unknowns<const T>&, const Unknowns<const T>&);  \
  template double dot(const Plane<const T>&, const Plane<const T>&);              \
  template double dot(const Unknowns<const T>&, const Unknowns<const T>&);        \
  template double dot_listed(const Unknowns<const T>&, const Unknowns<const T>&); \
  template double squares_over(const Plane<const T>&, const Plane<const T>&);     \
  template void combine(T, const Plane<const T>&, T, const Plane<T>&);            \
  template Moved move(T, const Plane<const T>&, const Plane<T>&);                 \
  template void combine(T, const Unknowns<const T>&, T, const Unknowns<T>&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
