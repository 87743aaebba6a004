// SPDX-License-Identifier: MIT
// Makes one page, or Markdown tables, of what the benchmarks left as JSON (results.h):
//   report -o PAGE.html [--pictures FOLDER] [--plots FOLDER] FILE.json…
//   report --markdown FILE.json…          every table
//   report --readme README.md FILE.json…  the README with its tables made anew
// --pictures: PNG files that the page shall show. --plots: where the README's plots go, as SVG.
// Exit code 2: an argument, or a file that is not as it should be (named); nothing is written.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "report_page.h"
#include "report_plots.h"
#include "report_readme.h"
#include "report_sheets.h"
#include "report_summary.h"

namespace drumhead::bench {
namespace {

struct Arguments {
  bool markdown = false;
  std::string page, readme, pictures, plots;
  std::vector<std::string> files;
};

Arguments parsed(int argc, char** argv) {
  Arguments arguments;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    std::string* into = word == "-o"           ? &arguments.page
                        : word == "--readme"   ? &arguments.readme
                        : word == "--pictures" ? &arguments.pictures
                        : word == "--plots"    ? &arguments.plots
                                               : nullptr;
    if (into && k + 1 < argc)
      *into = argv[++k];
    else if (word == "--markdown")
      arguments.markdown = true;
    else if (!into && !word.starts_with("-"))
      arguments.files.emplace_back(word);
    else
      throw std::runtime_error(std::string(word) + ": not understood, or without its value");
  }
  if (arguments.files.empty() ||
      arguments.markdown + !arguments.readme.empty() + !arguments.page.empty() != 1)
    throw std::runtime_error(
        "wanted: FILE.json… and one of -o PAGE.html, --markdown, --readme README.md");
  return arguments;
}

/// The file is there whole or as it was before.
void write(const std::string& file, const std::string& text) {
  const std::string part = file + ".part";
  std::ofstream stream(part, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file + ": cannot be written");
  std::filesystem::rename(part, file);
}

void print_markdown(const Measurements& measured) {
  std::printf("%s\n\n", machine(measured).c_str());
  for (const Sheet& sheet : sheets(measured))
    if (!sheet.cells.empty())
      std::printf("### %s\n\n%s%s%s\n", sheet.title.c_str(), sheet.note.c_str(),
                  sheet.note.empty() ? "" : "\n\n", markdown_of(sheet).c_str());
}

void run(const Arguments& arguments) {
  const Measurements measured = read_measurements(arguments.files);
  if (arguments.markdown) {
    print_markdown(measured);
    return;
  }
  if (!arguments.readme.empty()) {
    write(arguments.readme, with_tables(contents(arguments.readme), measured));
    return;
  }
  const std::string page = page_of(measured, arguments.pictures);
  if (!arguments.plots.empty())
    for (const ReportPlot& plot : plots(measured))
      if (plot.readme) write(arguments.plots + "/" + plot.id + ".svg", svg_file_of(plot.plot));
  write(arguments.page, page);
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) try {
  using namespace drumhead::bench;
  run(parsed(argc, argv));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "report: %s\n", error.what());
  return 2;
}
