// SPDX-License-Identifier: MIT
#pragma once
// A picture drawn as SVG: rasterised by the program rsvg-convert (Debian: librsvg2-bin), its curves
// hidden.
#include "image.h"
#include "svg_document.h"

namespace drumhead::driver {

/// The drawing without what read_curves reads of it, stretched so that its view fills the picture.
/// The size in pixels is that of width and height, else of the viewBox, enlarged where the longer
/// side has less than 1024 pixels. Throws std::invalid_argument naming the drawing where it has no
/// size or rsvg-convert refuses it, std::runtime_error where rsvg-convert cannot be run.
Image rasterise(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace drumhead::driver
