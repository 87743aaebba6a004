// SPDX-License-Identifier: MIT
#include "progress.h"

#include <unistd.h>
#include <algorithm>
#include <cstdio>

namespace drumhead::driver {

Progress::Progress(bool quiet) : talking_(!quiet && isatty(STDERR_FILENO)) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Progress::show(const std::string& text) {
  if (!talking_) return;
  std::fprintf(stderr, "\r\033[Kdrumhead: %s", text.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void Progress::show(const multigrid::Progress& at) {
  const auto now = std::chrono::steady_clock::now();
  if (!talking_ || now - last_ < std::chrono::milliseconds(50)) return;
  last_ = now;
  char text[120];
  std::snprintf(text, sizeof text, "solving %3.0f %%, %d x %d cells, Newton step %d",
                100.0 * std::clamp(at.fraction, 0.0, 1.0), at.nx, at.ny, at.newton_step);
  show(text);
}

void Progress::warn(const std::string& text) {
  clear();
  std::fprintf(stderr, "drumhead: warning: %s\n", text.c_str());
}

void Progress::summarise(const multigrid::Solution& solution, const Seconds& seconds) {
  if (!talking_) return;
  clear();
  const multigrid::SolveReport& report = solution.report;
  std::fprintf(
      stderr,
      "%s in %.2f s (read %.2f, cut %.2f, solve %.2f, render %.2f, write %.2f): %d x %d cells, "
      "%.0f work units\n",
      multigrid::name(report.status), seconds.total, seconds.read, seconds.cut, seconds.solve,
      seconds.render, seconds.write, solution.lattice.nx, solution.lattice.ny, report.work_units);
  std::fprintf(stderr, "estimated error %.2f px RMS (solver %.3f px)", report.discretisation_rms_px,
               report.algebraic_rms_px);
  const auto worst =
      std::ranges::max_element(report.curves, {}, &multigrid::CurveReport::gap_max_px);
  if (worst != report.curves.end()) {
    std::fprintf(stderr, "; largest gap %.2f px, curve '%s' at (%.0f, %.0f)", worst->gap_max_px,
                 worst->name.c_str(), worst->worst_px.x, worst->worst_px.y);
  }
  const multigrid::FoldReport& folds = report.folds;
  if (folds.folded_cells == 0) {
    std::fputs("; no folds\n", stderr);
  } else {
    const grid::Point place = folds.places_px.empty() ? grid::Point{} : folds.places_px.front();
    std::fprintf(stderr, "; %d folded cells, %d of them inverted, e.g. at (%.0f, %.0f)\n",
                 folds.folded_cells, folds.inverted_cells, place.x, place.y);
  }
  for (const std::string& note : report.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
}

const char* in_words(multigrid::Status status) {
  switch (status) {
    case multigrid::Status::converged:
      return "converged";
    case multigrid::Status::stalled:
      return "stalled: no further decrease was possible";
    case multigrid::Status::infeasible:
      return "infeasible: the hard curves contradict one another";
    case multigrid::Status::limit:
      return "the limit of steps came before the tolerance was reached";
    case multigrid::Status::not_finite:
      return "a number that is not finite appeared";
  }
  return "unknown";
}

}  // namespace drumhead::driver
