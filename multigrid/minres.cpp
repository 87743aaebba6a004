// SPDX-License-Identifier: MIT
#include "minres.h"

#include <cmath>
#include <utility>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/kaczmarz.h>
#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {
namespace {

// Iterations that one cycle of `most_cycles` allows: about the same work.
constexpr int kPlainIterations = 20, kMultigridIterations = 5;
// The true residual is computed when the one that MINRES minimises has fallen by this much again.
constexpr double kLookAgain = 0.5;

/// out = weight·r, cell by cell.
template <class T>
void scale(const kernels::Plane<const T>& weight, const kernels::Plane<const T>& r,
           const kernels::Plane<T>& out) {
  for (int j = 0; j < out.rows; ++j)
    for (int parity = 0; parity < 2; ++parity) {
      const T *w = weight.half(j, parity), *from = r.half(j, parity);
      T* to = out.half(j, parity);
      for (int k = 0; k < kernels::half_count(out.columns, parity); ++k) to[k] = w[k] * from[k];
    }
}

}  // namespace

template <class T>
Minres<T>::Minres(const NewtonSystem<T>& system, BlockPreconditioner<T>& preconditioner,
                  const Vector<T>& f)
    : system_(system),
      preconditioner_(preconditioner),
      v_(system.make_vector()),
      v_old_(system.make_vector()),
      v_new_(system.make_vector()),
      z_(system.make_vector()),
      w_(system.make_vector()),
      w_old_(system.make_vector()),
      x_(system.make_vector()) {
  system.combine(1.0, f, 0.0, v_);
  preconditioner.apply(v_, z_);
  gamma_ = eta_ = std::sqrt(system.dot(z_, v_));
}

template <class T>
bool Minres<T>::step() {
  system_.combine(0.0, z_, 1.0 / gamma_, z_);
  system_.apply(z_, v_new_);
  const double delta = system_.dot(v_new_, z_);
  system_.combine(-delta / gamma_, v_, 1.0, v_new_);
  if (gamma_old_ > 0.0) system_.combine(-gamma_ / gamma_old_, v_old_, 1.0, v_new_);
  // w_new = z − alpha3 w_old − alpha2 w, in the memory of w_old.
  const double alpha0 = c_ * delta - c_old_ * s_ * gamma_;
  const double alpha2 = s_ * delta + c_old_ * c_ * gamma_, alpha3 = s_old_ * gamma_;
  system_.combine(1.0, z_, -alpha3, w_old_);
  system_.combine(-alpha2, w_, 1.0, w_old_);
  preconditioner_.apply(v_new_, z_);
  const double next = std::sqrt(system_.dot(z_, v_new_)), alpha1 = std::hypot(alpha0, next);
  if (!(alpha1 > 0.0) || !std::isfinite(alpha1)) return false;
  system_.combine(0.0, w_old_, 1.0 / alpha1, w_old_);
  std::swap(w_, w_old_);
  c_old_ = std::exchange(c_, alpha0 / alpha1);
  s_old_ = std::exchange(s_, next / alpha1);
  system_.combine(c_ * eta_, w_, 1.0, x_);
  eta_ *= -s_;
  gamma_old_ = std::exchange(gamma_, next);
  std::swap(v_old_, v_);
  std::swap(v_, v_new_);
  return next > 0.0;
}

template <class T>
BlockPreconditioner<T>::BlockPreconditioner(const NewtonSystem<T>& system, Solver solver) {
  const Level<T>& level = system.level();
  of_cut_.resize(std::size_t(level.cuts.size()));
  if (system.pressure()) of_pressure_ = grid::Field<T>(level.nx, level.ny, system.meter());
  kernels::balance_rows<T>(system.membrane(), system.cuts(), of_pressure_.view(), of_cut_.data());
  if (solver == Solver::minres) return;
  set_schur_complements(system);
  cycle_.emplace(system);
}

/// B K⁻¹ Bᵀ is about Σ B²/(2 mu) = 10 mu/α² of the cell (exact where F is a rotation and the mode
/// is smooth), W D⁻¹ Wᵀ = 5 mu/β² with D = 4 mu.
template <class T>
void BlockPreconditioner<T>::set_schur_complements(const NewtonSystem<T>& system) {
  const Level<T>& level = system.level();
  const kernels::Cuts<T> cuts = system.cuts();
  const kernels::Plane<const T> mu = level.mu.view(), compliance = level.compliance.view();
  const kernels::Plane<T> weight = of_pressure_.view();
  const T area = level.spacing * level.spacing;
  for (int j = 0; j < weight.rows; ++j)
    for (int i = 0; i < weight.columns; ++i) {
      const T soft = compliance ? compliance.at(i, j) : level.compliance_value;
      const T stiffness = mu ? mu.at(i, j) : T(1);
      weight.at(i, j) = T(1) / (area * soft + T(10) * stiffness / weight.at(i, j));
    }
  for (int j = 0; cuts.count > 0 && j < level.ny; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k) {
      const T stiffness = mu ? mu.at(cuts.column[k], j) : T(1);
      T& of_cut = of_cut_[std::size_t(k)];
      of_cut = T(1) / (kernels::cut_compliance_diagonal<T>(cuts, k) + T(5) * stiffness / of_cut);
    }
}

template <class T>
void BlockPreconditioner<T>::apply(const Vector<T>& r, Vector<T>& z) {
  const kernels::Unknowns<const T> from = r.fields.view();
  const kernels::Unknowns<T> to = z.fields.view();
  if (cycle_) {
    cycle_->apply(from, to);
  } else {
    kernels::combine<T>(T(1), from.x, T(0), to.x);
    kernels::combine<T>(T(1), from.y, T(0), to.y);
  }
  if (of_pressure_) scale<T>(of_pressure_.view(), from.p, to.p);
  for (std::size_t k = 0; k < of_cut_.size(); ++k)
    for (std::size_t c = 2 * k; c < 2 * k + 2; ++c) z.q[c] = of_cut_[k] * r.q[c];
}

template <class T>
LinearReport solve_by_minres(const NewtonSystem<T>& system, double start,
                             const LinearOptions& options) {
  const Vector<T> f = system.right_hand_side();
  BlockPreconditioner<T> preconditioner(system, options.solver);
  Minres<T> minres(system, preconditioner, f);
  Vector<T> r = system.make_vector();
  const int most = options.most_cycles *
                   (options.solver == Solver::minres ? kPlainIterations : kMultigridIterations);
  LinearReport report;
  double look = options.reduction * minres.residual();
  bool going = true;
  while (going && report.cycles < most) {
    going = minres.step();
    ++report.cycles;
    if (minres.residual() > look && going && report.cycles < most) continue;
    system.residual(f, minres.solution(), r);
    report.residual = system.norm(r) / start;
    if (report.residual <= options.reduction) break;
    look = kLookAgain * minres.residual();
  }
  if (report.residual < 1.0) {
    system.set_correction(minres.solution());
  } else {  // of no use: the residual that counts has not fallen
    report.residual = 1.0;
    system.set_correction(system.make_vector());
  }
  return report;
}

template class Minres<float>;
template class Minres<double>;
template class BlockPreconditioner<float>;
template class BlockPreconditioner<double>;
template LinearReport solve_by_minres(const NewtonSystem<float>&, double, const LinearOptions&);
template LinearReport solve_by_minres(const NewtonSystem<double>&, double, const LinearOptions&);

}  // namespace drumhead::multigrid
