// SPDX-License-Identifier: MIT
#pragma once
// Pictures in and out through OpenImageIO. In memory: float, channels interleaved, upright (EXIF
// orientation applied), colours multiplied by alpha and otherwise as the file codes them, or as
// light where that was asked for. Depth, colour profile and other metadata travel in `spec` to the
// output. Files are read and written in bands of rows: beside the picture itself a band is all that
// is held.
#include <OpenImageIO/imageio.h>
#include <filesystem>
#include <functional>
#include <vector>

namespace drumhead::driver {

struct Image {
  OIIO::ImageSpec spec;  ///< of the file; width, height, nchannels, alpha_channel are the picture's
  std::vector<float> pixels;  ///< pixel (a, b), channel c at (b·width + a)·nchannels + c
  bool decoded = false;       ///< sRGB's codes were turned into light, and are to be turned back

  int width() const { return spec.width; }
  int height() const { return spec.height; }
  int channels() const { return spec.nchannels; }
  /// Whether the colours are light: decoded, or of a float file, which holds light by convention.
  bool linear() const { return decoded || spec.format.is_floating_point(); }
};

/// Receives the share of a piece of work that is done, 0…1.
using ShareDone = std::function<void(double)>;

struct ReadOptions {
  /// Integer pictures are decoded from sRGB to light before alpha weights them, unless the file
  /// says that it is linear. Float pictures are light already.
  bool linear_light = false;
  bool need_alpha = false;  ///< a picture without alpha gets one, opaque everywhere
  ShareDone progress;       ///< optional
};

/// Throws std::invalid_argument naming the file and the reason; deep and volume images are refused.
Image read_image(const std::filesystem::path& file, const ReadOptions& options = {});

/// NaN becomes 0 and infinity the greatest half float: a filter would make holes of NaN, as wide as
/// itself, of them. How many values there were.
std::size_t make_finite(Image& image);

/// Whether OpenImageIO writes pictures of this extension. Throws std::invalid_argument naming the
/// file and the extensions that it does write.
void check_writable_format(const std::filesystem::path& file);

/// Rows of a band that is worth a round through the threads: about a million pixels.
int band_rows(int width);

/// Writes in the format of `file`'s extension with the depth of `spec` or the nearest that the
/// format has, band by band. A format without alpha gets the picture over white; only OpenEXR keeps
/// a frame that differs from the picture's (`spec.x`, `spec.full_width` …). Everything throws
/// std::runtime_error naming `file`.
class ImageWriter {
 public:
  /// `decoded` as in Image.
  ImageWriter(const OIIO::ImageSpec& spec, bool decoded, const std::filesystem::path& file);
  /// The next rows, from the top: `spec.width` pixels each, as Image holds them.
  void write(std::vector<float> rows);
  /// After the last row.
  void close();

 private:
  std::unique_ptr<OIIO::ImageOutput> output_;
  OIIO::ImageSpec input_, spec_;  // as given and as the file has it
  const bool decoded_;
  bool flat_ = false, divided_ = false;
  const std::filesystem::path file_;
  int row_ = 0;
};

/// The whole picture by an ImageWriter.
void write_image(Image image, const std::filesystem::path& file);

}  // namespace drumhead::driver
