// SPDX-License-Identifier: MIT
#include "report_plots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace drumhead::bench {
namespace {

using Line = PlotSeries::Line;
using Name = std::function<std::string(const Json&)>;
using Number = std::function<double(const Json&)>;

// A peer has the same look in every plot.
struct Peer {
  const char* part;  // of the name
  int look;
};
constexpr Peer kPeers[] = {{"paper, PARDISO", 8},
                           {"paper", 6},
                           {"triangle mesh", 4},
                           {"conforming", 0},
                           {"minres-multigrid", 10},
                           {"minres", 9},
                           {"coloured", 11},
                           {"kaczmarz", 8},
                           {"averaged", 1},
                           {"gcr", 1},
                           {"MUMPS", 2},
                           {"UMFPACK", 3},
                           {"CHOLMOD", 3},
                           {"PARDISO", 7},
                           {"Boomer", 12},
                           {"AMG", 5},
                           {"OpenCV", 2},
                           {"thin-plate", 4},
                           {"similarity", 8},
                           {"moving least", 5},
                           {"Shepard", 7}};

int look_of(const std::string& name) {
  for (const Peer& peer : kPeers)
    if (name.find(peer.part) != std::string::npos) return peer.look;
  return 6;
}

Number number_of(const char* key, double scale = 1.0) {
  return [=](const Json& row) { return scale * value(row, key); };
}

/// Rows as lines: one for each name, its points from left to right.
std::vector<PlotSeries> lines_of(const Rows& rows, const Name& name, const Number& x,
                                 const Number& y, const Name& label = {}) {
  std::vector<PlotSeries> all;
  for (const std::string& line : distinct(rows, name)) {
    PlotSeries series{line, look_of(line), Line::solid, {}};
    for (const Json& row : rows)
      if (name(row) == line && std::isfinite(x(row)) && std::isfinite(y(row)))
        series.points.push_back({x(row), y(row), label ? label(row) : ""});
    std::ranges::stable_sort(series.points, {}, &PlotPoint::x);
    if (!series.points.empty()) all.push_back(std::move(series));
  }
  return all;
}

bool solved(const Json& row) {
  const std::string status = text(row, "status");
  return status.empty() || status == "converged";
}

/// Solves on more than one thread are dashed.
void dash_threads(std::vector<PlotSeries>& lines) {
  for (PlotSeries& line : lines)
    if (!line.name.ends_with(", 1 thread")) line.line = Line::dashed;
}

void add_table1(const Measurements& measured, std::vector<ReportPlot>& all) {
  const Rows rows = where(measured.table("table1"), solved);
  ReportPlot time{"speed",
                  "table1",
                  "The paper's curves are from its own machine (six cores, 2014).",
                  {.title = "Whole solve of the sponge",
                   .x_name = "cells across the picture",
                   .y_name = "seconds",
                   .x_at_points = true,
                   .series = lines_of(rows, with_threads, number_of("n"), number_of("seconds"))},
                  true};
  dash_threads(time.plot.series);
  all.push_back(std::move(time));

  ReportPlot bytes{"memory",
                   "scaling",
                   "The solver's peak by the nodes (of a mesh: vertices, of the paper: its mesh's "
                   "and its lattice's) that it solves for.",
                   {.title = "Memory per node, the sponge",
                    .x_name = "cells across the picture",
                    .y_name = "bytes per node",
                    .x_at_points = true}};
  const auto one = [](const Json& row) { return value(row, "threads") == 1; };
  bytes.plot.series =
      lines_of(where(rows, one), Name([](const Json& r) { return text(r, "method"); }),
               number_of("n"), number_of("bytes_per_node"));
  all.push_back(std::move(bytes));

  const auto gain = [&](const Json& row) {
    for (const Json& alone : rows)
      if (value(alone, "threads") == 1 && text(alone, "method") == text(row, "method") &&
          value(alone, "n") == value(row, "n"))
        return value(alone, "seconds") / value(row, "seconds");
    return std::nan("");
  };
  const auto several = [](const Json& row) { return value(row, "threads") > 1; };
  all.push_back({"threads",
                 "scaling",
                 "Seconds on one thread by seconds on that many.",
                 {.title = "Gain of threads, the sponge",
                  .x_name = "cells across the picture",
                  .y_name = "times faster than one thread",
                  .log_y = false,
                  .x_at_points = true,
                  .series = lines_of(where(rows, several), with_threads, number_of("n"), gain)}});
}

const struct {
  const char* scene;
  double kappa;
  const char* words;
} kScenes[] = {{"S2", 10.0, "roundabout turned by 90°, kappa/mu 10"},
               {"S4", 10.0, "disc moved, kappa/mu 10"},
               {"S1", 1.0, "sponge, kappa/mu 1"}};

/// Words of a scene that stands alone in its plot.
std::string words_of(const std::string& scene) {
  for (const auto& known : kScenes)
    if (scene == known.scene)
      return std::string(known.words).substr(0, std::string(known.words).find(','));
  return scene;
}

void add_precision(const Measurements& measured, std::vector<ReportPlot>& all) {
  const Rows every = where(measured.table("work_precision"), solved);
  const struct {
    const char *id, *section, *key, *words;
  } errors[] = {{"precision", "precision", "rms_px", "RMS error"},
                {"precision_max", "precision_more", "max_px", "Largest error"},
                {"precision_gap", "precision_more", "gap_rms_px", "Curve gap, RMS"}};
  for (const auto& error : errors)
    for (const auto& scene : kScenes) {
      const Rows rows = where(every, [&](const Json& row) {
        return text(row, "scene") == scene.scene && value(row, "kappa") == scene.kappa;
      });
      const std::string id = std::string(error.id) + "_" + scene.scene;
      ReportPlot plot{
          id,
          error.section,
          "",
          {.title = std::string(error.words) + ": " + scene.words,
           .x_name = "seconds, one thread",
           .y_name = std::string(error.words) + ", px of 1000",
           .series = lines_of(
               rows, [](const Json& row) { return text(row, "method"); }, number_of("seconds"),
               number_of(error.key), [](const Json& row) { return figure(value(row, "n")); })},
          id == "precision_S2"};
      // Only the two ways to meet curves carry their lattices: the others' are the same.
      for (PlotSeries& line : plot.plot.series)
        if (line.name != "drumhead, averaged" && line.name != "drumhead, conforming")
          for (PlotPoint& point : line.points) point.label.clear();
      all.push_back(std::move(plot));
    }
}

void add_tolerances(const Measurements& measured, std::vector<ReportPlot>& all) {
  const Rows rows = where(measured.table("tolerances"), solved);
  all.push_back(
      {"tolerances",
       "precision",
       "Beside the marks: the tolerance in px, on one lattice. Where a line is level, the "
       "lattice's own error is all that is left.",
       {.title = "RMS error over tolerances: roundabout, 400²",
        .x_name = "seconds, one thread",
        .y_name = "RMS error, px of 1000",
        .series = lines_of(
            rows, [](const Json& row) { return text(row, "method"); }, number_of("seconds"),
            number_of("rms_px"),
            [](const Json& row) { return figure(value(row, "tolerance_px")); })}});
}

/// d of the curves; they are hard where a row names none, and then may be exact.
double weight_of(const Json& row) {
  return row.contains("weight") ? value(row, "weight") : std::numeric_limits<double>::infinity();
}
bool exact(const Json& row) { return row.value("exact", false); }
bool hard(const Json& row) { return std::isinf(weight_of(row)) && !exact(row); }
bool soft(const Json& row) { return std::isfinite(weight_of(row)); }
std::string stiffness_of(const Json& row) {
  return exact(row) ? "exact" : hard(row) ? "hard" : figure(weight_of(row));
}

/// Lines, one for each kappa/mu, in colours that follow it.
std::vector<PlotSeries> lines_of_kappas(const Rows& rows, const Number& x, const Number& y) {
  std::vector<PlotSeries> lines = lines_of(
      rows, [](const Json& row) { return "kappa/mu " + figure(value(row, "kappa")); }, x, y);
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k].look = int(k);
  return lines;
}

