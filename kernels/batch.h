// SPDX-License-Identifier: MIT
#pragma once
// The one place that knows xsimd. A kernel's formula is a generic lambda over a lane type: whole
// batches first, then the row's remainder as one batch of which only the first lanes read and write
// (SSE2 and scalar: single numbers). Narrower batches for the remainder were tried: on a 128²
// lattice, whose half rows are four batches of AVX-512, a relaxation took 1.28 times as long. Every
// operation is element-wise and never contracted: all widths agree bit for bit. The row kernels are
// [[gnu::flatten]]: the compiler takes a formula of this size for too large to inline and would
// pass batches through memory (a relaxation took 1.26 times as long).
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

inline float square_root(float a) { return std::sqrt(a); }
inline double square_root(double a) { return std::sqrt(a); }
/// a < b ? x : y; both are computed.
inline float if_less(float a, float b, float x, float y) { return a < b ? x : y; }
inline double if_less(double a, double b, double x, double y) { return a < b ? x : y; }
inline float smaller(float a, float b) { return b < a ? b : a; }
inline float larger(float a, float b) { return a < b ? b : a; }
inline double smaller(double a, double b) { return b < a ? b : a; }
inline double larger(double a, double b) { return a < b ? b : a; }
template <class T, class A>
xsimd::batch<T, A> smaller(xsimd::batch<T, A> a, xsimd::batch<T, A> b) {
  return xsimd::min(b, a);
}
template <class T, class A>
xsimd::batch<T, A> larger(xsimd::batch<T, A> a, xsimd::batch<T, A> b) {
  return xsimd::max(b, a);
}

template <class T, class A>
xsimd::batch<T, A> square_root(xsimd::batch<T, A> a) {
  return xsimd::sqrt(a);
}
template <class T, class A>
xsimd::batch<T, A> if_less(xsimd::batch<T, A> a, xsimd::batch<T, A> b, xsimd::batch<T, A> x,
                           xsimd::batch<T, A> y) {
  return xsimd::select(a < b, x, y);
}

#if DRUMHEAD_ISA_LEVEL >= 3
/// The first `count` lanes of a batch; the others read nothing, hold 0 and write nothing.
template <class T>
struct Tail;
template <>
struct Tail<float> {
  using V = xsimd::batch<float, xsimd::avx512bw>;
  __mmask16 lanes;
  explicit Tail(int count) : lanes(__mmask16((1u << count) - 1u)) {}
  V load(const float* at) const { return V(_mm512_maskz_loadu_ps(lanes, at)); }
  void store(V value, float* at) const { _mm512_mask_storeu_ps(at, lanes, value); }
};
template <>
struct Tail<double> {
  using V = xsimd::batch<double, xsimd::avx512bw>;
  __mmask8 lanes;
  explicit Tail(int count) : lanes(__mmask8((1u << count) - 1u)) {}
  V load(const double* at) const { return V(_mm512_maskz_loadu_pd(lanes, at)); }
  void store(V value, double* at) const { _mm512_mask_storeu_pd(at, lanes, value); }
};
#elif DRUMHEAD_ISA_LEVEL == 2
/// The first `count` lanes of a batch; the others read nothing, hold 0 and write nothing. Stores go
/// in halves: AVX2's masked store takes some forty cycles on Zen 4.
template <class T>
struct Tail;
inline __m256i first_bytes(int count) {
  static constexpr int ones[16] = {-1, -1, -1, -1, -1, -1, -1, -1};
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(ones + 8 - count / 4));
}
template <>
struct Tail<float> {
  using V = xsimd::batch<float, xsimd::avx2>;
  int count;
  __m256i lanes = first_bytes(4 * count);
  V load(const float* at) const { return V(_mm256_maskload_ps(at, lanes)); }
  void store(V value, float* at) const {
    __m128 rest = _mm256_castps256_ps128(value);
    if (count & 4) {
      _mm_storeu_ps(at, rest);
      rest = _mm256_extractf128_ps(value, 1);
      at += 4;
    }
    if (count & 2) {
      _mm_storel_pi(reinterpret_cast<__m64*>(at), rest);
      rest = _mm_movehl_ps(rest, rest);
      at += 2;
    }
    if (count & 1) _mm_store_ss(at, rest);
  }
};
template <>
struct Tail<double> {
  using V = xsimd::batch<double, xsimd::avx2>;
  int count;
  __m256i lanes = first_bytes(8 * count);
  V load(const double* at) const { return V(_mm256_maskload_pd(at, lanes)); }
  void store(V value, double* at) const {
    __m128d rest = _mm256_castpd256_pd128(value);
    if (count & 2) {
      _mm_storeu_pd(at, rest);
      rest = _mm256_extractf128_pd(value, 1);
      at += 2;
    }
    if (count & 1) _mm_store_sd(at, rest);
  }
};
#endif

/// formula(lane, zero of the lane type, k) for k in [begin, end), several k at a time.
template <class T, class F>
inline void for_lanes(int begin, int end, F&& formula) {
  int k = begin;
#if DRUMHEAD_ISA_LEVEL >= 2
  using V = typename Tail<T>::V;
  constexpr int width = int(V::size);
  for (; k + width <= end; k += width) formula(Lane<V>{}, V(T(0)), k);
  if (k < end) formula(Tail<T>{end - k}, V(T(0)), k);
#else
#if DRUMHEAD_ISA_LEVEL == 1
  using V = xsimd::batch<T, xsimd::sse2>;
  constexpr int width = int(V::size);
  for (; k + width <= end; k += width) formula(Lane<V>{}, V(T(0)), k);
#endif
  for (; k < end; ++k) formula(Lane<T>{}, T(0), k);
#endif
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
