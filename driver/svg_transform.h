// SPDX-License-Identifier: MIT
#pragma once
// Transforms of SVG elements with their origins (CSS Transforms 1, sections 5, 6 and 8).
#include <2geom/affine.h>

#include "svg_document.h"

namespace drumhead::driver {

/// The `transform` of style or attribute about its `transform-origin`, which is in the view's user
/// units or, with `transform-box: fill-box`, from the corner of the box around what the element
/// shows; `whole` is the view for lengths in %. Identity if there is no transform. Throws
/// std::invalid_argument naming file, line and element where one of the three cannot be read.
Geom::Affine transform_of(const SvgDocument& document, const SvgView& whole,
                          pugi::xml_node element);

}  // namespace drumhead::driver
