// SPDX-License-Identifier: MIT
#pragma once
// Other libraries' samplers: a picture by a backward map, as their users call them, one thread.
#include <drumhead/kernels/resample.h>

#include <functional>
#include <string>
#include <vector>

namespace drumhead::bench {

/// Interleaved floats.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;
};

struct Sampler {
  std::string library, filter;
  /// Into `out`, whose pixels are those of the map: `source` holds the source position of each, in
  /// continuous pixels of `picture`.
  std::function<void(const std::vector<kernels::Position>& source, Pixels& out)> sample;
};

/// The ones that were there when this was built. `picture` must outlive them. What a library wants
/// of picture and map in its own form is made on the first call with a map, which is not timed.
std::vector<Sampler> samplers(const Pixels& picture);

}  // namespace drumhead::bench
