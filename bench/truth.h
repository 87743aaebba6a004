// SPDX-License-Identifier: MIT
#pragma once
// The true warp of a study scene at the nodes of square lattices, to measure errors in px of a
// picture of 1000 px. Of the roundabout it is the exact radial solution; of other scenes
// drumhead's own with conforming curves, finer than the finest lattice it judges.
#include <array>
#include <span>
#include <string>
#include <vector>

#include "support/scenes.h"

namespace drumhead::bench {

/// The FOLDER of "--truth FOLDER" among a program's arguments; "" where it is not there.
std::string truth_folder(int argc, char** argv);

class Truth {
 public:
  static constexpr int kFinest = 1600;  ///< cells a side of the nodes that are kept

  /// Without a folder the reference is solved on 1600² cells (seconds) and judges up to 400². With
  /// one it judges up to 1600²: of the sponge, whose tips converge slowly, on 6400² cells, of other
  /// scenes on 3200², where single precision resolves as little as their error on 1600²; read from
  /// the folder or, if it is not there yet, solved (half a minute, 3 GB) and left there for the
  /// next program; the disc moved at kappa 1 does not converge there. The roundabout needs neither.
  /// Throws std::runtime_error if the solve does not converge or the file is not as it should be.
  Truth(const scenes::Scene& scene, double kappa, const std::string& folder = {});

  struct Error {
    double rms_px = 0.0, max_px = 0.0;
  };
  /// Of displacements u, v of the nodes of an n × n lattice, i fastest, as shares of the picture. n
  /// must divide kFinest.
  Error error(int n, std::span<const double> u, std::span<const double> v) const;

  /// Where the point (x, y) of the picture's square goes, between nodes bilinear.
  std::array<double, 2> at(double x, double y) const;

  /// The largest n that may be judged.
  int most_cells() const { return most_cells_; }

 private:
  struct Reference;
  void solve(const scenes::Scene& scene, double kappa, const Reference& reference);

  int most_cells_;
  std::vector<double> u_, v_;  // at the nodes of kFinest²
};

}  // namespace drumhead::bench
