// SPDX-License-Identifier: MIT
#pragma once
// Transfers of states between a lattice and its coarser one (Setaluri et al. 2014, section 3.5).
// Coarse node (I, J) lies on fine node (2I, 2J); coarse counts are half the fine ones, odd counts
// rounded up. The transfers of corrections and residuals inside cycles are fused into relax.h.
// Displacements keep their unit on all levels, so nothing is rescaled.
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// coarse(I, J) = fine(2I, 2J) at interior nodes.
template <class T>
void inject_nodes(const Plane<const T>& fine, const Plane<T>& coarse);

/// fine = bilinear interpolation of the coarse nodes, at interior nodes.
template <class T>
void prolong_nodes(const Plane<const T>& coarse, const Plane<T>& fine);

/// coarse = mean of the (up to four) fine cells it covers.
template <class T>
void mean_cells(const Plane<const T>& fine, const Plane<T>& coarse);

/// fine = bilinear interpolation between the coarse cells' centres, constant beyond the outermost.
template <class T>
void interpolate_cells(const Plane<const T>& coarse, const Plane<T>& fine);

}  // namespace drumhead::kernels
