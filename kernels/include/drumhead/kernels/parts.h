// SPDX-License-Identifier: MIT
#pragma once
// The rows of the parts of special cells (special.h) all at once, for who solves them together
// (multigrid/part_patch.h): part by part they are relax.h's. A value per part; plain loops along
// the curves.
#include <drumhead/kernels/relax.h>

namespace drumhead::kernels {

/// residual_p = f_p − (B d − A/kappa dP − jumps)_p of every part of a level with special cells.
template <class T>
void parts_residual(const LevelSystem<T>& level, double* residual);

/// The D-weighted Kaczmarz step along all parts' rows: d_i += Σ_p B_pi t_p/K_ii, dP_p −= t_p.
template <class T>
void move_along_parts(const LevelSystem<T>& level, const double* t);

}  // namespace drumhead::kernels
