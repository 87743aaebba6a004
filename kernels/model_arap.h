// SPDX-License-Identifier: MIT
#pragma once
// As rigid as possible with a one-sided resistance to collapse (Setaluri et al. 2014, Eq. 8):
//   Ψ = mu/2 [(ra−√2)² + rb²]  at the Gauss points,
//   Ψ = kappa/2 min(0, J − eps + s)²  at the corners, where J is least: J is linear in the cell.
// With s = p/c and kappa c/(kappa + c) in place of kappa this is the step of the method of
// multipliers that starts from corner pressures p ≤ 0; its fixed point p = kappa min(0, J − eps)
// solves Eq. 8 with the kappa that was asked for, while no Hessian sees more than c. Any F.
#include "moduli.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

// In float, J is known no better.
constexpr double kLeastOnset = 1e-6;

/// ½ min(0, z)² with its slope's corner at 0 rounded off from −w to w, and its derivatives: all
/// continuous, 0 above w, and from −w down those of the square. Newton's method goes to and fro
/// between corners that act and that do not where the slope has a corner (ML at 48², kappa 1e4: 99
/// steps; 27 on the way from w = .5 to .02).
template <class T, class B>
struct OneSidedSquare {
  B value, slope, curvature;
  OneSidedSquare(B z, B w) {
    const B zero(T(0)), half(T(0.5)), inverse = half / w;
    const B y = larger(zero, smaller(w - z, w + w)), beyond = larger(zero, zero - w - z);
    const B bend = half * inverse * y * y;
    value = B(T(1.0 / 3.0)) * bend * y + beyond * (w + half * beyond);
    slope = zero - (bend + beyond);
    curvature = inverse * y;
  }
};

struct OneSided {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const OneSidedSquare<T, B> square(B(T(0.5)) * (ra * ra - rb * rb) - c.eps + c.shift, c.onset);
    return moduli_of_volume<T>(c.corner * square.value, c.corner * square.slope,
                               c.corner * square.curvature, ra, rb);
  }
};

struct Arap {
  using Corner = OneSided;

  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const B half(T(0.5)), stretch = ra - B(T(kRootTwo));
    Moduli<B> m;
    m.shape = half * c.mu * (stretch * stretch + rb * rb);
    m.volume = m.ab = B(T(0));
    m.a = c.mu * stretch;
    m.b = c.mu * rb;
    m.aa = m.bb = m.flip = c.mu;
    m.twist = m.a / larger(ra, B(T(kSmallest)));
    return m;
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
