// SPDX-License-Identifier: MIT
#pragma once
// Dense direct solution of the bottom level's Newton system: a few hundred unknowns, assembled by
// applying the level's own kernels to unit vectors (no second copy of a formula) and factorised by
// Eigen's LU.
#include <memory>

#include "level.h"

namespace drumhead::multigrid {

template <class T>
class CoarseSolver {
 public:
  CoarseSolver();
  ~CoarseSolver();
  CoarseSolver(CoarseSolver&&) noexcept;
  CoarseSolver& operator=(CoarseSolver&&) noexcept;

  /// Factorises the level's system at its state. `pressure`: with volume rows; `jump`: qs of the
  /// curve rows.
  void factorise(Level<T>& level, bool pressure, T jump);
  /// level.d, level.dq := solution for level.f, level.fq (f does not carry curve forces).
  void solve(Level<T>& level) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace drumhead::multigrid
