// SPDX-License-Identifier: MIT
#include "report_page.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <string_view>

#include "html.h"
#include "report_losses.h"
#include "report_page_template.h"
#include "report_plots.h"
#include "report_sheets.h"
#include "report_summary.h"

namespace drumhead::bench {
namespace {

using html::data_uri, html::escaped;

/// Pictures side by side by what stands before the first "-" of their names: face-before,
/// face-after.
std::string gallery(const std::string& folder) {
  std::map<std::string, std::vector<std::filesystem::path>> scenes;
  if (!folder.empty())
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".png") {
        const std::string stem = entry.path().stem().string();
        scenes[stem.substr(0, stem.find('-'))].push_back(entry.path());
      }
  std::string html;
  for (auto& [scene, files] : scenes) {
    const auto place = [](const std::filesystem::path& file) {
      const std::string stem = file.stem().string();
      const std::string_view kind = std::string_view(stem).substr(stem.find('-') + 1);
      return std::pair(kind == "before" ? 0 : kind == "after" ? 1 : 2, stem);
    };
    std::ranges::sort(files, {}, place);
    html += "<h3>" + escaped(scene) + "</h3>\n<div class=\"pictures\">";
    for (const auto& file : files) {
      const std::string stem = file.stem().string();
      std::string kind = stem.find('-') == std::string::npos ? "" : stem.substr(stem.find('-') + 1);
      std::ranges::replace(kind, '-', ' ');
      html += "<figure><img loading=\"lazy\" alt=\"" + escaped(scene + ", " + kind) + "\" src=\"" +
              data_uri(contents(file)) + "\"><figcaption>" + escaped(kind) +
              "</figcaption></figure>\n";
    }
    html += "</div>\n";
  }
  return html;
}

std::string commands(const std::string& programs) {
  return "<p class=\"faint\">Measured by <code>" + escaped(programs) + "</code>.</p>\n";
}

std::string html_with_title(const Sheet& sheet) {
  const std::string note =
      (sheet.note.empty() ? "" : "<p>" + escaped(sheet.note) + "</p>\n") + commands(sheet.command);
  if (sheet.cells.empty())
    return "<h3>" + escaped(sheet.title) + "</h3>\n<p class=\"missing\">Not measured yet.</p>\n" +
           commands(sheet.command);
  if (sheet.detail)
    return "<details><summary>" + escaped(sheet.title) + " (" + std::to_string(sheet.cells.size()) +
           " rows)</summary>\n" + note + html_of(sheet) + "</details>\n";
  return "<h3>" + escaped(sheet.title) + "</h3>\n" + note + html_of(sheet);
}

/// The plots of a section side by side.
std::string figures(const std::vector<ReportPlot>& all, const std::string& section) {
  std::string html;
  for (const ReportPlot& plot : all)
    if (plot.section == section)
      html += "<figure id=\"plot_" + escaped(plot.id) + "\">" + svg_of(plot.plot) + "<figcaption>" +
              escaped(plot.caption) + "</figcaption></figure>\n";
  return html.empty() ? html : "<div class=\"plots\">" + html + "</div>\n";
}

std::string list_of(const std::vector<std::string>& sentences) {
  std::string html = "<ul>";
  for (const std::string& words : sentences) html += "<li>" + escaped(words) + "</li>\n";
  return html + "</ul>\n";
}

std::string lost(const Measurements& measured) {
  // Long lists are folded, so that the short ones are read.
  constexpr std::size_t kShown = 20;
  std::string html;
  for (const Losses& entry : losses(measured)) {
    html += "<h3>" + escaped(entry.where) + "</h3>\n";
    if (entry.words.empty()) {
      html += "<p>Nowhere in what was measured.</p>\n";
    } else if (entry.words.size() <= kShown) {
      html += list_of(entry.words);
    } else {
      html += "<details><summary>" + std::to_string(entry.words.size()) + " places</summary>\n" +
              list_of(entry.words) + "</details>\n";
    }
  }
  return html;
}

std::string runs(const Measurements& measured) {
  std::string html =
      "<div class=\"wide\"><table id=\"runs\"><thead><tr><th>command</th><th>date</th>"
      "<th>commit</th><th>compiler</th><th>processor</th><th class=\"number\">processors</th>"
      "<th class=\"number\">load before</th></tr></thead>\n<tbody>";
  for (const Run& run : measured.runs) {
    html += "<tr>";
    for (const std::string& cell : {run.command, run.date, run.commit, run.compiler, run.processor})
      html += "<td>" + escaped(cell) + "</td>";
    html += "<td class=\"number\">" + (run.processors > 0 ? std::to_string(run.processors) : "–") +
            "</td><td class=\"number\">" + figure(run.load) + "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string page_of(const Measurements& measured, const std::string& pictures) {
  const std::vector<ReportPlot> drawn = plots(measured);
  std::map<std::string, std::string> parts{{"plot_style", plot_style()},
                                           {"summary", list_of(summary(measured))},
                                           {"machine", escaped(machine(measured))},
                                           {"losses", lost(measured)},
                                           {"runs", runs(measured)},
                                           {"gallery", gallery(pictures)}};
  for (const char* section : {"table1", "precision", "precision_more", "scaling", "warps"})
    parts[std::string("plots_") + section] = figures(drawn, section);
  std::string others;
  const std::string placed =
      " table1 table1_memory precision tolerances rates warps warps_short stability study "
      "stability_all ";
  for (const Sheet& sheet : sheets(measured)) {
    if (placed.find(" " + sheet.id + " ") == std::string::npos)
      others += html_with_title(sheet);
    else
      parts["sheet_" + sheet.id] = html_with_title(sheet);
  }
  parts["other_sheets"] = others;
  return html::filled(kReportPageTemplate, parts);
}

}  // namespace drumhead::bench
