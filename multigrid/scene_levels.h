// SPDX-License-Identifier: MIT
#pragma once
// A scene cut and laid out on levels, and again after some of its curves have changed: what a solve
// needs besides a state. Levels are built anew where sources or weights have changed; where only
// targets have, as in a drag, nothing but the wanted displacements is.
#include <drumhead/multigrid/warp.h>

#include "hierarchy.h"

namespace drumhead::multigrid {

/// What decides the levels besides the curves.
struct LevelsKey {
  grid::Lattice lattice;
  grid::Material material;
  SceneTraits traits;
  double most_weight = 0.0;  ///< of cuts
  bool conforming = false;
  int threads = 1;
  friend bool operator==(const LevelsKey&, const LevelsKey&) = default;
};

template <class T>
class SceneLevels {
 public:
  explicit SceneLevels(LevelsKey key) : key_(std::move(key)) {}

  const LevelsKey& key() const { return key_; }
  /// Lays out a scene that is solved but once: keeps nothing of its curves.
  void lay_out(const std::vector<grid::CurvePair>& curves);
  /// Lays out one scene after another. The levels are as `lay_out` makes them.
  void lay_out_again(const std::vector<grid::CurvePair>& curves);

  /// Conforming cells: after lay_out_again. Other targets for a while, on level `top` and, where
  /// they need them, on coarser ones.
  void set_targets(const std::vector<grid::CurvePair>& curves, int top);

  /// Those of the last scene.
  Hierarchy<T>& hierarchy() { return *hierarchy_; }
  const grid::CutCells& cuts() const { return cuts_; }
  grid::MemoryMeter& meter() { return meter_; }

 private:
  void build(grid::CutCells cuts);
  void cut_again(const std::vector<grid::CurvePair>& curves);
  void conform_again(const std::vector<grid::CurvePair>& curves);

  LevelsKey key_;
  grid::MemoryMeter meter_;
  grid::CutCells cuts_;
  std::unique_ptr<Hierarchy<T>> hierarchy_;
  std::unique_ptr<grid::CurveCutter> cutter_;
  std::unique_ptr<grid::CurveConformer> conformer_;
  bool whole_ = false;  ///< after lay_out_again
};

/// Those of the last solve, in the precision that it took.
struct KeptLevels::Contents {
  std::unique_ptr<SceneLevels<float>> single_precision;
  std::unique_ptr<SceneLevels<double>> double_precision;

  /// In this precision, of this key; the others are let go.
  template <class T>
  SceneLevels<T>& levels(LevelsKey key);
};

}  // namespace drumhead::multigrid
