// SPDX-License-Identifier: MIT
#pragma once
// What a run says on the terminal: one line that follows the work, and a summary. Both only where
// standard error is a terminal and not with --quiet; warnings always.
#include <drumhead/multigrid/warp.h>
#include <chrono>
#include <string>

#include "report.h"

namespace drumhead::driver {

class Progress {
 public:
  explicit Progress(bool quiet);
  /// Clears the line that follows the work.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// "drumhead: text" in place of the line before.
  void show(const std::string& text);
  /// The phase, the share of it that is done, and the time left, reckoned from the time since the
  /// phase was first shown; `detail` goes between. At most twenty times a second.
  void show(const std::string& phase, double done, const std::string& detail = {});
  void show(const multigrid::Progress& at);
  void warn(const std::string& text);
  void summarise(const multigrid::Solution& solution, const Seconds& seconds);

 private:
  void clear();

  bool shown_ = false;
  const bool talking_;
  std::string phase_;
  std::chrono::steady_clock::time_point last_{}, phase_start_{};
};

/// "7 s", "2:05 min" or "1:02 h".
std::string duration_in_words(double seconds);

/// The status in words, for a person.
const char* in_words(multigrid::Status status);

}  // namespace drumhead::driver
