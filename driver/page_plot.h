// SPDX-License-Identifier: MIT
#pragma once
// A small plot as SVG text: one value a Newton step on a logarithmic axis, the steps of a level
// side by side over a band that names it. Its colours are the page's (classes grid, band, mark,
// line, bound).
#include <string>
#include <vector>

namespace drumhead::driver {

struct PlotStep {
  double value = 0.0;  ///< left out where it is not above 0 and finite
  std::string label;   ///< over the mark; empty: none
};

struct PlotLevel {
  std::string name;
  std::vector<PlotStep> steps;
};

struct Plot {
  std::string title;              ///< with its unit
  std::vector<PlotLevel> levels;  ///< in the order of the run
  double bound = 0.0;             ///< a dashed line across; left out where it is not above 0
  std::string bound_name;
};

/// Texts are escaped here.
std::string svg_of(const Plot& plot);

}  // namespace drumhead::driver
