// SPDX-License-Identifier: MIT
#pragma once
// The one place that knows xsimd. A kernel's formula is a generic lambda over a lane type: whole
// batches of the widest kind first, then the narrower ones, then single numbers, so that a row's
// remainder never costs more than a few steps. Every operation is element-wise and never
// contracted: all widths agree bit for bit.
#include <cmath>
#include <xsimd/xsimd.hpp>

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

template <class V>
struct Lane {
  template <class T>
  static V load(const T* at) {
    return V::load_unaligned(at);
  }
  template <class T>
  static void store(V value, T* at) {
    value.store_unaligned(at);
  }
};
template <>
struct Lane<float> {
  static float load(const float* at) { return *at; }
  static void store(float value, float* at) { *at = value; }
};
template <>
struct Lane<double> {
  static double load(const double* at) { return *at; }
  static void store(double value, double* at) { *at = value; }
};

inline float smaller(float a, float b) { return b < a ? b : a; }
inline float larger(float a, float b) { return a < b ? b : a; }
inline float magnitude(float a) { return std::fabs(a); }
inline double smaller(double a, double b) { return b < a ? b : a; }
inline double larger(double a, double b) { return a < b ? b : a; }
inline double magnitude(double a) { return std::fabs(a); }
template <class T, class A>
xsimd::batch<T, A> smaller(xsimd::batch<T, A> a, xsimd::batch<T, A> b) {
  return xsimd::select(b < a, b, a);
}
template <class T, class A>
xsimd::batch<T, A> larger(xsimd::batch<T, A> a, xsimd::batch<T, A> b) {
  return xsimd::select(a < b, b, a);
}
template <class T, class A>
xsimd::batch<T, A> magnitude(xsimd::batch<T, A> a) {
  return xsimd::abs(a);
}

template <class T, class Arch, class F>
inline int run_batches(int k, int end, F& formula) {
  using V = xsimd::batch<T, Arch>;
  constexpr int width = int(V::size);
  for (; k + width <= end; k += width) formula(Lane<V>{}, V{}, k);
  return k;
}

/// formula(lane, zero of the lane type, k) for k in [begin, end), several k at a time.
template <class T, class F>
inline void for_lanes(int begin, int end, F&& formula) {
  int k = begin;
#if DRUMHEAD_ISA_LEVEL >= 3
  k = run_batches<T, xsimd::avx512bw>(k, end, formula);
#endif
#if DRUMHEAD_ISA_LEVEL >= 2
  k = run_batches<T, xsimd::avx2>(k, end, formula);
#endif
#if DRUMHEAD_ISA_LEVEL >= 1
  k = run_batches<T, xsimd::sse2>(k, end, formula);
#endif
  for (; k < end; ++k) formula(Lane<T>{}, T{}, k);
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
