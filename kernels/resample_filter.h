// SPDX-License-Identifier: MIT
#pragma once
// The colour of a tile's pixels from their source positions and Jacobians; the formula is in
// resample.h.
#include <cstddef>

#include "resample_inverse.h"
#include "resample_pyramid.h"

namespace drumhead::kernels {

struct FilterBounds {
  float detail = 2.0f, anisotropy = 16.0f;  ///< as in ResampleOptions
};

/// From this footprint radius σ2 on (in units of `detail`) the next pyramid level has a share, from
/// 2 on it has all.
constexpr float kBlendFrom = 1.75f;

/// Writes tile.width × tile.height pixels to `out`, row_stride floats from row to row.
void filter_tile(const Pyramid& pyramid, const FilterBounds& bounds, const TileMap& tile,
                 float* out, std::ptrdiff_t row_stride);

}  // namespace drumhead::kernels
