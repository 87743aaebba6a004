// SPDX-License-Identifier: MIT
#pragma once
// A line plot as SVG: linear or logarithmic axes with their names, a legend, and each value as a
// tooltip. Colours and marks are told apart without colour, too, and follow the reader's light or
// dark scheme.
#include <string>
#include <vector>

namespace drumhead::bench {

struct PlotPoint {
  double x = 0.0, y = 0.0;
  std::string label;  ///< written beside the mark; may be empty
};

/// A line, or (solid false) marks alone.
struct PlotSeries {
  std::string name;
  int look = 0;  ///< colour and mark, 0…12; the same look is the same peer in every plot
  enum class Line { solid, dashed, dotted, none } line = Line::solid;
  std::vector<PlotPoint> points;
};

struct SvgPlot {
  std::string title, x_name, y_name;
  bool log_x = true, log_y = true;
  bool x_at_points = false;  ///< lines and numbers where points are, instead of round values
  std::vector<PlotSeries> series;
  /// Where the x axis counts in words instead of numbers: point k's x is k.
  std::vector<std::string> x_words;
};

/// The plot without colours: a page that holds several says them once, by plot_style().
std::string svg_of(const SvgPlot& plot);
/// The same as a file of its own, colours inside.
std::string svg_file_of(const SvgPlot& plot);
/// CSS of all plots.
std::string plot_style();

}  // namespace drumhead::bench
