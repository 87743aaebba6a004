// SPDX-License-Identifier: MIT
#include "scene_problem.h"

#include <cmath>

namespace drumhead::scenes {

multigrid::WarpProblem problem(const Scene& scene, int n, double kappa) {
  multigrid::WarpProblem problem;
  problem.lattice = {n, n, 1.0 / n, {0.0, 0.0}, 1.0};
  problem.material.mu = 1.0;
  problem.material.kappa = kappa;
  if (scene.kappa_mask) {
    for (const double cell : kappa_cells(scene, n, kappa)) {
      problem.material.kappa_cells.push_back(float(cell));
    }
  }
  const auto chords = [](const std::vector<Eigen::Vector2d>& points) {
    std::vector<grid::CubicBezier> chain;
    for (std::size_t k = 1; k < points.size(); ++k) {
      chain.push_back(
          grid::straight({points[k - 1].x(), points[k - 1].y()}, {points[k].x(), points[k].y()}));
    }
    return chain;
  };
  for (const Polyline& line : scene.curves) {
    grid::CurvePair pair;
    pair.name = line.name;
    pair.source = chords(line.source);
    pair.target = chords(line.target);
    // Below half a turn the curves themselves say which way.
    if (std::abs(line.turn_degrees) >= 180.0) pair.turn_degrees = line.turn_degrees;
    problem.curves.push_back(std::move(pair));
  }
  return problem;
}

}  // namespace drumhead::scenes
