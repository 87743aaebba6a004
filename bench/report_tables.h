// SPDX-License-Identifier: MIT
#pragma once
// The tables of the measurements: what stands in which column is said once, for the page and for
// Markdown (report_sheets.h).
#include <functional>
#include <string>
#include <vector>

#include "measurements.h"

namespace drumhead::bench {

struct Column {
  std::string head;
  std::function<std::string(const Json&)> cell;
  bool numeric = true;
};

/// A table with a row of its own for each row measured.
struct List {
  std::string id, title, command, note, table;
  std::vector<Column> columns;
  bool detail = true;
};

/// A table across: a row for each name that `row` gives ("": none), a column for each that `column`
/// gives.
struct Across {
  std::string id, title, command, note, table, corner;
  std::function<std::string(const Json&)> row, column, cell;
  bool detail = false, in_words = false;
};

std::vector<Across> tables_across();
std::vector<List> lists();

}  // namespace drumhead::bench
