// SPDX-License-Identifier: MIT
#include <algorithm>
#include <stdexcept>

#include "image.h"
#include "light.h"

namespace drumhead::driver {
namespace {

constexpr const char* kUnassociated = "oiio:UnassociatedAlpha";

[[noreturn]] void fail_to_write(const std::filesystem::path& file, const std::string& reason) {
  throw std::runtime_error(
      file.string() + ": cannot be written: " + reason.substr(0, reason.find_first_of("\r\n")));
}

/// Without the alpha channel.
void drop_alpha(OIIO::ImageSpec& spec) {
  const int alpha = spec.alpha_channel;
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
  if (format == "openexr") return;
  // Others keep no frame, or none with negative places.
  spec.x = spec.y = spec.full_x = spec.full_y = 0;
  spec.full_width = spec.width;
  spec.full_height = spec.height;
}

}  // namespace

ImageWriter::ImageWriter(const OIIO::ImageSpec& spec, bool decoded,
                         const std::filesystem::path& file)
    : output_(OIIO::ImageOutput::create(file.string())),
      input_(spec),
      spec_(spec),
      decoded_(decoded),
      file_(file) {
  if (!output_) fail_to_write(file_, OIIO::geterror());
  const std::string format = output_->format_name();
  if (spec.alpha_channel >= 0) {
    // OpenEXR's alpha is always multiplied; TIFF has both kinds; the others have only the plain
    // kind.
    const bool was_plain = spec.get_int_attribute(kUnassociated);
    if (!output_->supports("alpha")) {
      flat_ = true;
      drop_alpha(spec_);
    } else if (format == "openexr" || (format == "tiff" && !was_plain)) {
      spec_.erase_attribute(kUnassociated);
    } else {
      divided_ = true;
      spec_.attribute(kUnassociated, 1);
    }
  }
  adapt_to_format(spec_, format);
  if (!output_->open(file_.string(), spec_)) fail_to_write(file_, output_->geterror());
}

void ImageWriter::write(std::vector<float> rows) {
  const int alpha = input_.alpha_channel;
  if (flat_) {
    for_each_colour(input_, rows, [](float& value, float a) { value += 1.0f - a; });
    if (decoded_) {
      for_each_colour(input_, rows, [](float& value, float) { value = encode_srgb(value); });
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (int(k % std::size_t(input_.nchannels)) != alpha) rows[kept++] = rows[k];
    }
    rows.resize(kept);
  } else {
    if (alpha >= 0 && (divided_ || decoded_)) for_each_colour(input_, rows, divide_alpha);
    if (decoded_) {
      for_each_colour(input_, rows, [](float& value, float) { value = encode_srgb(value); });
    }
    if (alpha >= 0 && !divided_ && decoded_) for_each_colour(input_, rows, multiply_alpha);
  }
  const int count = int(rows.size() / (std::size_t(spec_.width) * std::size_t(spec_.nchannels)));
  const int first = spec_.y + row_;
  row_ += count;
  if (!output_->write_scanlines(first, first + count, 0, OIIO::TypeDesc::FLOAT, rows.data())) {
    fail_to_write(file_, output_->geterror());
  }
}

void ImageWriter::close() {
  if (!output_->close()) fail_to_write(file_, output_->geterror());
}

void write_image(Image image, const std::filesystem::path& file) {
  ImageWriter writer(image.spec, image.decoded, file);
  writer.write(std::move(image.pixels));
  writer.close();
}

}  // namespace drumhead::driver
