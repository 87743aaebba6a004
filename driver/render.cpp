// SPDX-License-Identifier: MIT
#include "render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace drumhead::driver {
namespace {

constexpr double kGreatestSide = 65535;

kernels::ImageView view_of(const Image& picture) {
  return {.data = picture.pixels.data(),
          .width = picture.width(),
          .height = picture.height(),
          .channels = picture.channels(),
          .row_stride = std::ptrdiff_t(picture.width()) * picture.channels()};
}

kernels::ResampleOptions resample_options(kernels::Border border, int threads) {
  kernels::ResampleOptions options;
  options.border = border;
  options.threads = threads;
  return options;
}

OIIO::ImageSpec spec_of(const Image& picture, const Frame& frame) {
  OIIO::ImageSpec spec = picture.spec;
  spec.x += frame.left;
  spec.y += frame.top;
  spec.width = frame.width;
  spec.height = frame.height;
  return spec;
}

}  // namespace

Frame frame_of(const Image& picture, const grid::Lattice& lattice, bool expand) {
  if (!expand) return {0, 0, picture.width(), picture.height()};
  const double width = lattice.nx * lattice.cell_px, height = lattice.ny * lattice.cell_px;
  if (std::max(width, height) > kGreatestSide) {
    throw std::invalid_argument(
        "expand: the padded domain has " + std::to_string(std::llround(width)) + " x " +
        std::to_string(std::llround(height)) + " pixels; a side must have at most 65535");
  }
  return padded_frame(lattice);
}

Renderer::Renderer(const Image& picture, const multigrid::Solution& solution, const Frame& frame,
                   kernels::Border border, int threads)
    : frame_(frame),
      spec_(spec_of(picture, frame)),
      decoded_(picture.decoded),
      resampler_(view_of(picture), map_of(solution), resample_options(border, threads)) {
  const auto channels = std::size_t(picture.channels());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const bool zero = border == kernels::Border::transparent;
  ranges_.assign(channels, zero ? Range{0.0f, 0.0f} : Range{kInfinity, -kInfinity});
  for (std::size_t k = 0; k < picture.pixels.size(); k += channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      const float value = picture.pixels[k + c];
      if (value < ranges_[c].least) ranges_[c].least = value;
      if (value > ranges_[c].greatest) ranges_[c].greatest = value;
    }
  }
}

std::vector<float> Renderer::rows(int top, int height) const {
  const auto channels = std::size_t(spec_.nchannels);
  const std::size_t stride = std::size_t(frame_.width) * channels;
  std::vector<float> pixels(stride * std::size_t(height));
  resampler_.render({.data = pixels.data(),
                     .width = frame_.width,
                     .height = height,
                     .channels = spec_.nchannels,
                     .row_stride = std::ptrdiff_t(stride),
                     .left = frame_.left,
                     .top = frame_.top + top});
  for (std::size_t k = 0; k < pixels.size(); k += channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      float& value = pixels[k + c];
      if (value < ranges_[c].least) value = ranges_[c].least;
      if (value > ranges_[c].greatest) value = ranges_[c].greatest;
    }
  }
  return pixels;
}

}  // namespace drumhead::driver
