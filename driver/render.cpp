// SPDX-License-Identifier: MIT
#include "render.h"

#include <algorithm>
#include <limits>

namespace drumhead::driver {
namespace {

struct Range {
  float least = std::numeric_limits<float>::infinity(), greatest = -least;
};

std::vector<Range> ranges(const Image& image) {
  std::vector<Range> all(std::size_t(image.channels()));
  for (std::size_t k = 0; k < image.pixels.size(); k += all.size()) {
    for (std::size_t c = 0; c < all.size(); ++c) {
      const float value = image.pixels[k + c];
      if (value < all[c].least) all[c].least = value;
      if (value > all[c].greatest) all[c].greatest = value;
    }
  }
  return all;
}

void clamp(const std::vector<Range>& ranges, Image& image) {
  for (std::size_t k = 0; k < image.pixels.size(); k += ranges.size()) {
    for (std::size_t c = 0; c < ranges.size(); ++c) {
      float& value = image.pixels[k + c];
      if (value < ranges[c].least) value = ranges[c].least;
      if (value > ranges[c].greatest) value = ranges[c].greatest;
    }
  }
}

}  // namespace

kernels::LatticeMapView map_of(const multigrid::Solution& solution) {
  const grid::Lattice& lattice = solution.lattice;
  return {.u = solution.u_px.data(),
          .v = solution.v_px.data(),
          .nx = lattice.nx,
          .ny = lattice.ny,
          .cell_px = lattice.cell_px,
          .origin_px = {lattice.origin_px.x, lattice.origin_px.y}};
}

Image render(const Image& picture, const multigrid::Solution& solution, int threads) {
  Image warped{picture.spec, std::vector<float>(picture.pixels.size())};
  const std::ptrdiff_t stride = std::ptrdiff_t(picture.width()) * picture.channels();
  const kernels::ImageView source{.data = picture.pixels.data(),
                                  .width = picture.width(),
                                  .height = picture.height(),
                                  .channels = picture.channels(),
                                  .row_stride = stride};
  const kernels::ImageTarget target{.data = warped.pixels.data(),
                                    .width = picture.width(),
                                    .height = picture.height(),
                                    .channels = picture.channels(),
                                    .row_stride = stride};
  kernels::ResampleOptions options;
  options.threads = threads;
  kernels::Resampler(source, map_of(solution), options).render(target);
  clamp(ranges(picture), warped);
  return warped;
}

}  // namespace drumhead::driver
