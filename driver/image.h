// SPDX-License-Identifier: MIT
#pragma once
// Pictures in and out through OpenImageIO. In memory: float, channels interleaved, upright (EXIF
// orientation applied), colours multiplied by alpha and otherwise as the file codes them. Depth,
// colour profile and other metadata travel in `spec` to the output.
#include <OpenImageIO/imageio.h>
#include <filesystem>
#include <vector>

namespace drumhead::driver {

struct Image {
  OIIO::ImageSpec spec;  ///< of the file; width, height, nchannels, alpha_channel are the picture's
  std::vector<float> pixels;  ///< pixel (a, b), channel c at (b·width + a)·nchannels + c

  int width() const { return spec.width; }
  int height() const { return spec.height; }
  int channels() const { return spec.nchannels; }
};

/// Throws std::invalid_argument naming the file and the reason; deep and volume images are refused.
Image read_image(const std::filesystem::path& file);

/// Whether OpenImageIO writes pictures of this extension. Throws std::invalid_argument naming the
/// file and the extensions that it does write.
void check_writable_format(const std::filesystem::path& file);

/// Writes in the format of `file`'s extension with the depth of `image.spec` or the nearest that
/// the format has. A format without alpha gets the picture over white. Throws std::runtime_error
/// naming `file`.
void write_image(Image image, const std::filesystem::path& file);

}  // namespace drumhead::driver
