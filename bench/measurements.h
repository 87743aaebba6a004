// SPDX-License-Identifier: MIT
#pragma once
// What the benchmarks left (results.h), read back: rows of all files together, and by whom, where
// and when they were measured.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results.h"

namespace drumhead::bench {

/// A run of a program; `load` was the machine's before it, NaN where not known.
struct Run {
  std::string program, command, date, commit, compiler, processor;
  int processors = 0;
  double load = 0.0;
};

using Rows = std::vector<Json>;

struct Measurements {
  std::vector<Run> runs;
  Rows rows;

  Rows table(const std::string& name) const;
};

/// Reads all files. Throws std::runtime_error that names the file and what is wrong in it.
Measurements read_measurements(const std::vector<std::string>& files);

/// A file's bytes. Throws std::runtime_error that names it where it cannot be read or is empty.
std::string contents(const std::filesystem::path& file);

/// A row's text, "" if there is none.
std::string text(const Json& row, const char* key);
/// A row's number, "inf" understood; NaN if there is none.
double value(const Json& row, const char* key);
/// Rows of which `true` holds.
Rows where(const Rows& rows, const std::function<bool(const Json&)>& holds);
/// The row's method and its number of threads.
std::string with_threads(const Json& row);
/// Whether the row's method is drumhead's own.
bool is_ours(const Json& row);

/// Lines of a text that name each different value once, in the order met.
std::vector<std::string> distinct(const Rows& rows, const std::function<std::string(const Json&)>&);

/// A number as people read it: three digits, no exponent between 1e-4 and 1e6; "–" for NaN.
std::string figure(double value);
/// The same of a mean, with the least and the most in brackets where the row has them ("key_least",
/// "key_most").
std::string ranged(const Json& row, const std::string& key);

}  // namespace drumhead::bench
