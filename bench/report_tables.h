// SPDX-License-Identifier: MIT
#pragma once
// The tables of the measurements: what stands in which column is said once, for the page (HTML) and
// for bench/README.md (Markdown).
#include <string>
#include <vector>

#include "measurements.h"

namespace drumhead::bench {

/// A table filled in; cells of numeric columns are set right.
struct Sheet {
  std::string id, title, note;
  std::string command;  ///< that measures it
  std::vector<std::string> head;
  std::vector<bool> numeric;
  std::vector<std::vector<std::string>> cells;
  bool detail = false;  ///< folded away in the page
};

/// Every table, those without rows too.
std::vector<Sheet> sheets(const Measurements& measured);

std::string html_of(const Sheet& sheet);
std::string markdown_of(const Sheet& sheet);

/// A number as people read it: three digits, no exponent between 1e-3 and 1e6; "–" for NaN.
std::string figure(double value);

}  // namespace drumhead::bench
