// SPDX-License-Identifier: MIT
#include "image.h"

#include <algorithm>
#include <stdexcept>

namespace drumhead::driver {
namespace {

constexpr const char* kUnassociated = "oiio:UnassociatedAlpha";
constexpr const char* kWrittenFormats = "png, jpg, tif, exr, webp, bmp, tga, ppm, hdr";

std::string first_line(const std::string& text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

/// Calls colour(value, alpha) for every value that alpha weights.
template <class Colour>
void with_alpha(Image& image, const Colour& colour) {
  const int channels = image.channels(), alpha = image.spec.alpha_channel;
  for (std::size_t p = 0; p < image.pixels.size(); p += std::size_t(channels)) {
    const float a = image.pixels[p + std::size_t(alpha)];
    for (int c = 0; c < channels; ++c) {
      if (c != alpha && c != image.spec.z_channel) colour(image.pixels[p + std::size_t(c)], a);
    }
  }
}

void multiply_alpha(Image& image) {
  with_alpha(image, [](float& value, float alpha) { value *= alpha; });
}

/// Where alpha is 0 nothing is known of the colour: it stays 0.
void divide_alpha(Image& image) {
  with_alpha(image, [](float& value, float alpha) { value = alpha > 0 ? value / alpha : 0.0f; });
}

/// Orientation as EXIF numbers it: the stored pixel (a, b) of the upright pixel (x, y).
std::pair<int, int> stored_position(int orientation, int stored_width, int stored_height, int x,
                                    int y) {
  const int a = stored_width - 1, b = stored_height - 1;
  switch (orientation) {
    case 2:
      return {a - x, y};
    case 3:
      return {a - x, b - y};
    case 4:
      return {x, b - y};
    case 5:
      return {y, x};
    case 6:
      return {y, b - x};
    case 7:
      return {a - y, b - x};
    case 8:
      return {a - y, x};
    default:
      return {x, y};
  }
}

void turn_upright(Image& image) {
  OIIO::ImageSpec& spec = image.spec;
  const int orientation = spec.get_int_attribute("Orientation", 1);
  if (orientation < 2 || orientation > 8) return;
  const int width = spec.width, height = spec.height;
  const auto channels = std::size_t(spec.nchannels);
  if (orientation >= 5) {
    std::swap(spec.width, spec.height);
    std::swap(spec.x, spec.y);
    std::swap(spec.full_width, spec.full_height);
    std::swap(spec.full_x, spec.full_y);
    spec.attribute("Exif:PixelXDimension", spec.width);
    spec.attribute("Exif:PixelYDimension", spec.height);
  }
  spec.attribute("Orientation", 1);
  std::vector<float> upright(image.pixels.size());
  auto out = upright.begin();
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      const auto [a, b] = stored_position(orientation, width, height, x, y);
      const auto in =
          image.pixels.begin() + (std::ptrdiff_t(b) * width + a) * std::ptrdiff_t(channels);
      out = std::copy_n(in, channels, out);
    }
  }
  image.pixels = std::move(upright);
}

/// Without alpha, over white.
void flatten(Image& image) {
  const int channels = image.channels(), alpha = image.spec.alpha_channel;
  with_alpha(image, [](float& value, float a) { value += 1.0f - a; });
  OIIO::ImageSpec& spec = image.spec;
  std::vector<float> opaque;
  opaque.reserve(image.pixels.size());
  for (std::size_t k = 0; k < image.pixels.size(); ++k) {
    if (int(k % std::size_t(channels)) != alpha) opaque.push_back(image.pixels[k]);
  }
  image.pixels = std::move(opaque);
  spec.nchannels -= 1;
  spec.channelnames.erase(spec.channelnames.begin() + alpha);
  if (!spec.channelformats.empty()) spec.channelformats.erase(spec.channelformats.begin() + alpha);
  spec.alpha_channel = -1;
}

/// What described the input's file, not its picture.
void adapt_to_format(OIIO::ImageSpec& spec, const std::string& format) {
  spec.tile_width = spec.tile_height = spec.tile_depth = 0;
  for (const char* name :
       {"textureformat", "openexr:levelmode", "thumbnail_image", "oiio:subimages",
        "oiio:ConstantColor", "oiio:AverageColor", "oiio:SHA-1"}) {
    spec.erase_attribute(name);
  }
  if (spec.get_int_attribute("oiio:BitsPerSample", 8) < 8)
    spec.erase_attribute("oiio:BitsPerSample");
  if (spec.get_string_attribute("drumhead:format") != format) {
    spec.erase_attribute("compression");
    spec.erase_attribute("oiio:BitsPerSample");
  }
  spec.erase_attribute("drumhead:format");
}

[[noreturn]] void fail_to_write(const std::filesystem::path& file, const std::string& reason) {
  throw std::runtime_error(file.string() + ": cannot be written: " + first_line(reason));
}

void write_pixels(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec,
                  const std::vector<float>& pixels, const std::filesystem::path& file) {
  if (!output.open(file.string(), spec) ||
      !output.write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !output.close()) {
    fail_to_write(file, output.geterror());
  }
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& reason) {
    throw std::invalid_argument(file.string() + ": cannot be read: " + first_line(reason));
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) fail("no such file");
  if (!std::filesystem::is_regular_file(file, error)) fail("not a regular file");
  OIIO::ImageSpec hints;
  hints.attribute(kUnassociated,
                  1);  // multiplied here, in float: in 8 bits dark colours would be lost
  const auto input = OIIO::ImageInput::open(file.string(), &hints);
  if (!input) fail(OIIO::geterror());
  Image image{input->spec(), {}};
  if (image.spec.deep || image.spec.depth > 1) fail("deep and volume images are not supported");
  if (image.channels() < 1) fail("it has no channels");
  const auto values = std::size_t(image.width()) * std::size_t(image.height());
  image.pixels.resize(values * std::size_t(image.channels()));
  if (!input->read_image(0, 0, 0, image.channels(), OIIO::TypeDesc::FLOAT, image.pixels.data())) {
    fail(input->geterror());
  }
  image.spec.attribute("drumhead:format", input->format_name());
  if (image.spec.alpha_channel >= 0 && image.spec.get_int_attribute(kUnassociated)) {
    multiply_alpha(image);
  }
  turn_upright(image);
  return image;
}

void check_writable_format(const std::filesystem::path& file) {
  if (!OIIO::ImageOutput::create(file.string())) {
    (void)OIIO::geterror();
    throw std::invalid_argument(file.string() + ": no picture format is known by its extension; " +
                                "there are " + kWrittenFormats + " and others");
  }
}

void write_image(Image image, const std::filesystem::path& file) {
  const auto output = OIIO::ImageOutput::create(file.string());
  if (!output) fail_to_write(file, OIIO::geterror());
  const std::string format = output->format_name();
  if (image.spec.alpha_channel >= 0) {
    // OpenEXR's alpha is always multiplied; TIFF has both kinds; the others have only the plain
    // kind.
    const bool was_plain = image.spec.get_int_attribute(kUnassociated);
    if (!output->supports("alpha")) {
      flatten(image);
    } else if (format == "openexr" || (format == "tiff" && !was_plain)) {
      image.spec.erase_attribute(kUnassociated);
    } else {
      divide_alpha(image);
      image.spec.attribute(kUnassociated, 1);
    }
  }
  adapt_to_format(image.spec, format);
  write_pixels(*output, image.spec, image.pixels, file);
}

}  // namespace drumhead::driver
