// SPDX-License-Identifier: MIT
#pragma once
// Relaxations of a cycle by Kaczmarz's method on all rows (kernels/kaczmarz.h): that of Setaluri et
// al. 2014, section 3.5 (sweeps near the curves, two damped sweeps everywhere, sweeps near the
// curves), or coloured sweeps everywhere.
#include <deque>

#include <drumhead/kernels/kaczmarz.h>
#include <drumhead/multigrid/warp.h>

#include "hierarchy.h"

namespace drumhead::multigrid {

template <class T>
class KaczmarzSmoother {
 public:
  /// `solver`: kaczmarz or coloured_kaczmarz.
  KaczmarzSmoother(Solver solver, grid::MemoryMeter& meter);
  ~KaczmarzSmoother();
  KaczmarzSmoother(const KaczmarzSmoother&) = delete;
  KaczmarzSmoother& operator=(const KaczmarzSmoother&) = delete;

  /// Prepares the next coarser level, finest first: balances its rows at its state.
  void add(const kernels::LevelSystem<T>& system);
  /// One relaxation of the level that was added as the l-th, whose f carries the curve forces.
  void smooth(int l, const kernels::LevelSystem<T>& system);

 private:
  struct LevelRows {
    kernels::CurveNodes<T> nodes;
    grid::Field<T> alpha2;
    grid::UnknownFields<T> e;  ///< of damped sweeps
    std::vector<T> beta2, eq;
    std::size_t bytes = 0;  ///< besides the fields
  };
  Solver solver_;
  grid::MemoryMeter& meter_;
  std::deque<LevelRows> levels_;
};

}  // namespace drumhead::multigrid
