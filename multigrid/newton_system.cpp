// SPDX-License-Identifier: MIT
#include "newton_system.h"

#include <cmath>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {

template <class T>
NewtonSystem<T>::NewtonSystem(Hierarchy<T>& hierarchy, int top, bool pressure,
                              grid::MemoryMeter& meter, Rows rows)
    : hierarchy_(hierarchy), top_(top), pressure_(pressure), meter_(meter) {
  if (!level().conforming || rows == Rows::levels) return;
  special_ = level().conforming->rows;
  special_->linearise(membrane());
}

template <class T>
kernels::Membrane<T> NewtonSystem<T>::membrane() const {
  kernels::Membrane<T> m = pressure_ ? level().membrane() : level().harmonic();
  m.pressure_jump = T(0);  // for levels below the one that is solved
  if (special_) m.special = &*special_;
  return m;
}

template <class T>
kernels::Cuts<T> NewtonSystem<T>::cuts() const {
  return level().cuts.view(T(hierarchy_.traits().jump));
}

template <class T>
kernels::Unknowns<T> NewtonSystem<T>::correction() const {
  kernels::Unknowns<T> d = level().d.view();
  if (!pressure_) d.p = {};
  return d;
}

template <class T>
Vector<T> NewtonSystem<T>::make_vector() const {
  Vector<T> vector{
      grid::UnknownFields<T>(level().nx, level().ny, pressure_ && level().pressure, meter_),
      std::vector<T>(level().q.size(), T(0))};
  if (pressure_) vector.fields.listed.assign(level().d.listed.size(), T(0));
  vector.fields.curve.assign(level().d.curve.size(), T(0));
  return vector;
}

template <class T>
Vector<T> NewtonSystem<T>::right_hand_side() const {
  Vector<T> f = make_vector();
  kernels::Unknowns<const T> from = level().f.view();
  if (!pressure_) from.p = {};
  kernels::combine<T>(T(1), from, T(0), f.fields.view());
  f.q = level().fq;
  return f;
}

template <class T>
void NewtonSystem<T>::set_correction(const Vector<T>& x) const {
  kernels::combine<T>(T(1), x.fields.view(), T(0), correction());
  level().dq = x.q;
}

template <class T>
void NewtonSystem<T>::apply(const Vector<T>& d, Vector<T>& out) const {
  kernels::apply_hessian<T>(membrane(), d.fields.view(), out.fields.view());
  kernels::add_curve_force<T>(cuts(), d.q.data(), T(-1), out.fields.view());
  kernels::apply_cuts<T>(cuts(), d.fields.view(), d.q.data(), out.q.data());
}

template <class T>
void NewtonSystem<T>::residual(const Vector<T>& f, const Vector<T>& d, Vector<T>& r) const {
  apply(d, r);
  combine(1.0, f, -1.0, r);
}

template <class T>
void NewtonSystem<T>::combine(double a, const Vector<T>& x, double b, Vector<T>& y) const {
  kernels::combine<T>(T(a), x.fields.view(), T(b), y.fields.view());
  for (std::size_t k = 0; k < x.q.size(); ++k)
    y.q[k] = T(a) * x.q[k] + (b == 0.0 ? T(0) : T(b) * y.q[k]);
}

template <class T>
double NewtonSystem<T>::dot(const Vector<T>& a, const Vector<T>& b, double volume_weight) const {
  const auto av = a.fields.view(), bv = b.fields.view();
  double sum = kernels::dot<T>(av.x, bv.x) + kernels::dot<T>(av.y, bv.y) +
               kernels::dot_curve<T>(av, bv) +
               volume_weight * (kernels::dot<T>(av.p, bv.p) + kernels::dot_listed<T>(av, bv));
  for (std::size_t k = 0; k < a.q.size(); ++k) sum += double(a.q[k]) * double(b.q[k]);
  return sum;
}

template <class T>
double NewtonSystem<T>::dot(const Vector<T>& a, const Vector<T>& b) const {
  return dot(a, b, 1.0);
}

template <class T>
double NewtonSystem<T>::product_of_residuals(const Vector<T>& a, const Vector<T>& b) const {
  return dot(a, b, 1.0 / double(level().spacing * level().spacing));
}

template <class T>
double NewtonSystem<T>::norm(const Vector<T>& r) const {
  return std::sqrt(product_of_residuals(r, r));
}

template class NewtonSystem<float>;
template class NewtonSystem<double>;

}  // namespace drumhead::multigrid
