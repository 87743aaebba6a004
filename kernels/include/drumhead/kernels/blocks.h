// SPDX-License-Identifier: MIT
#pragma once
// What the isotropic membranes (model.h) need besides elastic.h and relax.h.
#include <drumhead/kernels/relax.h>

namespace drumhead::kernels {

/// block := (B + 1e-4 mu)⁻¹ with B the 2×2 blocks (xx, xy, yy) of the Hessian's diagonal at the
/// interior nodes, mu the membrane's constant: nodes that nothing holds have an inverse, too. 0 at
/// nodes that a hard curve holds.
template <class T>
void inverse_blocks(const Membrane<T>& membrane, const Plane<T> (&block)[3]);

/// coarse := mean tangents of the coarse cells, ten entries each (Membrane::tangent), from the
/// membrane's own tangents or, if it has none, from those at its state.
template <class T>
void average_tangents(const Membrane<T>& membrane, const Plane<T>& coarse);

/// Estimate from below of the largest eigenvalue of D⁻¹ H, by `steps` steps of the power method;
/// level.d and level.product are lost.
template <class T>
double largest_eigenvalue(const LevelSystem<T>& level, int steps);

/// shift := min(0, J − eps + shift) w/(w + c) at every corner, c = law.relief, w its stiffness: one
/// step of the method of multipliers (model_arap.h). shift are the planes that membrane.law views;
/// `listed` are the values of the triangles of special cells, if there are any.
template <class T>
void update_corner_pressure(const Membrane<T>& membrane, const Plane<T> (&shift)[4],
                            T* listed = nullptr);

}  // namespace drumhead::kernels
