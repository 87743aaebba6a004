// SPDX-License-Identifier: MIT
#include <array>

#include "keys.h"

namespace drumhead::driver {
namespace {

const std::array kKeys = {
    Key{.name = "output",
        .value = "FILE",
        .bound = kAnyPath,
        .help =
            "the warped picture, in the format of its extension, size and depth of the input; over "
            "white where the format has no alpha",
        .set = set_file<&Options::output>,
        .path = true},
    Key{.name = "overlay",
        .value = "PNG",
        .bound = "the path of a .png file",
        .help = "the warped picture under the deformed lattice, warped curves and targets",
        .set = [](const Value& v, Options& o) { return set_path(v, ".png", o.overlay); },
        .path = true},
    Key{.name = "report",
        .value = "JSON",
        .bound = kAnyPath,
        .help = "convergence, errors, gap of every curve, folds, energy, seconds, memory",
        .set = set_file<&Options::report>,
        .path = true},
    Key{.name = "quiet",
        .value = "",
        .bound = "true or false",
        .help = "nothing on the terminal but warnings and errors",
        .set = [](const Value& v, Options& o) { return set_switch(v, o.quiet); }},
};

}  // namespace

std::span<const Key> output_keys() { return kKeys; }

}  // namespace drumhead::driver
