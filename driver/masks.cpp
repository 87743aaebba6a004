// SPDX-License-Identifier: MIT
#include "masks.h"

#include <algorithm>
#include <stdexcept>

#include "svg_picture.h"

namespace drumhead::driver {
namespace {

// JPEG's conversion from luminance and back leaves this much colour in a grey picture.
constexpr float kGreyEnough = 2.5f / 255.0f;
// What white stands for unless the scene says so; black is the membrane as it is without the mask.
constexpr double kMuWhite = 100.0, kKappaWhite = 1000.0;

/// The grey of every pixel: transparent is black, as colours are multiplied by alpha.
std::vector<float> greys(const Image& image) {
  const int channels = image.channels(), alpha = image.spec.alpha_channel;
  std::vector<float> grey;
  grey.reserve(image.pixels.size() / std::size_t(channels));
  for (std::size_t p = 0; p < image.pixels.size(); p += std::size_t(channels)) {
    float least = 0.0f, most = 0.0f, sum = 0.0f;
    int colours = 0;
    for (int c = 0; c < channels; ++c) {
      if (c == alpha || c == image.spec.z_channel) continue;
      const float value = image.pixels[p + std::size_t(c)];
      least = colours ? std::min(least, value) : value;
      most = colours ? std::max(most, value) : value;
      sum += value;
      ++colours;
    }
    if (most - least > kGreyEnough) {
      const std::size_t at = grey.size(), width = std::size_t(image.width());
      throw std::invalid_argument("pixel (" + std::to_string(at % width) + ", " +
                                  std::to_string(at / width) + ") is coloured: must be grey");
    }
    grey.push_back(sum / float(colours));
  }
  return grey;
}

grid::Mask read_mask(const MaskOptions& options, int width, int height, double black,
                     double white) {
  const Image image =
      has_extension(options.file, ".svg") ? rasterise(options.file) : read_image(options.file);
  if (image.width() != width || image.height() != height)
    throw std::invalid_argument(options.file.string() + ": " + std::to_string(image.width()) +
                                " x " + std::to_string(image.height()) +
                                " pixels: must be of the picture's size, " + std::to_string(width) +
                                " x " + std::to_string(height));
  try {
    return {.width = width,
            .height = height,
            .grey = greys(image),
            .black = options.black.value_or(black),
            .white = options.white.value_or(white),
            .scale = options.scale.value_or(grid::MaskScale::linear)};
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(options.file.string() + ": " + error.what());
  }
}

/// A key of a mask without its file is a mistake that would go unseen.
void check_used(const char* name, const MaskOptions& mask) {
  const char* key = mask.black ? "_black" : mask.white ? "_white" : mask.scale ? "_scale" : nullptr;
  if (mask.file.empty() && key)
    throw std::invalid_argument(std::string(name) + key + ": there is no " + name + "_mask");
}

}  // namespace

void apply_masks(const Options& options, int width, int height, const grid::Lattice& lattice,
                 grid::Material& material) {
  check_used("mu", options.mu_mask);
  check_used("kappa", options.kappa_mask);
  const auto cells = [&](const MaskOptions& mask, double black, double white, const auto& means) {
    if (mask.file.empty()) return std::vector<float>{};
    const grid::Mask read = read_mask(mask, width, height, black, white);
    try {
      return means(read, lattice);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(mask.file.string() + ": " + error.what());
    }
  };
  if (!options.kappa_mask.file.empty() && options.model == kernels::Model::harmonic)
    throw std::invalid_argument(options.kappa_mask.file.string() +
                                ": kappa_mask: the harmonic membrane has no kappa");
  material.mu_cells = cells(options.mu_mask, 1.0, kMuWhite, grid::mu_cells);
  material.kappa_cells = cells(options.kappa_mask, options.kappa, kKappaWhite, grid::kappa_cells);
}

}  // namespace drumhead::driver
