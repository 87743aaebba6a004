// SPDX-License-Identifier: MIT
#pragma once
// The rows along a level's curves as one block: all curve rows and the volume rows of the cells
// that curves cut and of their neighbours. Their D-weighted Kaczmarz step,
//   r = g − (C u − M λ),  (C D⁻¹ Cᵀ + M) t = r,  u += D⁻¹ Cᵀ t,  λ −= t,
// solves them all at once instead of one after the other. Row by row, modes of q that hardly move a
// node (short arcs, zigzag along straight lines) are hardly seen either, which is why the default
// path has its jump on q; solved at once they are not slower than the others, and the jump may go:
// S2 kappa 1, exact rows, 32²: 478 cycles row by row with a jump of .005 in the preconditioner, 58
// by blocks with 5e-5. C is banded along the curves, so that the factors are linear in their
// length.
#include <memory>
#include <vector>

#include "hierarchy.h"

namespace drumhead::multigrid {

template <class T>
class CurvePatch {
 public:
  /// Factorises the block at the level's state. `meter` must outlive it.
  CurvePatch(const kernels::LevelSystem<T>& level, grid::MemoryMeter& meter);
  ~CurvePatch();
  CurvePatch(CurvePatch&&) noexcept;

  /// One step on the level's d, dq; f carries the curve forces before and after.
  void relax(const kernels::LevelSystem<T>& level);

 private:
  struct Block;
  std::unique_ptr<Block> block_;
};

}  // namespace drumhead::multigrid
