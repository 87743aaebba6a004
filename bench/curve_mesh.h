// SPDX-License-Identifier: MIT
#pragma once
// A triangle mesh of the unit square whose edges follow the curves, by CGAL (constrained Delaunay
// triangulation and Delaunay refinement): what the rival of the paper's Table 1 ran on.
#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "support/scenes.h"

namespace drumhead::bench {

struct CurveMesh {
  std::vector<Eigen::Vector2d> rest;          ///< of the vertices
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise
  std::vector<char> known;                    ///< per vertex: on a curve or on the square's edge
  std::vector<Eigen::Vector2d> target;  ///< per vertex: where it goes if it is known; else rest
  /// Patch of each triangle's corners: the corners at one vertex and on one side of the curves.
  std::vector<std::array<int, 3>> patch;
  int patches = 0;

  /// A point in a triangle by barycentric coordinates.
  struct Place {
    int triangle = 0;
    std::array<double, 3> share{};
  };
  std::vector<Place> places_of(const std::vector<Eigen::Vector2d>& points) const;

  struct Triangulation;
  std::shared_ptr<const Triangulation> triangulation;
};

/// With about (n + 1)² vertices; no angle below 20.7 degrees but where curves meet so.
CurveMesh mesh_along_curves(const scenes::Scene& scene, int n);

}  // namespace drumhead::bench
