// SPDX-License-Identifier: MIT
#include "report_summary.h"

#include <algorithm>
#include <cmath>

namespace drumhead::bench {
namespace {

/// The first row of `method` on n cells and that many threads; nullptr if there is none.
const Json* find(const Rows& rows, const std::string& method, int n, int threads) {
  const auto found = std::ranges::find_if(rows, [&](const Json& row) {
    return text(row, "method") == method && value(row, "n") == n &&
           value(row, "threads") == threads;
  });
  return found == rows.end() ? nullptr : &*found;
}

std::string by(double theirs, double ours) { return figure(theirs / ours) + " times"; }

void add_paper(const Rows& rows, std::vector<std::string>& all) {
  const Json* ours = find(rows, "drumhead, averaged", 800, 1);
  const Json* paper = find(rows, "paper, multigrid", 800, 1);
  const Json* rival = find(rows, "paper, PARDISO on a mesh", 800, 1);
  if (!ours || !paper || !rival) return;
  all.push_back("The paper's stretchy sponge at 800² takes " + figure(value(*ours, "seconds")) +
                " s and " + figure(1e-6 * value(*ours, "bytes")) +
                " MB on one thread. The paper printed " + figure(value(*paper, "seconds")) +
                " s and " + figure(1e-6 * value(*paper, "bytes")) + " MB for its own method, " +
                figure(value(*rival, "seconds")) + " s and " +
                figure(1e-6 * value(*rival, "bytes")) +
                " MB for PARDISO on a mesh, on its machine of 2014: part of the ratio is "
                "the machine.");
}

/// The fastest rival on this machine at the largest lattice that it was run on.
void add_rivals(const Rows& rows, std::vector<std::string>& all) {
  const Json* best = nullptr;
  for (const Json& row : rows) {
    const bool peer = !is_ours(row) && !text(row, "method").starts_with("paper");
    if (!peer || value(row, "threads") != 1) continue;
    const bool larger = best && value(row, "n") > value(*best, "n");
    const bool faster = best && value(row, "n") == value(*best, "n") &&
                        value(row, "seconds") < value(*best, "seconds");
    if (!best || larger || faster) best = &row;
  }
  if (!best) return;
  const Json* ours = find(rows, "drumhead, averaged", int(value(*best, "n")), 1);
  if (!ours) return;
  all.push_back("On the same machine, to the same stopping rule, the fastest other solver at " +
                figure(value(*best, "n")) + "² (" + text(*best, "method") + ") takes " +
                figure(value(*best, "seconds")) + " s, drumhead " +
                figure(value(*ours, "seconds")) + " s; that is " +
                by(value(*best, "seconds"), value(*ours, "seconds")) + " the time and " +
                by(value(*best, "bytes"), value(*ours, "bytes")) + " the memory.");
}

void add_precision(const Rows& rows, std::vector<std::string>& all) {
  for (const double wanted : {1.0, 0.1}) {
    const Json* best = nullptr;
    for (const Json& row : rows)
      if (is_ours(row) && text(row, "scene") == "S2" && value(row, "kappa") == 10.0 &&
          text(row, "status") == "converged" && value(row, "rms_px") <= wanted &&
          (!best || value(row, "seconds") < value(*best, "seconds")))
        best = &row;
    if (best)
      all.push_back("The roundabout (90°, kappa/mu 10) is within " + figure(wanted) +
                    " px RMS of its exact solution, in a picture of 1000 px, after " +
                    figure(1e3 * value(*best, "seconds")) + " ms (" + text(*best, "method") + ", " +
                    figure(value(*best, "n")) + "²).");
  }
}

}  // namespace

std::vector<std::string> summary(const Measurements& measured) {
  std::vector<std::string> all;
  const Rows table1 = measured.table("table1");
  add_paper(table1, all);
  add_rivals(table1, all);
  add_precision(measured.table("work_precision"), all);
  const Rows stability = measured.table("stability");
  if (!stability.empty()) {
    const auto passed = std::ranges::count_if(
        stability, [](const Json& row) { return row.value("passed", false); });
    all.push_back(std::to_string(passed) + " of " + std::to_string(stability.size()) +
                  " runs of hard cases (each with curves met both ways) end as the tests expect.");
  }
  return all;
}

std::string machine(const Measurements& measured) {
  std::vector<std::string> processors, commits;
  std::string first, last;
  double load = 0.0;
  for (const Run& run : measured.runs) {
    if (run.processor.empty()) continue;
    const std::string processor =
        run.processor + ", " + std::to_string(run.processors) + " processors, " + run.compiler;
    if (std::ranges::find(processors, processor) == processors.end())
      processors.push_back(processor);
    if (std::ranges::find(commits, run.commit) == commits.end()) commits.push_back(run.commit);
    if (first.empty() || run.date < first) first = run.date;
    last = std::max(last, run.date);
    load = std::max(load, std::isfinite(run.load) ? run.load : 0.0);
  }
  std::string words;
  for (const std::string& processor : processors) words += (words.empty() ? "" : "; ") + processor;
  words += ". Commit";
  for (const std::string& commit : commits) words += " " + commit;
  // Of "2026-11-22T13:46:55Z" the date and the minute.
  const auto minute = [](const std::string& date) {
    return date.size() < 16 ? date : date.substr(0, 10) + " " + date.substr(11, 5);
  };
  words += ", " + minute(first) + (last == first ? "" : " to " + minute(last)) +
           " UTC; greatest load before a program " + figure(load) + ".";
  return words;
}

}  // namespace drumhead::bench
