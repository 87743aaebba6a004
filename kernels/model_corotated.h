// SPDX-License-Identifier: MIT
#pragma once
// Corotated linear elasticity: Ψ = mu [(ra−√2)² + rb²] + la (ra−√2)². Any F. At ra = 0, where the
// rotation is not defined, it is taken to be the identity.
#include "moduli.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

struct Corotated {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const B two(T(2)), stretch = ra - B(T(kRootTwo));
    const B stiffness = two * (c.mu + c.kappa);
    Moduli<B> m;
    m.shape = c.mu * (stretch * stretch + rb * rb);
    m.volume = c.kappa * (stretch * stretch);
    m.a = stiffness * stretch;
    m.b = two * c.mu * rb;
    m.aa = stiffness;
    m.bb = m.flip = two * c.mu;
    m.ab = B(T(0));
    m.twist = m.a / larger(ra, B(T(kSmallest)));
    return m;
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
