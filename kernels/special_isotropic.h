// SPDX-License-Identifier: MIT
#pragma once
// The isotropic membranes on special cells and around them, point by point from lists.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/special.h>

namespace drumhead::kernels {

/// Overwrites f at near nodes by −∂E/∂x̂ at the membrane's state; 0 at known ones.
template <class T>
void special_isotropic_force(const Membrane<T>& membrane, const Unknowns<T>& f);

/// Adds the energies of row j's special cells at x̂ + step·d (d.x null: at the state) and their
/// least J. A cell with a part that is mirrored in the mean is inverted. Triangles whose nodes are
/// all held are left out: no state changes what they store, and where targets mirror one, that of
/// neohookean would be so much that the rest were lost in rounding.
template <class T>
void add_special_isotropic_energy(const Membrane<T>& membrane, const Unknowns<const T>& d, T step,
                                  EnergySums& sums, int j);

/// shift := pressures of all triangles at the state over law.relief (arap). May be the membrane's
/// own.
template <class T>
void update_triangle_pressure(const Membrane<T>& membrane, T* shift);

/// Near nodes of row j of H d; 0 at known nodes.
template <class T>
void overwrite_block_row(const SpecialRows<T>& rows, const Unknowns<const T>& d,
                         const Unknowns<T>& out, int j);

/// Near nodes of row j of the Hessian's diagonal blocks (xx, xy, yy).
template <class T>
void overwrite_diagonal_row(const SpecialRows<T>& rows, const Plane<T>* block, int j);
/// Known nodes of row j of the blocks' inverses := 0, so that steps leave them at 0.
template <class T>
void hold_known_row(const SpecialRows<T>& rows, const Plane<T>* inverse, int j);
/// Special cells of row j of the cells' tangents, ten rows of entries.
template <class T>
void overwrite_tangent_row(const SpecialRows<T>& rows, const SplitRow<T>* entries, int j);

/// Gauss–Seidel on the near nodes of row j, one after the other.
template <class T>
void relax_block_row(const Membrane<T>& membrane, const Unknowns<const T>& f, const Unknowns<T>& d,
                     int j);

}  // namespace drumhead::kernels
