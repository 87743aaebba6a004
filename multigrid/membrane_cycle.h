// SPDX-License-Identifier: MIT
#pragma once
// A symmetric positive definite approximation of (K + P_H G)⁻¹ with P_H clamped to ±mu: one V-cycle
// on x̂ alone. Relaxations are red-black Gauss–Seidel, black-red on the way up, so that the cycle is
// its own adjoint; the bottom level is relaxed there and back until it is as good as solved.
#include "newton_system.h"

namespace drumhead::multigrid {

template <class T>
class MembraneCycle {
 public:
  /// At the state of the system's level, which is handed down. Uses d and f of all levels.
  explicit MembraneCycle(const NewtonSystem<T>& system);

  /// z.x, z.y = the cycle's image of r.x, r.y. May be the same fields.
  void apply(const kernels::Unknowns<const T>& r, const kernels::Unknowns<T>& z);

 private:
  kernels::LevelSystem<T> system(int l) const;
  void descend(int l);

  Hierarchy<T>& hierarchy_;
  int top_;
  bool pressure_;
};

}  // namespace drumhead::multigrid
