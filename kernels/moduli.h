// SPDX-License-Identifier: MIT
#pragma once
// What a membrane's file gives at one F: energy density and derivatives by (ra, rb) of model.h.
// With â = a/ra and b̂ = b/rb, the gradient is (Ψa â, Ψb b̂), and the Hessian is the 2×2 block (Ψaa,
// Ψab, Ψbb) on (â, b̂), the twist Ψa/ra on a⊥ and the flip Ψb/rb on b⊥.
#include "batch.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

constexpr double kRootTwo = 1.41421356237309504880;
// Lengths below this are taken as it in divisors; its square is a normal float.
constexpr double kSmallest = 1e-18;

/// mu, kappa (λ) and eps of a membrane, and stiffness, shift and onset of its corners' term.
template <class B>
struct Parameters {
  B mu, kappa, eps, corner, shift, onset;
};

template <class B>
struct Moduli {
  B shape, volume;  ///< Ψ = the part with mu + the part with kappa
  B a, b;           ///< Ψa, Ψb
  B aa, ab, bb, twist, flip;
};

/// Derivatives by I = |F|² and J.
template <class B>
struct InvariantDerivatives {
  B shape, volume, I, J, II, IJ, JJ;
};

/// twist = 2Ψ_I + Ψ_J, flip = 2Ψ_I − Ψ_J, and the block by the chain rule.
template <class T, class B>
Moduli<B> moduli(const InvariantDerivatives<B>& psi, B ra, B rb) {
  const B two(T(2)), four(T(4));
  Moduli<B> m;
  m.shape = psi.shape;
  m.volume = psi.volume;
  m.twist = two * psi.I + psi.J;
  m.flip = two * psi.I - psi.J;
  m.a = m.twist * ra;
  m.b = m.flip * rb;
  const B even = four * psi.II + psi.JJ, odd = four * psi.IJ;
  m.aa = m.twist + ra * ra * (even + odd);
  m.bb = m.flip + rb * rb * (even - odd);
  m.ab = ra * rb * (four * psi.II - psi.JJ);
  return m;
}

/// Those of a density of J = (ra² − rb²)/2 alone, with its value and derivatives Ψ_J, Ψ_JJ.
template <class T, class B>
Moduli<B> moduli_of_volume(B value, B first, B second, B ra, B rb) {
  const B zero(T(0));
  Moduli<B> m;
  m.shape = zero;
  m.volume = value;
  m.a = first * ra;
  m.b = zero - first * rb;
  m.twist = first;
  m.flip = zero - first;
  m.aa = m.twist + second * ra * ra;
  m.bb = m.flip + second * rb * rb;
  m.ab = zero - second * ra * rb;
  return m;
}

/// The Hessian's eigenvalues are raised to at least `floor`: those of the 2×2 block, twist and
/// flip.
template <class T, class B>
void raise_eigenvalues(Moduli<B>& m, B floor) {
  const B half(T(0.5));
  const B mean = half * (m.aa + m.bb), delta = half * (m.aa - m.bb);
  const B radius = square_root(delta * delta + m.ab * m.ab);
  const B high = larger(mean + radius, floor), low = larger(mean - radius, floor);
  const B centre = half * (high + low);
  const B scale = half * (high - low) / larger(radius, B(T(kSmallest)));
  m.aa = centre + scale * delta;
  m.bb = centre - scale * delta;
  m.ab = scale * m.ab;
  m.twist = larger(m.twist, floor);
  m.flip = larger(m.flip, floor);
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
