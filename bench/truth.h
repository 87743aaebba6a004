// SPDX-License-Identifier: MIT
#pragma once
// The true warp of a study scene at the nodes of square lattices, to measure errors in px of a
// picture of 1000 px. Of the roundabout it is the exact radial solution; of other scenes
// drumhead's own with conforming curves on kFinest² cells, solved to 0.003 px: two refinements
// finer than the finest lattice it judges.
#include <span>
#include <vector>

#include "support/scenes.h"

namespace drumhead::bench {

class Truth {
 public:
  static constexpr int kFinest = 1600;

  /// Solves the scene unless it is the roundabout (seconds). Throws std::runtime_error if that does
  /// not converge.
  Truth(const scenes::Scene& scene, double kappa);

  struct Error {
    double rms_px = 0.0, max_px = 0.0;
  };
  /// Of displacements u, v of the nodes of an n × n lattice, i fastest, as shares of the picture. n
  /// must divide kFinest.
  Error error(int n, std::span<const double> u, std::span<const double> v) const;

  /// The largest n that may be judged.
  int most_cells() const;

 private:
  bool exact_;
  std::vector<double> u_, v_;  // at the nodes of kFinest²
};

}  // namespace drumhead::bench
