// SPDX-License-Identifier: MIT
#pragma once
// St. Venant–Kirchhoff: Ψ = mu/4 (I² − 2J² − 2I + 2) + la/8 (I−2)², I = |F|². Any F; it has no
// resistance to collapse: Ψ falls again below a stretch of 1/√3, and F and its mirror image store
// the same.
#include "moduli.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

struct Stvk {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const B half(T(0.5)), quarter(T(0.25)), two(T(2)), zero(T(0));
    const B aa = ra * ra, bb = rb * rb, I = aa + bb, J = half * (aa - bb);
    // I² − 2J² − 2I + 2 = ½ (I − 2)² + 2 (ra rb)², which keeps the digits of small strains.
    const B excess = I - two;
    InvariantDerivatives<B> psi;
    psi.shape = c.mu * (quarter * half * excess * excess + half * aa * bb);
    psi.volume = quarter * half * c.kappa * excess * excess;
    psi.I = half * c.mu * (I - B(T(1))) + quarter * c.kappa * excess;
    psi.J = zero - c.mu * J;
    psi.II = half * c.mu + quarter * c.kappa;
    psi.IJ = zero;
    psi.JJ = zero - c.mu;
    return moduli<T>(psi, ra, rb);
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
