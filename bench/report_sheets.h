// SPDX-License-Identifier: MIT
#pragma once
// The tables of report_tables.h filled in, as HTML and as Markdown.
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

}  // namespace drumhead::bench
