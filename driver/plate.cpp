// SPDX-License-Identifier: MIT
#include "plate.h"

#include <algorithm>
#include <stdexcept>

#include "options.h"
#include "svg_picture.h"

namespace drumhead::driver {

Image read_plate(const std::filesystem::path& file, const Image& picture) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(file.string() + ": " + what);
  };
  if (picture.spec.alpha_channel < 0)
    refuse(
        "a plate is seen through alpha, which the picture must have (--border transparent "
        "gives it one)");
  const ReadOptions options{.linear_light = picture.linear(), .need_alpha = true, .progress = {}};
  Image plate = has_extension(file, ".svg") ? rasterise(file, options) : read_image(file, options);
  const auto size = [](const Image& image) {
    return std::to_string(image.width()) + " x " + std::to_string(image.height());
  };
  if (plate.width() != picture.width() || plate.height() != picture.height())
    refuse(size(plate) + " pixels: must be of the picture's size, " + size(picture));
  if (plate.channels() != picture.channels() ||
      plate.spec.alpha_channel != picture.spec.alpha_channel)
    refuse(std::to_string(plate.channels()) + " channels with alpha: must be the picture's, " +
           std::to_string(picture.channels()));
  if (plate.linear() && !picture.linear())
    refuse("holds light, the picture sRGB codes: --linear-light makes them alike");
  return plate;
}

void lay_over(const Image& plate, const Frame& frame, int top, std::vector<float>& rows) {
  const int channels = plate.channels(), alpha = plate.spec.alpha_channel;
  const int first = std::max(0, frame.left);
  const int end = std::min(plate.width(), frame.left + frame.width);
  const int height = int(rows.size()) / (frame.width * channels);
  for (int row = 0; row < height; ++row) {
    const int y = frame.top + top + row;
    if (y < 0 || y >= plate.height()) continue;
    for (int x = first; x < end; ++x) {
      float* const over = &rows[std::size_t((row * frame.width + x - frame.left) * channels)];
      const float* const under =
          &plate.pixels[(std::size_t(y) * std::size_t(plate.width()) + std::size_t(x)) *
                        std::size_t(channels)];
      const float clear = 1.0f - over[alpha];
      for (int c = 0; c < channels; ++c) {
        if (c != plate.spec.z_channel) over[c] += clear * under[c];
      }
    }
  }
}

}  // namespace drumhead::driver
