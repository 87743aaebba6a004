// SPDX-License-Identifier: MIT
#pragma once
// The isotropic membranes on conforming cells, assembled from their textbook tensors
// (oracle_membrane.h): regular cells by 2×2 Gauss points, triangles with the part of the density
// that has mu, parts with the one that has kappa at the mean of their triangles' F, arap's
// one-sided part at the corners of regular cells and in every triangle, and fold-free's part with
// mu, too, its part with kappa at the centres of regular cells; and the springs of soft curves.
#include <string>

#include "oracle_conforming.h"
#include "oracle_membrane.h"

namespace drumhead::oracle {

struct SolidLaw {
  std::string model;
  double kappa = 1.0, eps = 0.2;
  double corner = 1e4;  ///< fold-free: stiffness of its one-sided term
};

/// Of the unknown nodes: x, then y. `projected`: every point's tangent without its negative
/// eigenvalues; those of fold-free's volume part, which the part with mu makes up for, down to −mu.
MembraneSystem assemble(const ConformingMembrane& membrane, const SolidLaw& law, const Positions& x,
                        bool projected);

/// Newton's method with the true Hessian from a state close to a solution; stops below 1e-12 cells.
Positions newton(const ConformingMembrane& membrane, const SolidLaw& law, Positions x, int steps);

}  // namespace drumhead::oracle
