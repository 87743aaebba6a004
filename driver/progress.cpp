// SPDX-License-Identifier: MIT
#include "progress.h"

#include <unistd.h>
#include <algorithm>
#include <cmath>
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

void Progress::show(const std::string& phase, double done, const std::string& detail) {
  const auto now = std::chrono::steady_clock::now();
  if (phase != phase_) {
    phase_ = phase;
    phase_start_ = now;
  } else if (now - last_ < std::chrono::milliseconds(50)) {
    return;
  }
  last_ = now;
  const double share = std::clamp(done, 0.0, 1.0);
  std::string text = phase + ' ' + std::to_string(std::lround(100.0 * share)) + " %" + detail;
  // Before, the estimate is worth nothing.
  constexpr double kLeastSeconds = 0.5, kLeastShare = 0.02;
  const double past = std::chrono::duration<double>(now - phase_start_).count();
  if (past >= kLeastSeconds && share >= kLeastShare) {
    text += ", " + duration_in_words(past * (1.0 - share) / share) + " left";
  }
  show(text);
}

void Progress::show(const multigrid::Progress& at) {
  show("solving", at.fraction,
       ", " + std::to_string(at.nx) + " x " + std::to_string(at.ny) + " cells, Newton step " +
           std::to_string(at.newton_step));
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
  if (std::isfinite(report.discretisation_rms_px))
    std::fprintf(stderr, "estimated error %.2f px RMS (solver %.3f px)",
                 report.discretisation_rms_px, report.algebraic_rms_px);
  else
    std::fputs("error not known", stderr);
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

std::string duration_in_words(double seconds) {
  const long whole = std::lround(std::clamp(seconds, 0.0, 1e7));
  char text[40];
  if (whole < 60)
    std::snprintf(text, sizeof text, "%ld s", whole);
  else if (whole < 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld min", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld h", whole / 3600, whole / 60 % 60);
  return text;
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
    case multigrid::Status::cancelled:
      return "interrupted";
    case multigrid::Status::not_finite:
      return "a number that is not finite appeared";
  }
  return "unknown";
}

}  // namespace drumhead::driver
