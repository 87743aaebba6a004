// SPDX-License-Identifier: MIT
#pragma once
// Row sums and vector updates over whole fields.
#include <bit>
#include <cstdint>
#include <type_traits>

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

/// The bits of |a| as an integer are ordered like |a|, with every NaN beyond infinity: a maximum
/// that vectorises and keeps a NaN.
template <class T>
[[gnu::flatten]] double largest_row(const Plane<const T>& a, int j) {
  using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
  Bits largest = 0;
  for (int parity = 0; parity < 2; ++parity) {
    const T* values = a.half(j, parity);
    for (int k = 0; k < half_count(a.columns, parity); ++k) {
      const Bits size = std::bit_cast<Bits>(values[k]) & (~Bits(0) >> 1);
      largest = size > largest ? size : largest;
    }
  }
  return double(std::bit_cast<T>(largest));
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
