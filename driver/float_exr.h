// SPDX-License-Identifier: MIT
#pragma once
// Numbers, not colours, as OpenEXR: 32-bit float, zip, written in bands so that the whole need not
// be in memory.
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "frame.h"

namespace drumhead::driver {

struct FloatExr {
  Frame data;  ///< the data window: the pixels that the file holds
  Frame display;
  std::vector<std::string> channels;
  std::vector<std::pair<std::string, std::string>> header;  ///< further attributes, texts
};

/// fill(first, rows, pixels) sets rows first … first+rows−1 of the data window, counted from its
/// top, channels interleaved. Throws std::runtime_error naming `file`.
void write_float_exr(const FloatExr& exr, const std::filesystem::path& file,
                     const std::function<void(int first, int rows, float* pixels)>& fill);

}  // namespace drumhead::driver
