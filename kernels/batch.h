// SPDX-License-Identifier: MIT
#pragma once
// The one place that knows xsimd. A kernel's formula is a generic lambda over a lane type: whole
// batches first, then the row's remainder as one batch of which only the first lanes read and write
// (SSE2 and scalar: single numbers). Narrower batches for the remainder were tried: on a 128²
// lattice, whose half rows are four batches of AVX-512, a relaxation took 1.28 times as long. Every
// operation is element-wise and never contracted: all widths agree bit for bit. The row kernels are
// [[gnu::flatten]]: the compiler takes a formula of this size for too large to inline and would
// pass batches through memory (a relaxation took 1.26 times as long).
#include <array>
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
/// The last lane of `before`, then all but the last of `now`.
inline Tail<float>::V shifted(Tail<float>::V before, Tail<float>::V now) {
  return _mm512_castsi512_ps(
      _mm512_alignr_epi32(_mm512_castps_si512(now), _mm512_castps_si512(before), 15));
}
inline Tail<double>::V shifted(Tail<double>::V before, Tail<double>::V now) {
  return _mm512_castsi512_pd(
      _mm512_alignr_epi64(_mm512_castpd_si512(now), _mm512_castpd_si512(before), 7));
}
/// All but the first lane of `now`, then the first of `after`.
inline Tail<float>::V shifted_back(Tail<float>::V now, Tail<float>::V after) {
  return _mm512_castsi512_ps(
      _mm512_alignr_epi32(_mm512_castps_si512(after), _mm512_castps_si512(now), 1));
}
inline Tail<double>::V shifted_back(Tail<double>::V now, Tail<double>::V after) {
  return _mm512_castsi512_pd(
      _mm512_alignr_epi64(_mm512_castpd_si512(after), _mm512_castpd_si512(now), 1));
}
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
    if (count == 8) return _mm256_storeu_ps(at, value);
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
    if (count == 4) return _mm256_storeu_pd(at, value);
    __m128d rest = _mm256_castpd256_pd128(value);
    if (count & 2) {
      _mm_storeu_pd(at, rest);
      rest = _mm256_extractf128_pd(value, 1);
      at += 2;
    }
    if (count & 1) _mm_store_sd(at, rest);
  }
};
/// The last lane of `before`, then all but the last of `now`.
inline Tail<float>::V shifted(Tail<float>::V before, Tail<float>::V now) {
  const __m256 between = _mm256_permute2f128_ps(before, now, 0x21);
  return _mm256_castsi256_ps(
      _mm256_alignr_epi8(_mm256_castps_si256(now), _mm256_castps_si256(between), 12));
}
inline Tail<double>::V shifted(Tail<double>::V before, Tail<double>::V now) {
  return _mm256_shuffle_pd(_mm256_permute2f128_pd(before, now, 0x21), now, 0x5);
}
/// All but the first lane of `now`, then the first of `after`.
inline Tail<float>::V shifted_back(Tail<float>::V now, Tail<float>::V after) {
  const __m256 between = _mm256_permute2f128_ps(now, after, 0x21);
  return _mm256_castsi256_ps(
      _mm256_alignr_epi8(_mm256_castps_si256(between), _mm256_castps_si256(now), 4));
}
inline Tail<double>::V shifted_back(Tail<double>::V now, Tail<double>::V after) {
  return _mm256_shuffle_pd(now, _mm256_permute2f128_pd(now, after, 0x21), 0x5);
}
#elif DRUMHEAD_ISA_LEVEL == 1
/// The last lane of `before`, then all but the last of `now`.
inline xsimd::batch<float, xsimd::sse2> shifted(xsimd::batch<float, xsimd::sse2> before,
                                                xsimd::batch<float, xsimd::sse2> now) {
  const __m128 between = _mm_shuffle_ps(before, now, _MM_SHUFFLE(0, 0, 3, 3));
  return _mm_shuffle_ps(between, now, _MM_SHUFFLE(2, 1, 2, 0));
}
inline xsimd::batch<double, xsimd::sse2> shifted(xsimd::batch<double, xsimd::sse2> before,
                                                 xsimd::batch<double, xsimd::sse2> now) {
  return _mm_shuffle_pd(before, now, 1);
}
/// All but the first lane of `now`, then the first of `after`.
inline xsimd::batch<float, xsimd::sse2> shifted_back(xsimd::batch<float, xsimd::sse2> now,
                                                     xsimd::batch<float, xsimd::sse2> after) {
  const __m128 between = _mm_shuffle_ps(now, after, _MM_SHUFFLE(0, 0, 3, 3));
  return _mm_shuffle_ps(now, between, _MM_SHUFFLE(2, 0, 2, 1));
}
inline xsimd::batch<double, xsimd::sse2> shifted_back(xsimd::batch<double, xsimd::sse2> now,
                                                      xsimd::batch<double, xsimd::sse2> after) {
  return _mm_shuffle_pd(now, after, 1);
}
inline float last_lane(xsimd::batch<float, xsimd::sse2> a) { return a.get(3); }
inline double last_lane(xsimd::batch<double, xsimd::sse2> a) { return a.get(1); }
#endif
inline float shifted(float before, float) { return before; }
inline double shifted(double before, double) { return before; }
inline float shifted_back(float, float after) { return after; }
inline double shifted_back(double, double after) { return after; }

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

