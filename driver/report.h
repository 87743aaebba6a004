// SPDX-License-Identifier: MIT
#pragma once
// The report of a run as JSON. Keys are fixed: some may be added, none renamed. Numbers that are
// not finite are written as null (an exact Hessian's theta is one).
#include <drumhead/multigrid/warp.h>
#include <filesystem>
#include <optional>
#include <string>

#include "maps.h"

namespace drumhead::driver {

struct Seconds {
  double read = 0.0, cut = 0.0, solve = 0.0, render = 0.0, write = 0.0, total = 0.0;
};

/// The maps that were written.
struct MapReport {
  MapFormat format;
  RoundTrip round_trip;
};

/// `frame`: the pixels of the warped picture; the key "maps" is there only with `maps`.
std::string report_json(const multigrid::Solution& solution, const Frame& frame,
                        const Seconds& seconds, const std::optional<MapReport>& maps);

/// Throws std::runtime_error naming `file`.
void write_text(const std::string& text, const std::filesystem::path& file);

}  // namespace drumhead::driver
