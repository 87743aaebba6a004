// SPDX-License-Identifier: MIT
#include "float_exr.h"

#include <OpenImageIO/imageio.h>
#include <drumhead/kernels/version.h>
#include <algorithm>
#include <stdexcept>

namespace drumhead::driver {
namespace {

// Rows of a band: whole tiles of the resampler (64) and whole zip chunks of OpenEXR (16).
constexpr int kBandStep = 64;
constexpr int kBandPixels = 1 << 21;

int band_rows(int width) { return std::max(1, kBandPixels / (width * kBandStep)) * kBandStep; }

OIIO::ImageSpec spec_of(const FloatExr& exr) {
  OIIO::ImageSpec spec(exr.data.width, exr.data.height, int(exr.channels.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.x = exr.data.left;
  spec.y = exr.data.top;
  spec.full_x = exr.display.left;
  spec.full_y = exr.display.top;
  spec.full_width = exr.display.width;
  spec.full_height = exr.display.height;
  spec.channelnames = exr.channels;
  spec.attribute("compression", "zip");
  spec.attribute("Software", "drumhead " DRUMHEAD_VERSION);
  for (const auto& [name, text] : exr.header) spec.attribute(name, text);
  return spec;
}

}  // namespace

void write_float_exr(const FloatExr& exr, const std::filesystem::path& file,
                     const std::function<void(int first, int rows, float* pixels)>& fill) {
  const auto fail = [&](std::string reason) {
    reason.erase(std::min(reason.find_first_of("\r\n"), reason.size()));
    throw std::runtime_error(file.string() + ": cannot be written: " + reason);
  };
  const auto output = OIIO::ImageOutput::create("openexr");
  if (!output) fail(OIIO::geterror());
  const OIIO::ImageSpec spec = spec_of(exr);
  if (!output->open(file.string(), spec)) fail(output->geterror());
  const int step = band_rows(spec.width);
  std::vector<float> pixels(std::size_t(std::min(step, spec.height)) * std::size_t(spec.width) *
                            exr.channels.size());
  for (int first = 0; first < spec.height; first += step) {
    const int rows = std::min(step, spec.height - first);
    fill(first, rows, pixels.data());
    if (!output->write_scanlines(spec.y + first, spec.y + first + rows, 0, OIIO::TypeDesc::FLOAT,
                                 pixels.data())) {
      fail(output->geterror());
    }
  }
  if (!output->close()) fail(output->geterror());
}

}  // namespace drumhead::driver