void add_rates_over_lattices(const Rows& every, const Number& rate, std::vector<ReportPlot>& all) {
  const Rows roundabout =
      where(every, [](const Json& row) { return hard(row) && text(row, "scene") == "S2"; });
  const auto solver = [](const Json& row) { return text(row, "solver"); };
  ReportPlot solvers{"rates_n",
                     "scaling",
                     "One Newton system of the roundabout at kappa/mu 1, hard curves.",
                     {.title = "Work for a factor of ten over lattices",
                      .x_name = "cells across the picture",
                      .y_name = "work units per digit",
                      .x_at_points = true}};
  solvers.plot.series =
      lines_of(where(roundabout, [](const Json& row) { return value(row, "kappa") == 1.0; }),
               solver, number_of("n"), rate);
  all.push_back(std::move(solvers));
  for (const char* name : {"gcr", "gcr, conforming curves"}) {
    const bool averaged = std::string(name) == "gcr";
    ReportPlot kappas{averaged ? "rates_n_kappa" : "rates_n_kappa_conforming",
                      "scaling",
                      "One Newton system of the roundabout, hard curves.",
                      {.title = std::string("The same of gcr, ") +
                                (averaged ? "averaged" : "conforming") + " curves, by kappa/mu",
                       .x_name = "cells across the picture",
                       .y_name = "work units per digit",
                       .x_at_points = true}};
    kappas.plot.series =
        lines_of_kappas(where(roundabout, [&](const Json& row) { return solver(row) == name; }),
                        number_of("n"), rate);
    all.push_back(std::move(kappas));
  }
}

