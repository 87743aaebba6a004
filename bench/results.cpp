// SPDX-License-Identifier: MIT
#include "results.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>

namespace drumhead::bench {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line, model, family, name;
  const auto value = [&](const char* key, std::string& into) {
    if (into.empty() && line.starts_with(key)) into = line.substr(line.find(':') + 2);
  };
  while (std::getline(file, line)) {
    value("model name\t", name);
    value("cpu family\t", family);
    value("model\t", model);
  }
  return name.empty() ? "unknown" : name + ", family " + family + " model " + model;
}

/// Processes that wanted the processor in the minute before: a quiet machine has less than one.
double load() {
  double minute = 0.0;
  std::ifstream("/proc/loadavg") >> minute;
  return minute;
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&time));
  return text;
}

/// What JSON has no number for: infinity by name, NaN as null.
Json storable(const Json& value) {
  if (!value.is_number_float() || std::isfinite(value.get<double>())) return value;
  return std::isnan(value.get<double>()) ? Json(nullptr) : Json("inf");
}

}  // namespace

Results::Results(int argc, char** argv) : progress_(!isatty(STDOUT_FILENO)) {
  program_ = argv[0];
  program_ = program_.substr(program_.rfind('/') + 1);
  std::string command = program_;
  for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
  std::string head = Json{
      {"program", program_},
      {"command", command},
      {"date", now()},
      {"commit", DRUMHEAD_BENCH_COMMIT},
      {"compiler", DRUMHEAD_BENCH_COMPILER},
      {"processor", processor()},
      {"processors", std::thread::hardware_concurrency()},
      {"load", load()}}.dump(1);
  head.resize(head.rfind('\n'));
  std::printf("%s,\n \"rows\": [", head.c_str());
}

Results::~Results() {
  std::puts("\n]}");
  std::fflush(stdout);
}

void Results::row(std::string_view table, const Json& values) {
  Json row{{"table", table}};
  std::string line;
  for (const auto& [key, value] : values.items()) {
    row[key] = storable(value);
    line += ", " + key + " " + words(row[key]);
  }
  std::printf("%s\n  %s", first_ ? "" : ",", row.dump().c_str());
  std::fflush(stdout);
  first_ = false;
  if (progress_)
    std::fprintf(stderr, "%s: %s\n", program_.c_str(), (std::string(table) + line).c_str());
}

std::string words(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_number()) return "–";
  char text[40];
  std::snprintf(text, sizeof text, value.is_number_integer() ? "%.0f" : "%.3g",
                value.get<double>());
  return text;
}

}  // namespace drumhead::bench
