// SPDX-License-Identifier: MIT
#pragma once
// F in the coordinates in which isotropic densities are written (model.h): a = (F11 + F22,
// F21 − F12)/√2, b = (F11 − F22, F21 + F12)/√2.
#include "batch.h"
#include "moduli.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// (a, b) of a matrix of F's shape, times √2.
template <class B>
struct Split {
  B a1, a2, b1, b2;
  Split(B f11, B f21, B f12, B f22) : a1(f11 + f22), a2(f21 - f12), b1(f11 - f22), b2(f21 + f12) {}
};

/// F at a point as lengths and unit directions of a and b. Where a length is 0, its direction is
/// (1, 0).
template <class T, class Density, class B>
struct Polar {
  B ra, rb, a1, a2, b1, b2;
  explicit Polar(const Split<B>& f) {
    const B root = B(T(0.5 * kRootTwo)), small = B(T(kSmallest)), one = B(T(1)), zero = B(T(0));
    const auto split = [&](B x, B y, B& length, B& cosine, B& sine) {
      x = root * x;
      y = root * y;
      length = square_root(x * x + y * y);
      const B inverse = one / larger(length, small);
      cosine = if_less(length, small, one, x * inverse);
      sine = if_less(length, small, zero, y * inverse);
    };
    split(f.b1, f.b2, rb, b1, b2);
    if constexpr (requires { Density::kKeepsAxis; }) {
      ra = root * f.a1;
      a1 = one;
      a2 = zero;
    } else {
      split(f.a1, f.a2, ra, a1, a2);
    }
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
