// SPDX-License-Identifier: MIT
#include <array>

#include "keys.h"

namespace drumhead::driver {
namespace {

template <auto Mask>
bool set_mask(const Value& value, Options& o) {
  return set_path(value, "", (o.*Mask).file);
}

template <auto Mask, auto Bound, bool zero_allowed>
bool set_bound(const Value& value, Options& o) {
  const auto x = finite_number(value);
  if (!x || *x < 0 || (*x == 0 && !zero_allowed)) return false;
  (o.*Mask).*Bound = *x;
  return true;
}

template <auto Mask>
bool set_scale(const Value& value, Options& o) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text || (*text != "linear" && *text != "log")) return false;
  (o.*Mask).scale = *text == "log" ? grid::MaskScale::log : grid::MaskScale::linear;
  return true;
}

constexpr std::string_view kScales = "one of: linear, log";

const std::array kKeys = {
    Key{.name = "mu_mask",
        .value = "FILE",
        .bound = kAnyPath,
        .help = "grey picture of the picture's size (.svg: rasterised) that makes mu vary: each "
                "cell takes the mean of its pixels, the margin those of the nearest edge",
        .set = set_mask<&Options::mu_mask>,
        .path = true},
    Key{.name = "mu_black",
        .value = "V",
        .bound = "a finite number above 0",
        .help = "factor of mu where the mask is black",
        .fallback = "1",
        .set = set_bound<&Options::mu_mask, &MaskOptions::black, false>},
    Key{.name = "mu_white",
        .value = "V",
        .bound = "a finite number above 0",
        .help = "factor of mu where the mask is white",
        .fallback = "100",
        .set = set_bound<&Options::mu_mask, &MaskOptions::white, false>},
    Key{.name = "mu_scale",
        .value = "S",
        .bound = kScales,
        .help = "how greys lie between black and white, as the file codes them",
        .fallback = "linear",
        .set = set_scale<&Options::mu_mask>},
    Key{.name = "kappa_mask",
        .value = "FILE",
        .bound = kAnyPath,
        .help = "the same for kappa; each cell takes 1 / the mean of 1/kappa",
        .set = set_mask<&Options::kappa_mask>,
        .path = true},
    Key{.name = "kappa_black",
        .value = "V",
        .bound = "a finite number, 0 or above",
        .help = "kappa where the mask is black, in units of mu (of the scene's, not of its mask)",
        .fallback = "kappa",
        .set = set_bound<&Options::kappa_mask, &MaskOptions::black, true>},
    Key{.name = "kappa_white",
        .value = "V",
        .bound = "a finite number, 0 or above",
        .help = "kappa where the mask is white; 1e4 is as good as incompressible (inf would leave "
                "greys without a value)",
        .fallback = "1000",
        .set = set_bound<&Options::kappa_mask, &MaskOptions::white, true>},
    Key{.name = "kappa_scale",
        .value = "S",
        .bound = kScales,
        .help = "as --mu-scale; log needs black and white above 0",
        .fallback = "linear",
        .set = set_scale<&Options::kappa_mask>},
};

}  // namespace

std::span<const Key> mask_keys() { return kKeys; }

}  // namespace drumhead::driver
