// SPDX-License-Identifier: MIT
#pragma once
// Paths and basic shapes of SVG as 2geom paths (SVG 2, chapters 9 and 10), and a pair of them as
// chains of cubic Béziers whose segments correspond.
#include <2geom/pathvector.h>
#include <drumhead/grid/curve.h>
#include <utility>
#include <vector>

#include "svg_document.h"

namespace drumhead::driver {

/// rect circle ellipse line polyline polygon path
bool is_shape(pugi::xml_node element);

/// The subpaths of a shape in its own user units, those without a segment left out; `whole` is the
/// view for lengths in %. Basic shapes start and run as SVG 2 says: circle and ellipse at their
/// rightmost point, clockwise on the screen. Throws std::invalid_argument naming file, line and
/// element where its geometry is broken.
Geom::PathVector shape_paths(const SvgDocument& document, const SvgView& whole,
                             pugi::xml_node element);

using Chain = std::vector<grid::CubicBezier>;

/// A subpath in its own user units and where they lie.
struct Placed {
  Geom::Path path;
  Geom::Affine to_picture;
};

/// A subpath as cubic Béziers in picture pixels. Arcs become one Bézier for every 45 degrees or
/// part of them: 4e-6 of their radius from the circle.
Chain chain(const Placed& path);

/// Source and target as Béziers. Where both subpaths have the same number of segments (those
/// without length not counted), each segment is cut into the same number of Béziers on both sides,
/// so that equal parameters correspond; elsewhere the two chains get different numbers of Béziers,
/// which grid::matched takes by arc length.
std::pair<Chain, Chain> corresponding_chains(const Placed& source, const Placed& target);

}  // namespace drumhead::driver
