// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "keys.h"

namespace drumhead::driver {
namespace {

constexpr std::string_view kPng = "the path of a .png file";

template <auto Field>
bool set_png(const Value& value, Options& o) {
  return set_path(value, ".png", o.*Field);
}

bool set_border(const Value& value, Options& o) {
  using kernels::Border;
  constexpr std::array kBorders{std::pair{"clamp", Border::clamp},
                                std::pair{"mirror", Border::mirror},
                                std::pair{"transparent", Border::transparent}};
  const auto* text = std::get_if<std::string>(&value);
  const auto* found =
      std::ranges::find_if(kBorders, [&](const auto& b) { return text && *text == b.first; });
  if (found == kBorders.end()) return false;
  o.border = found->second;
  return true;
}

const std::array kKeys = {
    Key{.name = "output",
        .value = "FILE",
        .bound = kAnyPath,
        .help =
            "the warped picture, in the format of its extension, size and depth of the input; over "
            "white where the format has no alpha",
        .set = set_file<&Options::output>,
        .path = true},
    Key{.name = "border",
        .value = "B",
        .bound = "one of: clamp, mirror, transparent",
        .help = "what lies beyond the picture: its edge pixels, its mirror image, or nothing (a "
                "picture without alpha then gets one)",
        .fallback = "clamp",
        .set = set_border},
    Key{.name = "expand",
        .value = "",
        .bound = "true or false",
        .help =
            "pictures and maps cover the whole padded domain; in EXR it is the data window, and "
            "the picture stays the display window",
        .set = set_switch<&Options::expand>},
    Key{.name = "linear_light",
        .value = "",
        .bound = "true or false",
        .help = "colours of 8 and 16 bits are decoded from sRGB before they are filtered, and "
                "coded again; those of float pictures are light already and stay as they are",
        .set = set_switch<&Options::linear_light>},
    Key{.name = "overlay",
        .value = "PNG",
        .bound = kPng,
        .help = "the warped picture under the deformed lattice, warped curves and targets",
        .set = set_png<&Options::overlay>,
        .path = true},
    Key{.name = "checkerboard",
        .value = "PNG",
        .bound = kPng,
        .help = "24 squares across the longer side through the warp, coloured by where they were",
        .set = set_png<&Options::checkerboard>,
        .path = true},
    Key{.name = "jacobian",
        .value = "PNG",
        .bound = kPng,
        .help = "det J, the change of area: blue 1/4, white 1, red 4; black turned over, folds "
                "in rings",
        .set = set_png<&Options::jacobian>,
        .path = true},
    Key{.name = "report",
        .value = "JSON",
        .bound = kAnyPath,
        .help = "convergence, errors, gap of every curve, folds, energy, seconds, memory",
        .set = set_file<&Options::report>,
        .path = true},
    Key{.name = "page",
        .value = "HTML",
        .bound = "the path of an .html file",
        .help = "the report as a page, one file: before and after under a slider, overlay, det J, "
                "every Newton step, every curve",
        .set = [](const Value& v, Options& o) { return set_path(v, ".html", o.page); },
        .path = true},
    Key{.name = "quiet",
        .value = "",
        .bound = "true or false",
        .help = "nothing on the terminal but warnings and errors",
        .set = set_switch<&Options::quiet>},
};

}  // namespace

std::span<const Key> output_keys() { return kKeys; }

}  // namespace drumhead::driver
