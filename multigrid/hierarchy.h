// SPDX-License-Identifier: MIT
#pragma once
// The levels of a scene, finest first, and everything that is handed down them: material
// (averaged), curve rows (aggregated exactly), state (x̂ injected, P averaged). Operators are
// rediscretised from these.
#include <deque>

#include <drumhead/grid/curve.h>

#include "level.h"

namespace drumhead::multigrid {

template <class T>
class Hierarchy {
 public:
  /// Builds all levels down to one with at most kBottomCells cells across its longer side.
  Hierarchy(const grid::Lattice& lattice, const grid::Material& material,
            const grid::CutCells& cuts, const SceneTraits& traits, grid::MemoryMeter& meter);

  /// Makes all levels conform to curves. `lattice`: the finest level's.
  void conform(const std::vector<grid::CurvePair>& curves, const grid::Lattice& lattice,
               grid::MemoryMeter& meter);
  /// What makes such cells of all levels.
  std::unique_ptr<grid::CurveConformer> make_conformer(const grid::Lattice& lattice) const;
  /// Makes all levels conform to these cells.
  void conform(std::vector<grid::ConformingCells> cells, grid::MemoryMeter& meter);
  /// Clears all levels: as after the construction, for the same curves.
  void clear();
  /// Takes the wanted displacements of cuts that are otherwise the ones it was made of.
  void retarget(const grid::CutCells& cuts);
  /// Takes the targets that the curves of its cells have now on level `top` and all coarser ones,
  /// into the state too.
  void retarget(grid::CurveConformer& conformer, int top);
  /// Wanted displacements of level l from those of the finest level's cuts, averaged as the cuts.
  void set_wanted(int l, std::vector<grid::Point> wanted);
  bool conforming() const { return levels_.front().conforming != nullptr; }

  int size() const { return int(levels_.size()); }
  Level<T>& operator[](int l) { return levels_[std::size_t(l)]; }
  const Level<T>& operator[](int l) const { return levels_[std::size_t(l)]; }
  int index_of(const Level<T>& level) const {
    int l = 0;
    while (&levels_[std::size_t(l)] != &level) ++l;
    return l;
  }
  const SceneTraits& traits() const { return traits_; }
  /// Exact rows from here on: no jump in the equations, and this one in the preconditioner.
  void drop_jump(double inside) {
    traits_.jump = 0.0;
    traits_.jump_inside = inside;
  }
  /// 1/kappa of all levels, no cell's kappa above `most`.
  void set_compliance(const grid::Material& material, double most);
  kernels::RowScratch<T>& scratch() { return scratch_; }

  /// Hands the state of level `top` and its clamp down to all coarser levels.
  void restrict_state(int top);
  /// State of level l := interpolation of that of level l + 1: x̂ bilinear, P between cell centres,
  /// q by arc length; in special cells x̂ by triangles, P by parts.
  void prolong_state(int l);

 private:
  void set_material(const grid::Material& material, grid::MemoryMeter& meter);
  /// arap with a large kappa, fold-free: corner pressures on all levels.
  void relieve(const grid::Material& material, grid::MemoryMeter& meter);
  void set_diagonal(Level<T>& level, grid::MemoryMeter& meter);

  SceneTraits traits_;
  std::deque<Level<T>> levels_;
  kernels::Law<T> law_;  ///< of all levels at first
  kernels::RowScratch<T> scratch_;
};

}  // namespace drumhead::multigrid
