// SPDX-License-Identifier: MIT
#pragma once
// A membrane's density at single points: the triangles of special cells and what is around them.
#include "isotropic_body.h"
#include "isotropic_table.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

template <class T>
Split<T> split_of(const PointState<T>& at) {
  return {at.f11, at.f21, at.f12, at.f22};
}
template <class T>
Parameters<T> parameters_of(const PointState<T>& at) {
  return {at.mu, at.kappa, at.eps, at.kappa, at.shift, larger(at.onset, T(kLeastOnset))};
}

template <class Density, class T>
PointStress<T> point_stress(const PointState<T>& at) {
  const Polar<T, Density, T> p(split_of(at));
  const Moduli<T> psi = Density::template at<T>(parameters_of(at), p.ra, p.rb);
  const T root = T(0.5 * kRootTwo), a = root * psi.a, b = root * psi.b;
  return {psi.shape,           psi.volume,          a * p.a1 + b * p.b1,
          a * p.a2 + b * p.b2, b * p.b2 - a * p.a2, a * p.a1 - b * p.b1};
}

template <class Density, class T>
void point_tangent(const PointState<T>& at, T mu, T width, T* entries) {
  Parameters<T> cell = parameters_of(at);
  cell.mu = mu;
  const LeastEigenvalue<T> least{least_eigenvalue<T, Density>(cell, width)};
  Tangent<T, T>(Density{}, split_of(at), parameters_of(at), least).entries(entries);
}

/// Of the one-sided term: kappa min(0, J − eps + shift), its corner rounded off.
template <class T>
T point_pressure(const PointState<T>& at) {
  const Parameters<T> c = parameters_of(at);
  const OneSidedSquare<T, T> square((at.f11 * at.f22 - at.f12 * at.f21) - c.eps + c.shift, c.onset);
  return c.corner * square.slope;
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
