// SPDX-License-Identifier: MIT
#include "command_line.h"

#include <drumhead/kernels/version.h>
#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <stdexcept>

#include "scene.h"

namespace drumhead::driver {
namespace {

constexpr const char* kUsage =
    "drumhead warp PICTURE CURVES.svg -o OUT [flags]\n"
    "drumhead warp DRAWING.svg -o OUT [flags]          art and curves in one file\n"
    "drumhead warp SCENE.toml [flags]                  a flag overrules the scene's key\n";

constexpr const char* kAbout =
    "drumhead warps a picture by curves: what lies on a source curve is carried to its target,\n"
    "and a nonlinear elastic membrane decides where everything else goes.\n";

constexpr const char* kConventions = R"(
The drawing. Layers (or groups) named source and target, by inkscape:label or id, hold paths and
shapes that are paired by their own label or id; outside layers the suffixes -source and -target do
the same. What lies in a layer named pin holds still. Hidden layers are read like others; all else
is art. The viewBox is stretched onto the picture. Two paths with the same number of segments
correspond segment by segment, others by arc length; closed paths keep their start point.

The scene. TOML; every flag is a key of the same name with _ for - (picture and curves too), and
[[curve]] tables with name, weight and turn (degrees, clockwise) speak of single curves. Paths are
relative to the scene file.

Coordinates. Picture pixels, continuous: 0 at the left and top edge, pixel centres at 1/2, x right,
y down. The lattice covers the picture and its margin, and its outer edge does not move. --lattice
writes (nx+1) x (ny+1) pixels, one a node, --lattice-cells nx x ny, one a cell.

Maps. float32 EXR, channels R, G, of the position (x, y) in the picture of W x H pixels:
st R = x/W, G = 1 - y/H; pixel R = x - 1/2, G = y - 1/2; displacement: (x, y) minus the centre of
the map's pixel. Where the output is folded, a point with positive area wins. The report's
round_trip_px is the distance of forward(backward(pixel)) from the pixel, through the warp itself
and (sampled) through the forward map's pixels.

Exit code. 0 converged; 1 not converged, the best result is written; 2 bad input, nothing is
written. An interrupt (Ctrl-C) while the membrane is solved ends that after the step that it is at,
and what there is is written; a second one, or one at another time, ends the program and leaves
nothing.
)";

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string lines, word;
  std::size_t column = indent;
  while (words >> word) {
    if (column > indent && column + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) lines += ' ', ++column;
    lines += word;
    column += word.size();
  }
  return lines;
}

std::string help() {
  constexpr std::size_t kIndent = 24, kWidth = 100;
  std::string text = std::string(kAbout) + "\n" + kUsage + "\n";
  for (const Key& key : keys()) {
    std::string head = "  ";
    if (!key.flag)
      head += key.name == "picture" ? "PICTURE" : "CURVES.svg";
    else
      head += (key.name == "output" ? "-o, " : "") + flag_name(key);
    if (!key.value.empty()) head += " " + std::string(key.value);
    std::string text_after = key.value.empty() || key.path ? "" : "; " + std::string(key.bound);
    if (!key.fallback.empty()) text_after += " [" + std::string(key.fallback) + "]";
    text += head + std::string(head.size() < kIndent - 1 ? kIndent - head.size() : 1, ' ') +
            wrapped(std::string(key.help) + text_after, kIndent, kWidth) + "\n";
  }
  return text + kConventions;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

struct Given {
  std::vector<std::string> files;
  std::map<std::string_view, std::string> values;
  std::map<std::string_view, bool> switches;
};

void add_flags(CLI::App& warp, Given& given) {
  for (const Key& key : keys()) {
    if (!key.flag) continue;
    const std::string flag = (key.name == "output" ? "-o," : "") + flag_name(key);
    if (key.value.empty()) {
      warp.add_flag(flag, given.switches[key.name]);
    } else {
      warp.add_option(flag, given.values[key.name]);
    }
  }
  warp.add_option("files", given.files)->expected(0, 3);
}

Options options_of(const CLI::App& warp, const Given& given) {
  Options options;
  const auto& files = given.files;
  if (files.empty()) throw std::invalid_argument("warp: no PICTURE and no SCENE.toml was given");
  const bool scene = has_extension(files[0], ".toml");
  if (files.size() > (scene ? 1u : 2u)) {
    throw std::invalid_argument("'" + files[scene ? 1 : 2] + "': too many files; " +
                                (scene ? "a scene names its picture and curves itself"
                                       : "a PICTURE and its CURVES.svg are expected"));
  }
  if (scene) {
    options.scene = files[0];
    read_scene(options.scene, options);
  } else {
    options.picture = files[0];
    if (files.size() == 2) options.curves = files[1];
  }
  if (warp.count("--cells") && warp.count("--cell-size")) {
    throw std::invalid_argument("--cell-size: give either --cells or --cell-size");
  }
  for (const Key& key : keys()) {
    if (!key.flag || !warp.count(flag_name(key))) continue;
    if (key.value.empty()) {
      set(key, true, flag_name(key), options);
    } else {
      const std::string& text = given.values.at(key.name);
      set(key, value_of(key, text), flag_name(key) + " " + text, options);
    }
  }
  return options;
}

}  // namespace

std::optional<Options> read_command_line(int argc, char** argv) {
  CLI::App app;
  app.set_version_flag("--version", std::string("drumhead ") + DRUMHEAD_VERSION);
  CLI::App* warp = app.add_subcommand("warp");
  app.require_subcommand(0, 1);
  Given given;
  add_flags(*warp, given);
  if (argc > 1 && argv[1][0] != '-' && argv[1] != warp->get_name())
    throw std::invalid_argument("no command '" + std::string(argv[1]) +
                                "'; there is warp (see drumhead --help)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << help();
    return std::nullopt;
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw std::invalid_argument(first_line(error.what()) + " (see drumhead --help)");
  }
  if (!warp->parsed()) {
    throw std::invalid_argument("no command was given; there is warp (see drumhead --help)");
  }
  return options_of(*warp, given);
}

}  // namespace drumhead::driver
