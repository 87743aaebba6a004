// SPDX-License-Identifier: MIT
#pragma once
// Rows of the kernels' table: Google Benchmark runs them, this reporter prints them as Markdown.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>
#include <vector>

namespace drumhead::bench {

/// One Markdown row a run; a run that found a wrong result says so and is counted.
class MarkdownReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    std::puts(
        "| kernel | lattice | instructions | threads | ns/node | Mnodes/s | B/node | "
        "of streaming | beside |");
    std::puts("|---|---|---|---|---|---|---|---|---|");
    return true;
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.error_occurred) {
        ++failures_;
        std::printf("| %s | wrong: %s |\n", run.benchmark_name().c_str(),
                    run.error_message.c_str());
      } else {
        print(run);
      }
    }
    std::fflush(stdout);
  }
  int failures() const { return failures_; }

 private:
  static double value(const Run& run, const char* name) {
    const auto found = run.counters.find(name);
    return found == run.counters.end() ? 0.0 : found->second.value;
  }
  static void print(const Run& run) {
    const double ns = value(run, "ns"), ratio = value(run, "ratio"), bytes = value(run, "bytes");
    std::printf("| %s | %.2f | %.0f | ", run.report_label.c_str(), ns, 1e3 / ns);
    if (bytes > 0.0)
      std::printf("%.0f | %.2f |", bytes, ratio);
    else
      std::printf("– | – |");
    const struct {
      const char *counter, *format;
    } beside[] = {{"work_units", " %.2f applications"},
                  {"gain", " gain %.2f"},
                  {"stream_gain", ", streaming %.2f"},
                  {"against", " %.1f times our product"}};
    for (const auto& [counter, format] : beside)
      if (const double v = value(run, counter); v > 0.0) std::printf(format, v);
    std::puts(" |");
  }
  int failures_ = 0;
};

}  // namespace drumhead::bench
