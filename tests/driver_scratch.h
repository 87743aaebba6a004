// SPDX-License-Identifier: MIT
#pragma once
// A folder for one test, and the executable run in it.
#include <filesystem>
#include <string>
#include <vector>

namespace drumhead::driver {

/// A new folder, removed with all it holds.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const;
  /// Names of all files, sorted.
  std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
};

std::string read_text(const std::filesystem::path& file);

struct RunResult {
  int exit_code = -1;
  std::string out, err;
};

/// Runs a program in the scratch folder, without a terminal; words[0] is looked for in PATH. Where
/// there is no such program, the exit code is 127.
RunResult run_program(const Scratch& scratch, std::vector<std::string> words);

/// Runs `drumhead words…` so.
RunResult run_drumhead(const Scratch& scratch, const std::vector<std::string>& words);

/// An SVG of width × height user units.
std::string drawing(int width, int height, const std::string& elements);

/// What f() throws, or "nothing was thrown".
template <class F>
std::string message_of(const F& f) {
  try {
    f();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace drumhead::driver
