// SPDX-License-Identifier: MIT
#pragma once
// The warp itself as a picture: what happens to squares, and to areas. Every pixel is painted by
// the rest position of the point that came to lie under it, so that nothing is drawn twice and the
// pictures agree with the warped one pixel for pixel.
#include <drumhead/multigrid/warp.h>
#include <vector>

#include "canvas.h"
#include "svg_curves.h"

namespace drumhead::driver {

/// 24 squares across the longer side of a picture of width × height pixels; every other one is
/// coloured by where it was (red grows to the right, blue downwards). Beyond the picture's edge the
/// squares are grey.
void draw_checkerboard(const multigrid::Solution& solution, int width, int height, int threads,
                       Canvas& canvas, const ShareDone& progress = {});

/// Units of the legend that draw_jacobian writes in the canvas's strip.
constexpr double kLegendStrip = 106.0;

/// det J of every cell on the fixed scale of log₂ from 1/4 (blue) over 1 (white) to 4 (red), so
/// that pictures of different warps can be compared; black where the membrane lies upside down. A
/// yellow ring marks every place with folded cells, however small they are. Targets are thin grey
/// lines.
void draw_jacobian(const multigrid::Solution& solution, const std::vector<SvgCurve>& curves,
                   int threads, Canvas& canvas, const ShareDone& progress = {});

}  // namespace drumhead::driver
