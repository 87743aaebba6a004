// SPDX-License-Identifier: MIT
#include "report_readme.h"

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

#include "report_summary.h"

namespace drumhead::bench {
namespace {

/// Sizes across, drumhead and its rivals down.
std::string table1(const Measurements& measured) {
  const Rows rows = measured.table("table1");
  constexpr int kSizes[] = {50, 100, 200, 400, 800};
  std::string lines = "| seconds (MB) |", rule = "|---|";
  for (const int n : kSizes) {
    lines += " " + std::to_string(n) + "² |";
    rule += "---:|";
  }
  lines += "\n" + rule + "\n";
  for (const std::string& line : distinct(rows, with_threads)) {
    lines += "| " + line + " |";
    for (const int n : kSizes) {
      const auto found = std::ranges::find_if(
          rows, [&](const Json& row) { return with_threads(row) == line && value(row, "n") == n; });
      lines += found == rows.end() ? " |"
                                   : " " + figure(value(*found, "seconds")) + " (" +
                                         figure(1e-6 * value(*found, "bytes")) + ") |";
    }
    lines += "\n";
  }
  return lines + "\n" + machine(measured) + "\n";
}

std::string line_of(std::initializer_list<std::string> cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string scene_words(const Json& row) {
  const std::string scene = text(row, "scene");
  const std::string name = scene == "S1"   ? "sponge"
                           : scene == "S2" ? "roundabout 90°"
                           : scene == "S4" ? "disc moved"
                                           : "pinched disc";
  return name + (row.contains("kappa") ? ", kappa/mu " + figure(value(row, "kappa"))
                                       : ", kappa/mu 1000 in 0.1");
}

/// Whole solves at 800².
std::string solves(const Measurements& measured) {
  std::string lines = line_of({"scene", "curves", "work units", "seconds, cutting included",
                               "bytes per node", "error left, share of the discretisation error",
                               "discretisation error, px of 1000", "curve gap, px"}) +
                      "|---|---|---:|---:|---:|---:|---:|---:|\n";
  for (const Json& row : measured.table("solve"))
    if (value(row, "n") == 800)
      lines += line_of({scene_words(row), text(row, "curves"), ranged(row, "work_units"),
                        ranged(row, "seconds"), figure(value(row, "bytes_per_node")),
                        ranged(row, "true_share"), figure(value(row, "discretisation_px")),
                        figure(value(row, "gap_rms_px"))});
  return lines;
}

/// Errors and times of both ways to meet curves, side by side.
std::string curves(const Measurements& measured) {
  const Rows rows = measured.table("curves");
  std::string lines = line_of({"scene", "lattice", "averaged: error, px RMS", "ms",
                               "conforming: error, px RMS", "ms", "folded cells"}) +
                      "|---|---:|---:|---:|---:|---:|---|\n";
  for (const Json& row : rows) {
    const double n = value(row, "n");
    if (text(row, "curves") != "averaged" || (n != 100 && n != 400)) continue;
    const auto other = std::ranges::find_if(rows, [&](const Json& beside) {
      return text(beside, "curves") == "conforming" && value(beside, "n") == n &&
             scene_words(beside) == scene_words(row);
    });
    if (other == rows.end()) continue;
    lines += line_of({scene_words(row), figure(n) + "²", figure(value(row, "rms_px")),
                      figure(1e3 * value(row, "seconds")), figure(value(*other, "rms_px")),
                      figure(1e3 * value(*other, "seconds")),
                      figure(value(row, "folded")) + ", " + figure(value(*other, "folded"))});
  }
  return lines;
}

std::string table(const std::string& name, const Measurements& measured) {
  if (name == "table1") return table1(measured);
  if (name == "solves") return solves(measured);
  if (name == "curves") return curves(measured);
  throw std::runtime_error("README: no table is called " + name);
}

}  // namespace

std::string with_tables(const std::string& readme, const Measurements& measured) {
  const std::string mark = "<!-- table ", made = ", made by bench/report.sh -->\n";
  std::string text;
  for (std::size_t at = 0;;) {
    const std::size_t open = readme.find(mark, at), name_at = open + mark.size();
    if (open == std::string::npos) return text + readme.substr(at);
    const std::size_t name_end = readme.find(made, name_at);
    const std::string name = readme.substr(name_at, name_end - name_at);
    const std::size_t close = readme.find("<!-- end of table " + name + " -->", name_at);
    if (name_end == std::string::npos || close == std::string::npos)
      throw std::runtime_error("README: a mark of table " + name.substr(0, 20) +
                               " without its end");
    text += readme.substr(at, name_end + made.size() - at) + table(name, measured);
    at = close;
  }
}

}  // namespace drumhead::bench
