// SPDX-License-Identifier: MIT
#pragma once
// The study scenes as problems of the solver. Apart from scenes.h, so that the oracle depends on
// Eigen alone.
#include <drumhead/multigrid/warp.h>

#include "scenes.h"

namespace drumhead::scenes {

/// The scene as the solver takes it: n × n cells of side 1/n, mu 1, polylines as straight Béziers.
/// `kappa` is ignored where the scene has a mask.
multigrid::WarpProblem problem(const Scene& scene, int n, double kappa);

}  // namespace drumhead::scenes
