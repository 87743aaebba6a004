// SPDX-License-Identifier: MIT
#include "measurements.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace drumhead::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void add_document(const Json& document, Measurements& all) {
  Run run;
  for (const auto& [key, into] : {std::pair{"program", &run.program},
                                  {"command", &run.command},
                                  {"date", &run.date},
                                  {"commit", &run.commit},
                                  {"compiler", &run.compiler},
                                  {"processor", &run.processor}})
    *into = document.at(key).get<std::string>();
  run.processors = document.at("processors").get<int>();
  run.load = value(document, "load");
  for (const Json& row : document.at("rows")) {
    if (!row.is_object() || !row.at("table").is_string())
      throw std::runtime_error("a row without a table");
    all.rows.push_back(row);
  }
  all.runs.push_back(std::move(run));
}

/// Programs of rivals have tables of their own; the rivals' rows stand in the common ones, too, and
/// drumhead's beside them where no other program has measured the scene.
void add_rivals(Measurements& all) {
  const Rows measured = all.table("work_precision");
  const auto known = [&](const Json& row) {
    return std::ranges::any_of(measured, [&](const Json& other) {
      return is_ours(other) && text(other, "scene") == text(row, "scene") &&
             value(other, "kappa") == value(row, "kappa");
    });
  };
  Rows shared;
  for (const Json& row : all.rows) {
    const std::string table = text(row, "table");
    if (table != "direct" && table != "mesh" && table != "amg") continue;
    Json copy = row;
    if (!copy.contains("threads")) copy["threads"] = 1;
    copy["table"] = "table1";
    if (!is_ours(row) && text(row, "scene") == "S1" && value(row, "kappa") == 1.0)
      shared.push_back(copy);
    copy["table"] = "work_precision";
    if ((!is_ours(row) || !known(row)) && row.contains("rms_px") && copy["threads"] == 1)
      shared.push_back(copy);
  }
  std::ranges::move(shared, std::back_inserter(all.rows));
}

}  // namespace

Rows Measurements::table(const std::string& name) const {
  return where(rows, [&](const Json& row) { return text(row, "table") == name; });
}

Measurements read_measurements(const std::vector<std::string>& files) {
  Measurements all;
  for (const std::string& file : files) {
    std::ifstream stream(file);
    if (!stream) throw std::runtime_error(file + ": cannot be read");
    try {
      add_document(Json::parse(stream), all);
    } catch (const std::exception& error) {
      throw std::runtime_error(file + ": " + error.what());
    }
  }
  add_rivals(all);
  return all;
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream || bytes.empty()) throw std::runtime_error(file.string() + ": cannot be read");
  return bytes;
}

std::string text(const Json& row, const char* key) {
  const auto found = row.find(key);
  return found == row.end() || !found->is_string() ? std::string() : found->get<std::string>();
}

double value(const Json& row, const char* key) {
  const auto found = row.find(key);
  if (found == row.end()) return kNone;
  if (found->is_string() && *found == "inf") return std::numeric_limits<double>::infinity();
  return found->is_number() ? found->get<double>() : kNone;
}

Rows where(const Rows& rows, const std::function<bool(const Json&)>& holds) {
  Rows some;
  std::ranges::copy_if(rows, std::back_inserter(some), holds);
  return some;
}

std::string with_threads(const Json& row) {
  const int threads = int(value(row, "threads"));
  return text(row, "method") + ", " + std::to_string(threads) +
         (threads == 1 ? " thread" : " threads");
}
bool is_ours(const Json& row) { return text(row, "method").starts_with("drumhead"); }

std::vector<std::string> distinct(const Rows& rows,
                                  const std::function<std::string(const Json&)>& of) {
  std::vector<std::string> names;
  for (const Json& row : rows)
    if (std::string name = of(row); std::ranges::find(names, name) == names.end())
      names.push_back(std::move(name));
  return names;
}

std::string figure(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  const double size = std::abs(value);
  char buffer[40];
  if (size >= 1e6 || (size > 0.0 && size < 1e-4))
    std::snprintf(buffer, sizeof buffer, "%.1e", value);
  else
    std::snprintf(buffer, sizeof buffer, size >= 100.0 ? "%.0f" : "%.3g", value);
  return buffer;
}

std::string ranged(const Json& row, const std::string& key) {
  const std::string mean = figure(value(row, key.c_str()));
  const std::string least = key + "_least", most = key + "_most";
  if (!row.contains(most)) return mean;
  const std::string to = figure(value(row, most.c_str()));
  return mean + (row.contains(least) ? " (" + figure(value(row, least.c_str())) + "–" + to + ")"
                                     : " (≤ " + to + ")");
}

}  // namespace drumhead::bench
