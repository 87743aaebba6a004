// SPDX-License-Identifier: MIT
#pragma once
// The CRPM membrane (Setaluri et al. 2014, Eq. 1) on a triangle mesh along the curves, elements of
// degree 1, hard curves by known vertices, solved by Newton's method with a sparse direct solver
// (CHOLMOD):
//
//     E = Σ triangles mu/2 A |F|² + Σ patches A [P (J̄ − 1) − P²/(2 kappa)]
//
// One P per triangle would be more than the vertices can follow, and locks at kappa/mu >> 1. So P
// is constant on the corners that meet in a vertex on one side of the curves, each with a third of
// its triangle, and J̄ is their mean: one P for two unknowns, as on the lattice. P is eliminated,
// which leaves a positive definite matrix of the vertices alone.

#include <Eigen/Core>

#include "curve_mesh.h"

namespace drumhead::bench {

struct MeshWarp {
  CurveMesh mesh;                      ///< the finest
  std::vector<Eigen::Vector2d> moved;  ///< of its vertices
  int newton = 0, newton_finest = 0, factorisations = 0;
  double mesh_seconds = 0.0, assemble_seconds = 0.0, solve_seconds = 0.0;
  double solver_bytes = 0.0;  ///< CHOLMOD's at its peak
  int folded = 0;             ///< triangles
  bool solved = true;         ///< false: a matrix was not positive definite with clamped P either
};

/// Nested iteration over meshes of about n², (n/2)², … vertices by nested_newton.h's rules.
MeshWarp solve_on_mesh(const scenes::Scene& scene, int n, double kappa);

}  // namespace drumhead::bench
