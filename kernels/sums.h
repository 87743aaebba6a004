// SPDX-License-Identifier: MIT
#pragma once
// Sums whose value depends neither on the vector width nor on the number of threads: sixteen double
// sums a row, element k of a half row into sum k mod 16, added up in a fixed order; rows are added
// in order.
namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

struct Sixteen {
  double at[16] = {};

  template <class T>
  void add(const T* values, int count) {
    int k = 0;
    for (; k + 16 <= count; k += 16)
      for (int l = 0; l < 16; ++l) at[l] += double(values[k + l]);
    for (int l = 0; k + l < count; ++l) at[l] += double(values[k + l]);
  }
  template <class T>
  void add_products(const T* a, const T* b, int count) {
    int k = 0;
    for (; k + 16 <= count; k += 16)
      for (int l = 0; l < 16; ++l) at[l] += double(a[k + l]) * double(b[k + l]);
    for (int l = 0; k + l < count; ++l) at[l] += double(a[k + l]) * double(b[k + l]);
  }
  /// a²/b where b > 0.
  template <class T>
  void add_squares_over(const T* a, const T* b, int count) {
    auto term = [](double value, double over) {
      const bool counts = over > 0.0;
      const double kept = counts ? value : 0.0;
      return kept * kept / (counts ? over : 1.0);
    };
    int k = 0;
    for (; k + 16 <= count; k += 16)
      for (int l = 0; l < 16; ++l) at[l] += term(double(a[k + l]), double(b[k + l]));
    for (int l = 0; k + l < count; ++l) at[l] += term(double(a[k + l]), double(b[k + l]));
  }
  double total() const {
    double sum = 0.0;
    for (int l = 0; l < 16; ++l) sum += at[l];
    return sum;
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
