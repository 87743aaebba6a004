// SPDX-License-Identifier: MIT
#include "image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "light.h"

namespace drumhead::driver {
namespace {

constexpr const char* kUnassociated = "oiio:UnassociatedAlpha";
constexpr const char* kWrittenFormats = "png, jpg, tif, exr, webp, bmp, tga, ppm, hdr";

std::string first_line(const std::string& text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

/// Orientation as EXIF numbers it: the upright place of the stored pixel (a, b).
std::pair<int, int> upright_position(int orientation, int stored_width, int stored_height, int a,
                                     int b) {
  const int right = stored_width - 1 - a, up = stored_height - 1 - b;
  switch (orientation) {
    case 2:
      return {right, b};
    case 3:
      return {right, up};
    case 4:
      return {a, up};
    case 5:
      return {b, a};
    case 6:
      return {up, a};
    case 7:
      return {up, right};
    case 8:
      return {b, right};
    default:
      return {a, b};
  }
}

/// Orientation of the file, 1 where it has none that is known.
int orientation_of(const OIIO::ImageSpec& spec) {
  const int orientation = spec.get_int_attribute("Orientation", 1);
  return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

void turn_upright(OIIO::ImageSpec& spec) {
  const int orientation = orientation_of(spec);
  if (orientation == 1) return;
  if (orientation >= 5) {
    std::swap(spec.width, spec.height);
    std::swap(spec.x, spec.y);
    std::swap(spec.full_width, spec.full_height);
    std::swap(spec.full_x, spec.full_y);
    spec.attribute("Exif:PixelXDimension", spec.width);
    spec.attribute("Exif:PixelYDimension", spec.height);
  }
  spec.attribute("Orientation", 1);
}

void add_alpha(OIIO::ImageSpec& spec) {
  spec.alpha_channel = spec.nchannels++;
  spec.channelnames.emplace_back("A");
  if (!spec.channelformats.empty()) spec.channelformats.push_back(spec.channelformats.front());
  spec.attribute(kUnassociated, 1);
}

/// A file on its way into an Image, band by band of stored rows.
class Reader {
 public:
  Reader(const std::filesystem::path& file, const ReadOptions& options)
      : file_(file), options_(options) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) fail("no such file");
    if (!std::filesystem::is_regular_file(file, error)) fail("not a regular file");
    OIIO::ImageSpec hints;
    // Multiplied here, in float: in 8 bits dark colours would be lost.
    hints.attribute(kUnassociated, 1);
    input_ = OIIO::ImageInput::open(file.string(), &hints);
    if (!input_) fail(OIIO::geterror());
    stored_ = input_->spec();
    if (stored_.deep || stored_.depth > 1) fail("deep and volume images are not supported");
    if (stored_.nchannels < 1) fail("it has no channels");
  }

  Image read() {
    Image image{stored_, {}};
    image.spec.attribute("drumhead:format", input_->format_name());
    turn_upright(image.spec);
    if (options_.need_alpha && stored_.alpha_channel < 0) add_alpha(image.spec);
    image.decoded =
        options_.linear_light && !stored_.format.is_floating_point() &&
        !OIIO::Strutil::iequals(stored_.get_string_attribute("oiio:ColorSpace"), "linear");
    image.pixels.resize(std::size_t(image.width()) * std::size_t(image.height()) *
                        std::size_t(image.channels()));
    const int tile = std::max(1, stored_.tile_height);
    const int step = (band_rows(stored_.width) + tile - 1) / tile * tile;
    std::vector<float> rows;
    for (int b = 0; b < stored_.height; b += step) {
      const int count = std::min(step, stored_.height - b);
      read_rows(b, count, rows);
      weigh(image.decoded, rows);
      place(rows, b, count, image);
      if (options_.progress) options_.progress(double(b + count) / stored_.height);
    }
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw std::invalid_argument(file_.string() + ": cannot be read: " + first_line(reason));
  }

  void read_rows(int b, int count, std::vector<float>& rows) {
    const int first = stored_.y + b, channels = stored_.nchannels;
    rows.resize(std::size_t(stored_.width) * std::size_t(count) * std::size_t(channels));
    const bool read = stored_.tile_width > 0
                          ? input_->read_tiles(0, 0, stored_.x, stored_.x + stored_.width, first,
                                               first + count, stored_.z, stored_.z + 1, 0, channels,
                                               OIIO::TypeDesc::FLOAT, rows.data())
                          : input_->read_scanlines(0, 0, first, first + count, stored_.z, 0,
                                                   channels, OIIO::TypeDesc::FLOAT, rows.data());
    if (!read) fail(input_->geterror());
  }

  /// To light where asked for, and multiplied by alpha.
  void weigh(bool decode, std::vector<float>& rows) const {
    const bool alpha = stored_.alpha_channel >= 0;
    const bool plain = alpha && stored_.get_int_attribute(kUnassociated);
    if (decode) {
      if (alpha && !plain) for_each_colour(stored_, rows, divide_alpha);
      for_each_colour(stored_, rows, [](float& value, float) { value = decode_srgb(value); });
    }
    if (plain || (alpha && decode)) for_each_colour(stored_, rows, multiply_alpha);
  }

  /// Stored rows b … to where they stand upright; an alpha that was added is 1.
  void place(const std::vector<float>& rows, int b, int count, Image& image) const {
    const int orientation = orientation_of(stored_), width = stored_.width;
    const auto from = std::size_t(stored_.nchannels), to = std::size_t(image.channels());
    // Column by column, so that turned rows are written in order.
    const bool turned = orientation >= 5;
    const int outer = turned ? width : count, inner = turned ? count : width;
    for (int k = 0; k < outer; ++k) {
      for (int l = 0; l < inner; ++l) {
        const int a = turned ? k : l, row = turned ? l : k;
        const auto [x, y] = upright_position(orientation, width, stored_.height, a, b + row);
        const auto in = rows.begin() + (std::ptrdiff_t(row) * width + a) * std::ptrdiff_t(from);
        const auto out =
            image.pixels.begin() + (std::ptrdiff_t(y) * image.width() + x) * std::ptrdiff_t(to);
        std::copy_n(in, from, out);
        if (to > from) out[std::ptrdiff_t(from)] = 1.0f;
      }
    }
  }

  const std::filesystem::path file_;
  const ReadOptions& options_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec stored_;
};

}  // namespace

int band_rows(int width) {
  constexpr int kPixels = 1 << 20, kTile = 64;  // the resampler works on tiles of 64 rows
  return std::max(1, kPixels / std::max(1, width) / kTile) * kTile;
}

Image read_image(const std::filesystem::path& file, const ReadOptions& options) {
  return Reader(file, options).read();
}

std::size_t make_finite(Image& image) {
  constexpr float kGreatestHalf = 65504.0f;
  std::size_t count = 0;
  for (float& value : image.pixels) {
    if (std::isfinite(value)) continue;
    value = std::isnan(value) ? 0.0f : std::copysign(kGreatestHalf, value);
    ++count;
  }
  return count;
}

void check_writable_format(const std::filesystem::path& file) {
  if (!OIIO::ImageOutput::create(file.string())) {
    (void)OIIO::geterror();
    throw std::invalid_argument(file.string() + ": no picture format is known by its extension; " +
                                "there are " + kWrittenFormats + " and others");
  }
}

}  // namespace drumhead::driver
