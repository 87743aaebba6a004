// SPDX-License-Identifier: MIT
#include "options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace drumhead::driver {
namespace {

constexpr int kMostCells = 16384;
constexpr int kMostThreads = 4096;

std::optional<double> number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return double(*whole);
  if (const auto* real = std::get_if<double>(&value); real && !std::isnan(*real)) return *real;
  if (const auto* text = std::get_if<std::string>(&value); text && *text == "inf") {
    return std::numeric_limits<double>::infinity();
  }
  return std::nullopt;
}

bool set_positive(const Value& value, double& field) {
  const auto x = finite_number(value);
  if (!x || *x <= 0) return false;
  field = *x;
  return true;
}

bool set_whole(const Value& value, int most, int& field) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  if (!whole || *whole < 1 || *whole > most) return false;
  field = int(*whole);
  return true;
}

bool set_switch(const Value& value, bool& field) {
  const auto* on = std::get_if<bool>(&value);
  if (on) field = *on;
  return on;
}

bool set_path(const Value& value, const char* extension, std::filesystem::path& field) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text || text->empty()) return false;
  const std::filesystem::path path = *text;
  if (*extension && !has_extension(path, extension)) return false;
  field = path;
  return true;
}

bool set_cells(const Value& value, Options& o) {
  if (!set_whole(value, kMostCells, o.lattice.cells)) return false;
  o.lattice.cell_px = 0.0;  // a flag --cells overrules the scene's cell_size
  return true;
}

bool set_margin(const Value& value, Options& o) {
  const auto x = finite_number(value);
  if (!x || *x < 0) return false;
  o.lattice.margin = *x;
  return true;
}

bool set_model(const Value& value, Options& o) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text || (*text != "crpm" && *text != "harmonic")) return false;
  o.model = *text;
  return true;
}

bool set_kappa(const Value& value, Options& o) {
  const auto x = number(value);
  if (!x || *x < 0) return false;
  o.kappa = *x;
  return true;
}

bool set_weight(const Value& value, Options& o) {
  const auto x = weight_of(value);
  if (x) o.weight = *x;
  return x.has_value();
}

bool set_tolerance(const Value& value, Options& o) {
  if (const auto* text = std::get_if<std::string>(&value); text && *text == "auto") {
    o.tolerance_px = 0.0;
    return true;
  }
  return set_positive(value, o.tolerance_px);
}

template <auto Field>
bool set_file(const Value& value, Options& o) {
  return set_path(value, "", o.*Field);
}

constexpr std::string_view kAnyPath = "the path of a file";

const std::array kKeys = {
    Key{.name = "picture",
        .value = "",
        .bound = kAnyPath,
        .help = "PNG, JPEG, TIFF, EXR …, turned upright as its EXIF says; .svg is rasterised",
        .set = set_file<&Options::picture>,
        .flag = false,
        .path = true},
    Key{.name = "curves",
        .value = "",
        .bound = kAnyPath,
        .help = "SVG with the layers source, target and pin",
        .set = set_file<&Options::curves>,
        .flag = false,
        .path = true},
    Key{.name = "cells",
        .value = "N",
        .bound = "a whole number from 1 to 16384",
        .help = "cells across the longer side of the picture",
        .fallback = "256",
        .set = set_cells},
    Key{.name = "cell_size",
        .value = "PX",
        .bound = "a finite number above 0",
        .help = "side of a cell in picture pixels, instead of --cells",
        .set = [](const Value& v, Options& o) { return set_positive(v, o.lattice.cell_px); }},
    Key{.name = "margin",
        .value = "FRACTION",
        .bound = "a finite number, 0 or above",
        .help =
            "margin on every side, as a fraction of the longer side; 0 holds the picture's edge",
        .fallback = "0.1",
        .set = set_margin},
    Key{.name = "model",
        .value = "M",
        .bound = "one of: crpm, harmonic",
        .help = "membrane: crpm, or harmonic, which is crpm with kappa 0",
        .fallback = "crpm",
        .set = set_model},
    Key{.name = "mu",
        .value = "V",
        .bound = "a finite number above 0",
        .help = "stiffness, the unit of --kappa and --weight",
        .fallback = "1",
        .set = [](const Value& v, Options& o) { return set_positive(v, o.mu); }},
    Key{.name = "kappa",
        .value = "V",
        .bound = "a number, 0 or above, or inf",
        .help = "resistance to change of area, in units of mu; inf: incompressible",
        .fallback = "1",
        .set = set_kappa},
    Key{.name = "weight",
        .value = "D",
        .bound = "a number above 0, or inf",
        .help =
            "stiffness of the curves per length, in units of mu per longer side of the picture; "
            "inf: they are met exactly, as pins always are",
        .fallback = "inf",
        .set = set_weight},
    Key{.name = "exact",
        .value = "",
        .bound = "true or false",
        .help = "curves met to rounding, in double precision; slower",
        .set = [](const Value& v, Options& o) { return set_switch(v, o.exact); }},
    Key{.name = "tolerance",
        .value = "PX",
        .bound = "a finite number above 0, or auto",
        .help = "error that the solver may leave, RMS in picture pixels; auto: a tenth of the "
                "lattice's own error",
        .fallback = "auto",
        .set = set_tolerance},
    Key{.name = "threads",
        .value = "N",
        .bound = "a whole number from 1 to 4096",
        .help = "processor threads",
        .fallback = "as OpenMP decides",
        .set = [](const Value& v, Options& o) { return set_whole(v, kMostThreads, o.threads); }},
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
    Key{.name = "lattice",
        .value = "EXR",
        .bound = "the path of an .exr file",
        .help = "displacement of every lattice node: float channels u, v in picture pixels, first "
                "row the top",
        .set = [](const Value& v, Options& o) { return set_path(v, ".exr", o.lattice_file); },
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

std::optional<double> finite_number(const Value& value) {
  const auto x = number(value);
  return x && std::isfinite(*x) ? x : std::nullopt;
}

std::optional<double> weight_of(const Value& value) {
  const auto x = number(value);
  return x && *x > 0 ? x : std::nullopt;
}

std::span<const Key> keys() { return kKeys; }

const Key* find_key(std::string_view name) {
  const auto found = std::ranges::find(kKeys, name, &Key::name);
  return found == kKeys.end() ? nullptr : &*found;
}

bool has_extension(const std::filesystem::path& file, std::string_view extension) {
  const std::string own = file.extension();
  return std::ranges::equal(own, extension,
                            [](unsigned char a, char b) { return std::tolower(a) == b; });
}

std::string flag_name(const Key& key) {
  std::string flag = "--" + std::string(key.name);
  std::ranges::replace(flag, '_', '-');
  return flag;
}

Value value_of(const Key& key, const std::string& text) {
  if (key.path || !key.flag) return text;
  const char* const end = text.data() + text.size();
  std::int64_t whole = 0;
  if (const auto [stop, error] = std::from_chars(text.data(), end, whole);
      error == std::errc{} && stop == end) {
    return whole;
  }
  double real = 0.0;
  if (const auto [stop, error] = std::from_chars(text.data(), end, real);
      error == std::errc{} && stop == end) {
    return real;
  }
  return text;
}

void set(const Key& key, const Value& value, const std::string& place, Options& options) {
  if (!key.set(value, options)) {
    throw std::invalid_argument(place + ": must be " + std::string(key.bound));
  }
}

}  // namespace drumhead::driver
