// SPDX-License-Identifier: MIT
#include "coarse_solver.h"

#include <Eigen/Dense>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>

namespace drumhead::multigrid {
namespace {

/// Visits every unknown of a level in a fixed order: x and y of interior and curve nodes, pressures
/// of cells and of the parts of special cells, curve forces.
template <class T, class F>
void for_unknowns(const kernels::Unknowns<T>& fields, T* q, std::size_t cuts, std::size_t parts,
                  bool pressure, F&& f) {
  for (int j = 1; j + 1 < fields.x.rows; ++j)
    for (int i = 1; i + 1 < fields.x.columns; ++i) {
      f(fields.x.at(i, j));
      f(fields.y.at(i, j));
    }
  for (int k = 0; k < fields.curve_count; ++k) f(fields.curve[k]);
  if (pressure)
    for (int j = 0; j < fields.p.rows; ++j)
      for (int i = 0; i < fields.p.columns; ++i) f(fields.p.at(i, j));
  for (std::size_t k = 0; k < parts && pressure; ++k) f(fields.listed[k]);
  for (std::size_t k = 0; k < 2 * cuts; ++k) f(q[k]);
}

}  // namespace

template <class T>
struct CoarseSolver<T>::Factors {
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Eigen::VectorXd scale;  // of rows and columns: equal norms
  Eigen::VectorXd right, solution;
  bool pressure = false;
};

template <class T>
CoarseSolver<T>::CoarseSolver() : factors_(std::make_unique<Factors>()) {}
template <class T>
CoarseSolver<T>::~CoarseSolver() = default;
template <class T>
CoarseSolver<T>::CoarseSolver(CoarseSolver&&) noexcept = default;
template <class T>
CoarseSolver<T>& CoarseSolver<T>::operator=(CoarseSolver&&) noexcept = default;

template <class T>
void CoarseSolver<T>::factorise(Level<T>& level, bool pressure, T jump) {
  const std::size_t cuts = std::size_t(level.cuts.size());
  const kernels::Cuts<T> rows = level.cuts.view(jump);
  kernels::Membrane<T> membrane = pressure ? level.membrane() : level.harmonic();
  kernels::Unknowns<T> d = level.d.view(), f = level.f.view();
  if (!pressure) d.p = f.p = {};
  const std::size_t parts = level.d.listed.size();
  for_unknowns(d, level.dq.data(), cuts, parts, pressure, [](T& value) { value = T(0); });
  std::vector<T> curve(2 * cuts);
  std::vector<T*> unknowns;
  for_unknowns(d, level.dq.data(), cuts, parts, pressure,
               [&](T& value) { unknowns.push_back(&value); });
  const Eigen::Index n = Eigen::Index(unknowns.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index column = 0; column < n; ++column) {
    *unknowns[std::size_t(column)] = T(1);
    const bool of_curve = column >= n - Eigen::Index(2 * cuts);
    if (!of_curve) kernels::apply_hessian<T>(membrane, d, f);
    if (of_curve) for_unknowns(f, curve.data(), 0, parts, pressure, [](T& value) { value = T(0); });
    kernels::add_curve_force<T>(rows, level.dq.data(), T(-1), f);
    kernels::apply_cuts<T>(rows, d, level.dq.data(), curve.data());
    Eigen::Index row = 0;
    for_unknowns(f, curve.data(), cuts, parts, pressure,
                 [&](const T& value) { matrix(row++, column) = double(value); });
    *unknowns[std::size_t(column)] = T(0);
  }
  factors_->pressure = pressure;
  factors_->scale = matrix.cwiseAbs().rowwise().maxCoeff();
  // Known nodes and the plane's pressures at special cells have no equation: they stay 0.
  for (Eigen::Index k = 0; k < n; ++k)
    if (factors_->scale[k] == 0.0) matrix(k, k) = factors_->scale[k] = 1.0;
  for (double& s : factors_->scale) s = s > 0.0 ? 1.0 / std::sqrt(s) : 1.0;
  matrix = factors_->scale.asDiagonal() * matrix * factors_->scale.asDiagonal();
  // Null modes (a constant pressure where 1/kappa = 0, dependent curve rows) get a small finite
  // answer.
  const Eigen::Index volume =
      pressure && level.pressure ? Eigen::Index(level.nx) * level.ny + Eigen::Index(parts) : 0;
  const Eigen::Index first = n - Eigen::Index(2 * cuts) - volume;
  for (Eigen::Index k = first; k < n; ++k) matrix(k, k) -= 1e-7;
  factors_->lu.compute(matrix);
  factors_->right.resize(n);
  factors_->solution.resize(n);
}

template <class T>
void CoarseSolver<T>::solve(Level<T>& level) const {
  const std::size_t cuts = std::size_t(level.cuts.size());
  Eigen::VectorXd &b = factors_->right, &x = factors_->solution;
  Eigen::Index row = 0;
  const std::size_t parts = level.d.listed.size();
  for_unknowns(level.f.view(), level.fq.data(), cuts, parts, factors_->pressure,
               [&](const T& value) { b(row++) = double(value); });
  b.array() *= factors_->scale.array();
  x = factors_->lu.solve(b);
  x.array() *= factors_->scale.array();
  row = 0;
  for_unknowns(level.d.view(), level.dq.data(), cuts, parts, factors_->pressure,
               [&](T& value) { value = T(x(row++)); });
}

template class CoarseSolver<float>;
template class CoarseSolver<double>;

}  // namespace drumhead::multigrid
