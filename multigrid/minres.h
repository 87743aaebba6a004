// SPDX-License-Identifier: MIT
#pragma once
// MINRES (Paige and Saunders 1975), the Krylov method of Setaluri et al. 2014 for the symmetric
// indefinite Newton system, with a symmetric positive definite preconditioner: either the balanced
// scaling of the rows alone (1, α², β²: see kernels/kaczmarz.h), or blocks for the three kinds of
// unknowns: a multigrid cycle on x̂, and diagonals that stand for the Schur complements of P and q.
#include <cmath>
#include <optional>

#include "krylov.h"
#include "membrane_cycle.h"

namespace drumhead::multigrid {

template <class T>
class BlockPreconditioner {
 public:
  /// `solver`: minres or minres_multigrid. At the state of the system's level.
  BlockPreconditioner(const NewtonSystem<T>& system, Solver solver);
  /// z = M⁻¹ r.
  void apply(const Vector<T>& r, Vector<T>& z);

 private:
  void set_schur_complements(const NewtonSystem<T>& system);

  grid::Field<T> of_pressure_;
  std::vector<T> of_cut_;
  std::optional<MembraneCycle<T>> cycle_;
};

/// The method in progress: Lanczos vectors v, z = M⁻¹ v, directions w and the two last rotations.
template <class T>
class Minres {
 public:
  /// From zero, for the right-hand side f.
  Minres(const NewtonSystem<T>& system, BlockPreconditioner<T>& preconditioner, const Vector<T>& f);

  /// False at the end of the Krylov space.
  bool step();
  const Vector<T>& solution() const { return x_; }
  /// √(rᵀ M⁻¹ r), which no step enlarges.
  double residual() const { return std::abs(eta_); }

 private:
  const NewtonSystem<T>& system_;
  BlockPreconditioner<T>& preconditioner_;
  Vector<T> v_, v_old_, v_new_, z_, w_, w_old_, x_;
  double gamma_ = 0.0, gamma_old_ = 0.0, eta_ = 0.0;
  double c_ = 1.0, c_old_ = 1.0, s_ = 0.0, s_old_ = 0.0;
};

/// From zero until the residual of norm `start` is reduced or the iterations that most_cycles stand
/// for are done. The solution is in d, dq; LinearReport::cycles counts iterations.
template <class T>
LinearReport solve_by_minres(const NewtonSystem<T>& system, double start,
                             const LinearOptions& options);

}  // namespace drumhead::multigrid
