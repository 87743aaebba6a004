// SPDX-License-Identifier: MIT
#pragma once
// The Compression-Resistant Poisson membrane without folds: that of elastic.h with averaged volume
// (Setaluri et al. 2014, Eq. 1, 6, 7), whose J at the centre of a cell says nothing of its corners,
// and the one-sided term of their Eq. 8 besides,
//   Ψ = mu/2 |F|² + w/2 min(0, J − eps + s)²  at the corners: the first part is Eq. 6,
//   Ψ = kappa/2 (J−1)²                        at the centre, with the weight of all four corners,
// with w, s, eps and an onset as in model_arap.h. In special cells (special_points.h) the first is
// taken in every triangle, the second at the mean F of every part. Any F.
#include "model_arap.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

// The centre's term may take from the Hessian what Eq. 6 gives it, which is mu, as in crpm: the
// corners' part is kept at least mu there.
struct FoldFreeCorner {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    Moduli<B> m = OneSided::at<T>(c, ra, rb);
    m.shape = B(T(0.5)) * c.mu * (ra * ra + rb * rb);
    m.a = m.a + c.mu * ra;
    m.b = m.b + c.mu * rb;
    m.aa = m.aa + c.mu;
    m.bb = m.bb + c.mu;
    m.twist = m.twist + c.mu;
    m.flip = m.flip + c.mu;
    return m;
  }
  template <class T, class B>
  static B floor(const Parameters<B>& c, B width) {
    return (B(T(2)) - width) * c.mu;
  }
};

struct FoldFreeCentre {
  template <class T, class B>
  static Moduli<B> at(const Parameters<B>& c, B ra, B rb) {
    const B half(T(0.5)), kappa = B(T(4)) * c.kappa;
    const B strain = half * (ra * ra - rb * rb) - B(T(1)), pressure = kappa * strain;
    return moduli_of_volume<T>(half * pressure * strain, pressure, kappa, ra, rb);
  }
  template <class T, class B>
  static B floor(const Parameters<B>& c, B width) {
    return B(T(-4)) * width * c.mu;
  }
};

struct FoldFree {
  using Corner = FoldFreeCorner;
  using Centre = FoldFreeCentre;
};

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
