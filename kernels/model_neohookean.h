// SPDX-License-Identifier: MIT
#pragma once
// Neo-Hookean: Ψ = mu/2 (I−2) − mu ln J + la/2 ln² J, I = |F|², for J > 0. Below J = eps the
// logarithm goes on as its second-order expansion there, so that a folded start has a finite energy
// and is pushed out of its fold; the solver lowers eps until no J of its solution is below it.
#include "moduli.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// ln x for x from 2^-60 to 2^60, to about an ulp, from operations that round alike everywhere.
template <class T, class B>
B natural_log(B x) {
  // x = m 2^e with m in [1/√2, √2)
  B e(T(0));
  for (int k = 32; k >= 1; k /= 2) {
    const T power = T(std::ptrdiff_t(1) << k);
    const B high(power / T(kRootTwo)), low(T(kRootTwo) / power);
    const B up = if_less(x, high, e, e + B(T(k)));
    x = if_less(x, high, x, x * B(T(1) / power));
    e = if_less(x, low, up - B(T(k)), up);
    x = if_less(x, low, x * B(power), x);
  }
  const B s = (x - B(T(1))) / (x + B(T(1))), z = s * s;
  B sum(T(1) / T(21));
  for (int k = 19; k >= 1; k -= 2) sum = sum * z + B(T(1) / T(k));
  return e * B(T(0.69314718055994530942)) + B(T(2)) * s * sum;
}

struct NeoHookean {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const B half(T(0.5)), one(T(1)), zero(T(0));
    const B aa = ra * ra, bb = rb * rb, J = half * (aa - bb);
    const B inside = larger(J, c.eps), below = J - inside;
    const B inverse = one / inside, x = below * inverse;
    const B log = natural_log<T>(inside) + x - half * x * x;
    const B log1 = inverse * (one - x);
    const B log2 = zero - inverse * inverse;
    const B push = c.kappa * log - c.mu;
    InvariantDerivatives<B> psi;
    psi.shape = half * c.mu * (aa + bb - B(T(2))) - c.mu * log;
    psi.volume = half * c.kappa * log * log;
    psi.I = half * c.mu;
    psi.J = push * log1;
    psi.II = psi.IJ = zero;
    psi.JJ = c.kappa * log1 * log1 + push * log2;
    return moduli<T>(psi, ra, rb);
  }
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
