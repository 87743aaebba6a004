// SPDX-License-Identifier: MIT
#pragma once
// The study scenes: curve pairs on the unit square whose solutions are known (S1 sponge, S2
// roundabout, S3 pinch, S4 shift, S5 fold) and the two many-disc scenes ML and ML2. The margin is
// 0: the square's edge is fixed. Curves are polylines, circles of 2880 chords, segments and arcs of
// 2000: smooth curves would change the fifth digit of the reference energies.
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace drumhead::scenes {

/// A curve and its target, point by point; a closed curve repeats its first point at the end.
struct Polyline {
  std::string name;
  std::vector<Eigen::Vector2d> source, target;
  double turn_degrees =
      0.0;  ///< clockwise on the screen (y down), for rotations beyond 180 degrees
};

struct Scene {
  std::string name;
  std::vector<Polyline> curves;
  /// kappa/mu at a cell centre of the unit square; empty: one value everywhere, chosen by the
  /// caller.
  std::function<double(double x, double y)> kappa_mask;
};

// `offset` moves circle centres (and S3's disc) by (offset, .7 offset) and segments by offset in x,
// source and target alike. The reference energies hold at 0; .00317 keeps curves clear of lattice
// lines at every n.
inline constexpr double kStudyOffset = 0.00317;

/// S1: two vertical segments pulled apart and bent.
Scene sponge(double offset = 0.0);
/// S2: a circle of radius .22 turned inside a held circle of radius .4.
Scene roundabout(double degrees, double offset = 0.0);
/// S3: a stiff disc (kappa 1000, 0.1 outside) squeezed between two arcs of its rim.
Scene pinch(double offset = 0.0);
/// S4: a circle of radius .1 moved by .3.
Scene shift(double offset = 0.0);
/// S5: two vertical segments that change places.
Scene fold(double offset = 0.0);
/// ML: eight small circles carried apart.
Scene many_discs();
/// ML2: six circles carried outwards and around.
Scene turning_discs();

/// kappa/mu of every cell of an n × n lattice, i fastest.
std::vector<double> kappa_cells(const Scene& scene, int n, double kappa);

}  // namespace drumhead::scenes