#if DRUMHEAD_ISA_LEVEL < 2
/// A lane that reads 0 and writes nothing.
template <class T>
struct NoLane {
  static T load(const T*) { return T(0); }
  static void store(T, T*) {}
};
#endif

/// formula(even lane, odd lane, zero, k, carried) for the columns 2k < 2·even and 2k + 1 of a row,
/// both at a time; the last batch may have one odd column less (even − odd is 0 or 1). `carried`
/// are N values that one call leaves to the next.
template <int N, class T, class F>
inline void for_lane_pairs(int even, int odd, F&& formula) {
  int k = 0;
#if DRUMHEAD_ISA_LEVEL >= 2
  using V = typename Tail<T>::V;
  constexpr int width = int(V::size);
  std::array<V, N> carried;
  carried.fill(V(T(0)));
  for (; k + width <= odd; k += width) formula(Lane<V>{}, Lane<V>{}, V(T(0)), k, carried);
  if (k < even) formula(Tail<T>{even - k}, Tail<T>{odd - k}, V(T(0)), k, carried);
#else
  std::array<T, N> last{};
#if DRUMHEAD_ISA_LEVEL == 1
  using V = xsimd::batch<T, xsimd::sse2>;
  constexpr int width = int(V::size);
  std::array<V, N> carried;
  carried.fill(V(T(0)));
  for (; k + width <= odd; k += width) formula(Lane<V>{}, Lane<V>{}, V(T(0)), k, carried);
  for (int n = 0; n < N; ++n) last[n] = last_lane(carried[n]);
#endif
  for (; k < odd; ++k) formula(Lane<T>{}, Lane<T>{}, T(0), k, last);
  if (k < even) formula(Lane<T>{}, NoLane<T>{}, T(0), k, last);
#endif
}

/// The same from the last columns to the first.
template <int N, class T, class F>
inline void for_lane_pairs_westwards(int even, int odd, F&& formula) {
#if DRUMHEAD_ISA_LEVEL >= 2
  using V = typename Tail<T>::V;
  constexpr int width = int(V::size);
  std::array<V, N> carried;
  carried.fill(V(T(0)));
  int k = (even - 1) / width * width;
  if (k + width > odd) {
    formula(Tail<T>{even - k}, Tail<T>{odd - k}, V(T(0)), k, carried);
    k -= width;
  }
  for (; k >= 0; k -= width) formula(Lane<V>{}, Lane<V>{}, V(T(0)), k, carried);
#else
  std::array<T, N> first{};
  if (even > odd) formula(Lane<T>{}, NoLane<T>{}, T(0), odd, first);
  int k = odd - 1;
#if DRUMHEAD_ISA_LEVEL == 1
  using V = xsimd::batch<T, xsimd::sse2>;
  constexpr int width = int(V::size);
  for (; (k + 1) % width != 0; --k) formula(Lane<T>{}, Lane<T>{}, T(0), k, first);
  std::array<V, N> carried;
  for (int n = 0; n < N; ++n) carried[n] = V(first[n]);
  for (k -= width - 1; k >= 0; k -= width) formula(Lane<V>{}, Lane<V>{}, V(T(0)), k, carried);
#else
  for (; k >= 0; --k) formula(Lane<T>{}, Lane<T>{}, T(0), k, first);
#endif
#endif
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
