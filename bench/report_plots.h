// SPDX-License-Identifier: MIT
#pragma once
// The plots of the measurements, for the page and, three of them, for the README.
#include <string>
#include <vector>

#include "measurements.h"
#include "svg_plot.h"

namespace drumhead::bench {

struct ReportPlot {
  std::string id;       ///< also its file's name
  std::string section;  ///< of the page, see report_page.cpp
  std::string caption;
  SvgPlot plot;
  bool readme = false;
};

/// Every plot that has a value.
std::vector<ReportPlot> plots(const Measurements& measured);

}  // namespace drumhead::bench
