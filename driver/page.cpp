// SPDX-License-Identifier: MIT
#include "page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "canvas.h"
#include "html.h"
#include "page_plot.h"
#include "page_template.h"

namespace drumhead::driver {
namespace {

using Json = nlohmann::ordered_json;
using html::data_uri, html::escaped, html::filled;

/// null, which stands for what is not finite, as a dash.
std::string number(const Json& value, const char* unit = "") {
  if (!value.is_number()) return value.is_string() ? escaped(value.get<std::string>()) : "–";
  char text[40];
  if (value.is_number_integer())
    std::snprintf(text, sizeof text, "%lld", value.get<long long>());
  else
    std::snprintf(text, sizeof text, std::abs(value.get<double>()) < 1000 ? "%.3g" : "%.0f",
                  value.get<double>());
  return std::string(text) + (*unit ? " " + std::string(unit) : "");
}

double value_of(const Json& value) { return value.is_number() ? value.get<double>() : NAN; }

std::string place(const Json& position) {
  if (!position.at(0).is_number() || !position.at(1).is_number()) return "–";
  char text[80];
  std::snprintf(text, sizeof text, "(%.1f, %.1f)", position.at(0).get<double>(),
                position.at(1).get<double>());
  return text;
}

std::string level_name(const Json& level) {
  const int nx = level.at("nx"), ny = level.at("ny");
  return nx == ny ? std::to_string(nx) + "²" : std::to_string(nx) + "×" + std::to_string(ny);
}

/// A plot of `key` of every Newton step; the marks carry `label`.
Plot plot_of(const Json& report, const char* title, const char* key, const char* label) {
  Plot plot{.title = title};
  for (const Json& level : report.at("levels")) {
    PlotLevel steps{level_name(level), {}};
    for (const Json& step : level.at("newton")) {
      steps.steps.push_back({value_of(step.at(key)), *label ? number(step.at(label)) : ""});
    }
    plot.levels.push_back(std::move(steps));
  }
  return plot;
}

std::string curve_table(const Json& report) {
  std::string rows =
      "<table id=\"curves\"><thead><tr><th>curve</th><th class=\"number\">length, px</th>"
      "<th class=\"number\">gap RMS, px</th><th class=\"number\">gap max, px</th>"
      "<th class=\"number\">where on the source, px</th></tr></thead>\n<tbody>";
  const auto cell = [](const std::string& text) {
    return "<td class=\"number\">" + text + "</td>";
  };
  for (const Json& curve : report.at("curves")) {
    rows += "<tr><td>" + escaped(curve.at("name").get<std::string>()) + "</td>" +
            cell(number(curve.at("length_px"))) + cell(number(curve.at("gap_rms_px"))) +
            cell(number(curve.at("gap_max_px"))) + cell(place(curve.at("worst_px"))) + "</tr>\n";
  }
  return rows + "</tbody></table>";
}

class Table {
 public:
  explicit Table(const char* head) {
    text_ = std::string("<table><thead><tr><th colspan=\"2\">") + head + "</th></tr></thead>\n";
  }
  Table& row(const char* name, const std::string& value) {
    text_ += std::string("<tr><td>") + name + "</td><td class=\"number\">" + value + "</td></tr>\n";
    return *this;
  }
  std::string text() const { return text_ + "</table>\n"; }

