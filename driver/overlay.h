// SPDX-License-Identifier: MIT
#pragma once
// The warped picture under what made it: the deformed lattice, the warped source curves and their
// targets.
#include <drumhead/multigrid/warp.h>
#include <filesystem>
#include <vector>

#include "image.h"
#include "svg_curves.h"

namespace drumhead::driver {

/// PNG of the picture's size, enlarged by a whole factor where its longer side has less than 500
/// pixels and made smaller where it has more than 16384. Lattice lines are thinned to at least 12
/// pixels and 1/48 of the longer side apart. Targets lie as wide cyan lines under the thin red
/// of the warped sources, pins are white: where the warp meets its target, red runs in the
/// middle of cyan. Throws std::runtime_error naming `file`.
void write_overlay(const Image& warped, const multigrid::Solution& solution,
                   const std::vector<SvgCurve>& curves, const std::filesystem::path& file);

}  // namespace drumhead::driver
