// SPDX-License-Identifier: MIT
#pragma once
// The rows of all parts of a level's special cells as one block. Their D-weighted Kaczmarz step,
//   r = g − (C u − M λ),  (C D⁻¹ Cᵀ + M) t = r,  u += D⁻¹ Cᵀ t,  λ −= t,
// solves them at once instead of one after the other, as curve_patch.h does for averaged rows. The
// parts beside a curve have one or two unknown corners and share them: nearly parallel rows that
// contradict one another but for A/kappa, so that from part to part their pressures hardly move
// (after one cycle .95 of their error is left, S4 kappa 100, 200²; .60 with the block).
#include <vector>

#include "envelope.h"
#include "hierarchy.h"

namespace drumhead::multigrid {

template <class T>
class PartPatch {
 public:
  /// Factorises the block of a level with special cells at its state. `meter` must outlive it.
  PartPatch(const kernels::LevelSystem<T>& level, grid::MemoryMeter& meter);
  ~PartPatch();
  PartPatch(PartPatch&& other) noexcept;

  /// One step on the level's d.
  void relax(const kernels::LevelSystem<T>& level);

 private:
  Envelope factors_;
  std::vector<double> t_;
  grid::MemoryMeter* meter_;  ///< null: moved from
};

}  // namespace drumhead::multigrid
