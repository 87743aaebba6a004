// SPDX-License-Identifier: MIT
#pragma once
// The linear solver of Setaluri et al. 2014, section 3.5: V-cycles by themselves, relaxed by
// Kaczmarz's method. Unlike theirs, the cycles transfer the curve forces (grid/cut_cells.h).
#include "krylov.h"

namespace drumhead::multigrid {

/// Corrects by cycles until the residual of norm `start` is reduced, `most_cycles` are done, or the
/// residual has grown hopelessly. The best iterate is left in d, dq.
template <class T>
LinearReport solve_by_kaczmarz(const NewtonSystem<T>& system, double start,
                               const LinearOptions& options);

}  // namespace drumhead::multigrid
