// SPDX-License-Identifier: MIT
#pragma once
// Row sums and vector updates over whole fields.
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/views.h>

#include "batch.h"
#include "sums.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

template <class T>
[[gnu::flatten]] double dot_row(const Plane<const T>& a, const Plane<const T>& b, int j) {
  Sixteen sums;
  for (int parity = 0; parity < 2; ++parity)
    sums.add_products(a.half(j, parity), b.half(j, parity), half_count(a.columns, parity));
  return sums.total();
}

template <class T>
[[gnu::flatten]] double squares_over_row(const Plane<const T>& a, const Plane<const T>& b, int j) {
  Sixteen sums;
  for (int parity = 0; parity < 2; ++parity)
    sums.add_squares_over(a.half(j, parity), b.half(j, parity), half_count(a.columns, parity));
  return sums.total();
}

/// The bits of |a| as an integer are ordered like |a|, with every NaN beyond infinity: a maximum
/// that vectorises and keeps a NaN.
template <class T>
using SizeBits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
template <class T>
SizeBits<T> size_bits(T value) {
  return std::bit_cast<SizeBits<T>>(value) & (~SizeBits<T>(0) >> 1);
}

/// y += a x where x is finite, and what that moved.
template <class T>
[[gnu::flatten]] void move_row(T a, const Plane<const T>& x, const Plane<T>& y, Moved& moved,
                               int j) {
  const SizeBits<T> infinite = size_bits(std::numeric_limits<T>::infinity());
  SizeBits<T> most = 0, reach = 0;
  Sixteen squares;
  for (int parity = 0; parity < 2; ++parity) {
    const T* __restrict in = x.half(j, parity);
    T* __restrict out = y.half(j, parity);
    const int count = half_count(x.columns, parity);
    for (int k = 0; k < count; ++k) {
      const SizeBits<T> size = size_bits(in[k]);
      const T step = a * in[k], there = out[k] + (size < infinite ? step : T(0));
      out[k] = there;
      const SizeBits<T> far = size_bits(there);
      most = size > most ? size : most;
      reach = far > reach ? far : reach;
    }
    squares.add_products(in, in, count);
  }
  moved = {squares.total(), double(std::bit_cast<T>(most)), double(std::bit_cast<T>(reach))};
}

/// y = a x + b y; b = 0 does not read y.
template <class T>
[[gnu::flatten]] void combine_row(T a, const Plane<const T>& x, T b, const Plane<T>& y, int j) {
  for (int parity = 0; parity < 2; ++parity) {
    const T* in = x.half(j, parity);
    T* out = y.half(j, parity);
    const int count = half_count(x.columns, parity);
    if (b == T(0)) {
      for_lanes<T>(0, count, [&](auto lane, auto zero, int k) {
        lane.store(decltype(zero)(a) * lane.load(in + k), out + k);
      });
    } else {
      for_lanes<T>(0, count, [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        lane.store(B(a) * lane.load(in + k) + B(b) * lane.load(out + k), out + k);
      });
    }
  }
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
