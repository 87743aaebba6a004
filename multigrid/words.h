// SPDX-License-Identifier: MIT
#pragma once
// Lengths, places and shares as notes name them.
#include <cstdio>
#include <string>

#include <drumhead/grid/curve.h>

namespace drumhead::multigrid {

/// "12.35 px"
inline std::string in_words(double px) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2f px", px);
  return text;
}

/// "1.2e-07": two digits of a number that may be tiny.
inline std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

/// "12 %" of a share .12
inline std::string percent(double share) {
  char text[64];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

/// "(12.35, 6.70) px"
inline std::string in_words(grid::Point px) {
  char text[128];
  std::snprintf(text, sizeof text, "(%.2f, %.2f) px", px.x, px.y);
  return text;
}

}  // namespace drumhead::multigrid
