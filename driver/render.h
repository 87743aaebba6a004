// SPDX-License-Identifier: MIT
#pragma once
// The picture through the solution.
#include <drumhead/kernels/resample.h>
#include <drumhead/multigrid/warp.h>

#include "image.h"

namespace drumhead::driver {

/// A window on the solution, which must outlive it.
kernels::LatticeMapView map_of(const multigrid::Solution& solution);

/// The warped picture, of the picture's size. Beyond its edge the picture goes on with its edge
/// pixels. The filter overshoots at edges; each channel is clamped to the range that it had.
Image render(const Image& picture, const multigrid::Solution& solution, int threads);

}  // namespace drumhead::driver
