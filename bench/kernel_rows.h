// SPDX-License-Identifier: MIT
#pragma once
// Rows of the kernels' table: Google Benchmark runs them, this reporter writes them (results.h).
#include <benchmark/benchmark.h>

#include <cstdio>
#include <vector>

#include "results.h"

namespace drumhead::bench {

/// A row a run, its label holding the keys as JSON and its counters the values; a run that found a
/// wrong result is named on standard error instead, and counted.
class RowReporter : public benchmark::BenchmarkReporter {
 public:
  explicit RowReporter(Results& results) : results_(results) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.error_occurred) {
        ++failures_;
        std::fprintf(stderr, "wrong: %s: %s\n", run.benchmark_name().c_str(),
                     run.error_message.c_str());
        continue;
      }
      Json row = Json::parse(run.report_label);
      for (const auto& [name, counter] : run.counters) row[name] = counter.value;
      results_.row("kernels", row);
    }
  }
  int failures() const { return failures_; }

 private:
  Results& results_;
  int failures_ = 0;
};

}  // namespace drumhead::bench
