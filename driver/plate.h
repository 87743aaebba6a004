// SPDX-License-Identifier: MIT
#pragma once
// A clean plate: what lies behind a cut-out and does not move with it. With colours multiplied by
// alpha, the cut-out c of opacity a over the plate p is
//
//     c + (1 − a) p                         (Porter and Duff, Compositing Digital Images, 1984)
#include "frame.h"
#include "image.h"

namespace drumhead::driver {

/// The plate for `picture`, coded as that is: light where that is light. An .svg is rasterised,
/// what has no alpha is opaque. Throws std::invalid_argument naming the file where it is not of the
/// picture's size and channels, where it is light but the picture is not, and where the picture has
/// no alpha through which it would be seen.
Image read_plate(const std::filesystem::path& file, const Image& picture);

/// Lays `rows`, which are rows `top`, top + 1, … of the frame as the plate's picture has them, over
/// the plate, beyond which nothing is.
void lay_over(const Image& plate, const Frame& frame, int top, std::vector<float>& rows);

}  // namespace drumhead::driver