void add_rates_over_kappa(const Rows& every, const Number& rate, std::vector<ReportPlot>& all) {
  const Rows roundabout = where(every, [](const Json& row) {
    return hard(row) && text(row, "scene") == "S2" && value(row, "n") == 128;
  });
  ReportPlot kappas{"scaling",
                    "scaling",
                    "One Newton system of the roundabout at 128². Where a line ends, the method "
                    "does not converge.",
                    {.title = "Work for a factor of ten over kappa/mu",
                     .x_name = "kappa/mu",
                     .y_name = "work units per digit"},
                    true};
  kappas.plot.x_words =
      distinct(roundabout, [](const Json& row) { return figure(value(row, "kappa")); });
  const auto place = [words = kappas.plot.x_words](const Json& row) {
    return double(std::ranges::find(words, figure(value(row, "kappa"))) - words.begin());
  };
  kappas.plot.series = lines_of(
      roundabout, [](const Json& row) { return text(row, "solver"); }, place, rate);
  all.push_back(std::move(kappas));
}

void add_rates_over_weights(const Rows& every, const Number& rate, std::vector<ReportPlot>& all) {
  const Rows tried = where(every, [](const Json& row) {
    return text(row, "solver") == "gcr" && text(row, "scene") == "S2" && value(row, "n") == 128;
  });
  // Hard curves alone are no scan of d.
  if (std::ranges::none_of(tried, soft)) return;
  ReportPlot weights{
      "rates_d",
      "scaling",
      "One Newton system of the roundabout at 128², gcr, averaged curves. Hard: d 1e6 with the "
      "q-jump; exact: rows without both, in double precision.",
      {.title = "Work for a factor of ten over the curves' stiffness d",
       .x_name = "d, stiffness per length, in mu per picture side",
       .y_name = "work units per digit"}};
  Rows ascending = tried;
  std::ranges::stable_sort(ascending, {},
                           [](const Json& row) { return std::pair(weight_of(row), exact(row)); });
  weights.plot.x_words = distinct(ascending, stiffness_of);
  const auto stiffness = [words = weights.plot.x_words](const Json& row) {
    return double(std::ranges::find(words, stiffness_of(row)) - words.begin());
  };
  weights.plot.series = lines_of_kappas(ascending, stiffness, rate);
  all.push_back(std::move(weights));
}

void add_rates(const Measurements& measured, std::vector<ReportPlot>& all) {
  const Rows every =
      where(measured.table("rates"), [](const Json& row) { return row.value("converged", true); });
  const Number rate = number_of("work_units_per_digit");
  add_rates_over_kappa(every, rate, all);
  add_rates_over_lattices(every, rate, all);
  add_rates_over_weights(every, rate, all);
}

void add_warps(const Measurements& measured, std::vector<ReportPlot>& all) {
  for (const std::string& scene :
       distinct(measured.table("warps"), [](const Json& row) { return text(row, "scene"); })) {
    const Rows rows = where(measured.table("warps"),
                            [&](const Json& row) { return text(row, "scene") == scene; });
    // The others' points are the same.
    const auto label = [](const Json& row) {
      return row.contains("kappa")                        ? "κ " + figure(value(row, "kappa"))
             : text(row, "method") == "thin-plate spline" ? figure(value(row, "points"))
                                                          : std::string();
    };
    all.push_back({"warps_" + scene,
                   "warps",
                   "",
                   {.title = "How far curves are missed: " + words_of(scene),
                    .x_name = "seconds, one thread",
                    .y_name = "curve gap, RMS, px of 1000",
                    .series = lines_of(
                        rows, [](const Json& row) { return text(row, "method"); },
                        number_of("seconds"), number_of("gap_rms_px"), label)}});
  }
}

}  // namespace

std::vector<ReportPlot> plots(const Measurements& measured) {
  std::vector<ReportPlot> all;
  add_table1(measured, all);
  add_precision(measured, all);
  add_tolerances(measured, all);
  add_rates(measured, all);
  add_warps(measured, all);
  std::erase_if(all, [](const ReportPlot& plot) { return plot.plot.series.empty(); });
  return all;
}

}  // namespace drumhead::bench
