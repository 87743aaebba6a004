// SPDX-License-Identifier: MIT
#pragma once
// The Compression-Resistant Poisson membrane on a lattice (Setaluri et al. 2014, Eq. 1, 5, 6, 7),
// matrix-free:
//   E = Σ_cells mu/4 Σ_edges |Δx̂|² + Σ_cells [P (A J* − A) − A P²/(2 kappa)] + Σ_cuts [q·(b − W x̂)
//   − ½ qᵀ M q]
// A = h² is the cell's area; the paper's last volume term lacks it. Unknowns are the displacements
// u = x̂ − X (unit: cells of the finest lattice), P per cell and q per cut cell. The Newton system
// at a state is
//   [K + P_H G   Bᵀ         −Wᵀ] [du]   [f.x, f.y]
//   [B           −A/kappa   0  ] [dP] = [f.p     ]
//   [−W          0          −M ] [dq]   [f of q  ]
// For the isotropic membranes (model.h) these functions, but for linear_residual, go to the kernels
// of isotropic.h: no P exists, elastic and volume are the energies with mu and with kappa,
// volume_merit is volume. Curve terms are in cuts.h; the functions here do the elastic part of
// every row. Nodes on the boundary are fixed: they are read (as 0 in a correction) and never
// written.
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// out = H d without the curve forces: x, y = (K + P_H G) d + Bᵀ dP and p = B d − A/kappa dP.
/// Shapes: d and out as the membrane's lattice; out must not alias d. Costs one work unit.
template <class T>
void apply_hessian(const Membrane<T>& membrane, const Unknowns<const T>& d, const Unknowns<T>& out);

/// r = f − H d without the curve forces (which an f that carries Wᵀ dq already has; see cuts.h). r
/// may alias f where the membrane has no special cells. Not for isotropic membranes.
template <class T>
void linear_residual(const Membrane<T>& membrane, const Unknowns<const T>& f,
                     const Unknowns<const T>& d, const Unknowns<T>& r);

/// f = −∂E/∂(x, P) at the membrane's state, without the curve forces: the right-hand side of
/// Newton's method. Returns the number of cells with J* < 0, known on the way; 0 without pressures.
template <class T>
int force(const Membrane<T>& membrane, const Unknowns<T>& f);

/// Sums over all cells; lengths in finest cells, energies in mu times that squared.
struct EnergySums {
  double elastic = 0.0;  ///< Σ mu/4 Σ |edge|²
  double volume = 0.0;   ///< Σ A kappa/2 (J* − 1)²; cells with 1/kappa = 0 store none
  /// Σ A [P⁺ c + km/2 c²], c = J* − 1 − P⁺/kappa, km = min(kappa, 100 mu), P⁺ = P + dP; where kappa
  /// ≤ 100 mu simply A kappa/2 (J* − 1)²: the volume part of the line search's merit function.
  double volume_merit = 0.0;
  double constraint = 0.0;      ///< Σ stiffness/2 |u − wanted|² over the nodes of soft curves
  double inverted_cells = 0.0;  ///< number of cells with J* < 0
  /// Isotropic membranes only: the least J at the points where their energy is taken.
  double least_J = 1e30;
};

/// The sums at x̂ + step·d (P⁺ = P + dP for any step). d.x null: at the state itself, P⁺ = P.
template <class T>
EnergySums energy(const Membrane<T>& membrane, const Unknowns<const T>& d, T step);

}  // namespace drumhead::kernels
