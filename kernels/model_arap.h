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

struct OneSided {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const B zero(T(0)), half(T(0.5));
    const B lack = half * (ra * ra - rb * rb) - c.eps + c.shift;
    const B kappa = if_less(lack, zero, c.kappa, zero);
    const B pressure = kappa * lack;
    Moduli<B> m;
    m.shape = zero;
    m.volume = half * pressure * lack;
    m.a = pressure * ra;
    m.b = zero - pressure * rb;
    m.twist = pressure;
    m.flip = zero - pressure;
    m.aa = m.twist + kappa * ra * ra;
    m.bb = m.flip + kappa * rb * rb;
    m.ab = zero - kappa * ra * rb;
    return m;
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
