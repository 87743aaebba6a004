// SPDX-License-Identifier: MIT
#include <array>

#include "keys.h"

namespace drumhead::driver {
namespace {

constexpr std::string_view kExr = "the path of an .exr file";

template <auto Field>
bool set_exr(const Value& value, Options& o) {
  return set_path(value, ".exr", o.*Field);
}

bool set_convention(const Value& value, Options& o) {
  const auto* text = std::get_if<std::string>(&value);
  const auto convention = text ? map_convention(*text) : std::nullopt;
  if (convention) o.map_convention = *convention;
  return convention.has_value();
}

bool set_depth(const Value& value, Options&) {
  const auto* text = std::get_if<std::string>(&value);
  return text && *text == "float";
}

const std::array kKeys = {
    Key{.name = "backward_map",
        .value = "EXR",
        .bound = kExr,
        .help = "for every output pixel the source position of its centre: what samplers take "
                "(STMap, remap, mapim); float channels R, G",
        .set = set_exr<&Options::backward_map>,
        .path = true},
    Key{.name = "forward_map",
        .value = "EXR",
        .bound = kExr,
        .help = "for every source pixel the output position of its centre",
        .set = set_exr<&Options::forward_map>,
        .path = true},
    Key{.name = "map_convention",
        .value = "C",
        .bound = "one of: st, pixel, displacement",
        .help = "what R, G are. st: 0 to 1, pixel centres at (i+1/2)/W, G up; pixel: x right, y "
                "down, pixel centres at integers; displacement: position minus the pixel's own, in "
                "pixels, y down",
        .fallback = "st",
        .set = set_convention},
    Key{.name = "map_depth",
        .value = "D",
        .bound = "float, 32 bits: half keeps 11, which misplaces by up to a pixel where the "
                 "picture is 4096 wide",
        .help = "numbers of the maps",
        .fallback = "float",
        .set = set_depth},
    Key{.name = "lattice",
        .value = "EXR",
        .bound = kExr,
        .help =
            "displacement of every lattice node: float channels u, v in picture pixels, y down, "
            "first row the top",
        .set = set_exr<&Options::lattice_file>,
        .path = true},
    Key{.name = "lattice_cells",
        .value = "EXR",
        .bound = kExr,
        .help = "pressure and change of area of every lattice cell: float channels P (in units of "
                "mu), J (at its centre) and corner_J (the least), first row the top",
        .set = set_exr<&Options::lattice_cells>,
        .path = true},
    Key{.name = "lattice_vtk",
        .value = "VTU",
        .bound = "the path of a .vtu or .vts file",
        .help =
            "the same for ParaView: deformed nodes in picture pixels (y down), displacement, P, "
            "J, corner_J; .vtu with the triangles of cells that curves divide, .vts without",
        .set =
            [](const Value& v, Options& o) {
              return set_path(v, ".vtu", o.lattice_vtk) || set_path(v, ".vts", o.lattice_vtk);
            },
        .path = true},
};

}  // namespace

std::span<const Key> map_keys() { return kKeys; }

}  // namespace drumhead::driver
