// SPDX-License-Identifier: MIT
#pragma once
// Curve pairs from an SVG drawing. Layers or groups named `source` and `target` (case as written)
// hold shapes paired by name; outside them a shape whose name ends in -source or -target belongs to
// the pair of the rest of its name; what lies in a layer `pin` is held still. Everything else is
// art and not read. A named group around one nameless shape names it. A shape's subpaths are pairs
// of their own, in their order.
#include <drumhead/grid/curve.h>
#include <functional>
#include <string>
#include <vector>

#include "svg_document.h"

namespace drumhead::driver {

struct SvgCurve {
  grid::CurvePair pair;  ///< in picture pixels, exactly hard, without turn
  bool pin = false;      ///< from a layer `pin`
  std::string place;     ///< "file:line: path 'name'" of its source
};

/// Reads the curves, the drawing's view stretched onto a picture of width × height pixels. The
/// subpaths of a shape `a` with several are named a#1, a#2, … Throws std::invalid_argument naming
/// file, line and element: broken geometry, nameless, unpaired or doubled paths, subpaths that do
/// not match, curves without length, a closed source with an open target, no curves at all.
/// `warn` is called with one line for each warning as it is found: one may be why the rest then
/// cannot be read.
std::vector<SvgCurve> read_curves(const SvgDocument& document, double width_px, double height_px,
                                  const std::function<void(const std::string&)>& warn);

/// The elements that hold curves: layers, and shapes outside layers named with a suffix; hidden
/// where the same drawing is rasterised.
std::vector<pugi::xml_node> curve_elements(const SvgDocument& document);

}  // namespace drumhead::driver