 private:
  std::string text_;
};

std::string mebibytes(const Json& bytes) {
  return number(Json(value_of(bytes) / (1 << 20)), "MiB");
}

std::string numbers(const Json& r) {
  const Json &error = r.at("error_px"), &folds = r.at("folds"), &energy = r.at("energy");
  const Json &seconds = r.at("seconds"), &memory = r.at("memory"), &lattice = r.at("lattice");
  Table what("Scene");
  what.row("model", escaped(r.at("model").get<std::string>()))
      .row("exact curves", r.at("exact").get<bool>() ? "yes" : "no")
      .row("lattice", number(lattice.at("nx")) + " × " + number(lattice.at("ny")) + " cells")
      .row("side of a cell", number(lattice.at("cell_px"), "px"))
      .row("lattice’s corner", place(lattice.at("origin_px")) + " px")
      .row("levels", number(lattice.at("levels")));
  Table errors("Errors, estimated");
  errors.row("lattice, RMS", number(error.at("discretisation_rms"), "px"))
      .row("lattice, max", number(error.at("discretisation_max"), "px"))
      .row("solver, RMS", number(error.at("algebraic_rms"), "px"))
      .row("solver, max", number(error.at("algebraic_max"), "px"));
  Table folded("Folds");
  folded.row("folded cells (det J &lt; 0 at a corner)", number(folds.at("folded_cells")))
      .row("inverted cells (at the centre)", number(folds.at("inverted_cells")))
      .row("least det J at a centre", number(folds.at("min_J")))
      .row("least det J at a corner", number(folds.at("min_corner_J")));
  if (!folds.at("places_px").empty()) {
    folded.row("for example at", place(folds.at("places_px").at(0)) + " px");
  }
  Table energies("Energy, per mu and area");
  for (const char* part : {"total", "elastic", "volume", "constraint"}) {
    energies.row(part, number(energy.at(part)));
  }
  Table time("Time");
  for (const char* phase : {"read", "cut", "solve", "render", "write", "total"}) {
    time.row(phase, number(seconds.at(phase), "s"));
  }
  time.row("work units (products with the Hessian)", number(r.at("work_units")))
      .row("one work unit", number(Json(1e3 * value_of(r.at("work_unit_seconds"))), "ms"));
  Table machine("Memory and processor");
  machine.row("solver", mebibytes(memory.at("solver_bytes")))
      .row("solver, per node", number(memory.at("bytes_per_node"), "bytes"))
      .row("whole run, at its peak", mebibytes(memory.at("peak_rss_bytes")))
      .row("instruction set", number(r.at("isa")))
      .row("threads", number(r.at("threads")));
  return what.text() + errors.text() + folded.text() + energies.text() + time.text() +
         machine.text();
}

std::string notes(const Json& report) {
  if (report.at("notes").empty()) return {};
  std::string list = "<h2>Notes</h2>\n<ul id=\"notes\">";
  for (const Json& note : report.at("notes")) {
    list += "<li>" + escaped(note.get<std::string>()) + "</li>\n";
  }
  return list + "</ul>";
}

std::string summary(const Json& r) {
  const Json &lattice = r.at("lattice"), &folds = r.at("folds");
  std::string text = number(r.at("seconds").at("total"), "s") + " on " + number(lattice.at("nx")) +
                     " × " + number(lattice.at("ny")) + " cells; estimated error " +
                     number(r.at("error_px").at("discretisation_rms"), "px") + " RMS";
  double gap = -1.0;
  std::string worst;
  for (const Json& curve : r.at("curves")) {
    if (!(value_of(curve.at("gap_max_px")) > gap)) continue;
    gap = value_of(curve.at("gap_max_px"));
    worst = curve.at("name").get<std::string>();
  }
  if (gap >= 0.0) {
    text += "; largest gap " + number(Json(gap), "px") + ", curve “" + escaped(worst) + "”";
  }
  return text + (folds.at("folded_cells") == 0
                     ? "; no folds."
                     : "; " + number(folds.at("folded_cells")) + " folded cells.");
}

/// JSON that a script element can hold: no "</script" and no "<!--".
std::string for_script(const std::string& json) {
  std::string safe;
  for (const char c : json) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

}  // namespace

std::string page_html(const std::string& title, const std::string& report,
                      const PagePictures& pictures) {
  const Json r = Json::parse(report);
  Plot steps = plot_of(r, "step, RMS over the nodes, px", "dx_rms_px", "");
  steps.bound = value_of(r.at("error_px").at("discretisation_rms"));
  steps.bound_name = "estimated error of the lattice";
  const Plot residuals = plot_of(r, "relative residual left; cycles", "residual", "krylov");
  return filled(kPageTemplate, {{"title", escaped(title)},
                                {"status", escaped(r.at("status").get<std::string>())},
                                {"summary", summary(r)},
                                {"width", std::to_string(Canvas::kPageSide)},
                                {"before", data_uri(pictures.before)},
                                {"after", data_uri(pictures.after)},
                                {"overlay", data_uri(pictures.overlay)},
                                {"jacobian", data_uri(pictures.jacobian)},
                                {"step_plot", svg_of(steps)},
                                {"residual_plot", svg_of(residuals)},
                                {"curves", curve_table(r)},
                                {"numbers", numbers(r)},
                                {"notes", notes(r)},
                                {"version", escaped(r.at("version").get<std::string>())},
                                {"report", for_script(report)}});
}

}  // namespace drumhead::driver
