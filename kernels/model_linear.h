// SPDX-License-Identifier: MIT
#pragma once
// Linear elasticity: Ψ = mu (a′² + rb²) + la a′², a′ = a₁ − √2. Any F; the Hessian is constant.
// Turning a state stores energy from the second order of the angle on.
#include "moduli.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

struct Linear {
  static constexpr bool kKeepsAxis = true;

  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B a1, B rb) {
    const B two(T(2)), stretch = a1 - B(T(kRootTwo));
    const B stiffness = two * (c.mu + c.kappa);
    Moduli<B> m;
    m.shape = c.mu * (stretch * stretch + rb * rb);
    m.volume = c.kappa * (stretch * stretch);
    m.a = stiffness * stretch;
    m.b = two * c.mu * rb;
    m.aa = stiffness;
    m.bb = m.flip = two * c.mu;
    m.ab = m.twist = B(T(0));
    return m;
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
