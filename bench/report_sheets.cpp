// SPDX-License-Identifier: MIT
#include "report_sheets.h"

#include <algorithm>

#include "html.h"
#include "report_tables.h"

namespace drumhead::bench {
namespace {

Sheet filled(const List& list, const Rows& rows) {
  Sheet sheet{list.id, list.title, list.note, list.command, {}, {}, {}, list.detail};
  for (const Column& column : list.columns) {
    // A column that no row fills is not shown.
    const auto empty = [&](const Json& row) {
      const std::string cell = column.cell(row);
      return cell.empty() || cell == "–" || cell == "– (–)" || cell == "–²";
    };
    if (std::ranges::all_of(rows, empty)) continue;
    sheet.head.push_back(column.head);
    sheet.numeric.push_back(column.numeric);
    sheet.cells.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) sheet.cells[k].push_back(column.cell(rows[k]));
  }
  return sheet;
}

Sheet filled(const Across& across, const Rows& rows) {
  Sheet sheet{across.id,       across.title, across.note, across.command,
              {across.corner}, {false},      {},          across.detail};
  std::vector<std::string> columns = distinct(rows, across.column);
  if (across.column(Json{{"n", 50}}) == "50²")
    std::ranges::stable_sort(columns, {}, [](const std::string& name) { return std::stod(name); });
  for (const std::string& name : columns) {
    sheet.head.push_back(name);
    sheet.numeric.push_back(!across.in_words);
  }
  for (const std::string& name : distinct(rows, across.row)) {
    if (name.empty()) continue;
    std::vector<std::string> cells{name};
    for (const std::string& column : columns) {
      const auto found = std::ranges::find_if(rows, [&](const Json& row) {
        return across.row(row) == name && across.column(row) == column;
      });
      cells.push_back(found == rows.end() ? "" : across.cell(*found));
    }
    sheet.cells.push_back(std::move(cells));
  }
  return sheet;
}

}  // namespace

std::vector<Sheet> sheets(const Measurements& measured) {
  std::vector<Sheet> all;
  for (const Across& across : tables_across())
    all.push_back(filled(across, measured.table(across.table)));
  for (const List& list : lists()) all.push_back(filled(list, measured.table(list.table)));
  return all;
}

std::string html_of(const Sheet& sheet) {
  std::string html = "<div class=\"wide\"><table id=\"" + sheet.id + "\"><thead><tr>";
  const auto set = [&](std::size_t k) { return sheet.numeric[k] ? " class=\"number\">" : ">"; };
  for (std::size_t k = 0; k < sheet.head.size(); ++k)
    html += std::string("<th") + set(k) + html::escaped(sheet.head[k]) + "</th>";
  html += "</tr></thead>\n<tbody>";
  for (const auto& row : sheet.cells) {
    html += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      html += std::string("<td") + set(k) + html::escaped(row[k]) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string markdown_of(const Sheet& sheet) {
  std::string lines = "|", rule = "|";
  for (std::size_t k = 0; k < sheet.head.size(); ++k) {
    lines += " " + sheet.head[k] + " |";
    rule += sheet.numeric[k] ? "---:|" : "---|";
  }
  lines += "\n" + rule + "\n";
  for (const auto& row : sheet.cells) {
    lines += "|";
    for (const std::string& cell : row) lines += " " + cell + " |";
    lines += "\n";
  }
  return lines;
}

}  // namespace drumhead::bench
