// SPDX-License-Identifier: MIT
#include "canvas.h"

#include <OpenImageIO/filesystem.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "light.h"

namespace drumhead::driver {
namespace {

constexpr int kLeastSide = 500, kEnlargedSide = 1000;
constexpr double kUnitSide = 1200, kStripWidth = 600, kTextSize = 19;

int divided_up(int a, int b) { return (a + b - 1) / b; }

std::uint32_t byte(float x) {
  return x > 0.0f ? std::uint32_t(std::lround(255.0f * std::min(x, 1.0f))) : 0u;
}

std::uint32_t packed(float red, float green, float blue, float alpha) {
  const float a = alpha > 0.0f ? std::min(alpha, 1.0f) : 0.0f;
  return byte(a) << 24 | byte(red * a) << 16 | byte(green * a) << 8 | byte(blue * a);
}

}  // namespace

Canvas::Canvas(const Frame& frame, int greatest_side, double strip)
    : frame_(frame), surface_(nullptr, cairo_surface_destroy), context_(nullptr, cairo_destroy) {
  const int side = std::max(frame.width, frame.height);
  if (side > greatest_side)
    shrink_ = divided_up(side, greatest_side);
  else if (side < kLeastSide)
    enlarge_ = divided_up(kEnlargedSide, side);
  scale_ = double(enlarge_) / shrink_;
  columns_ = divided_up(frame.width * enlarge_, shrink_);
  rows_ = divided_up(frame.height * enlarge_, shrink_);
  width_ = strip > 0.0 ? std::max(columns_, int(std::ceil(kStripWidth * unit()))) : columns_;
  height_ = rows_ + int(std::ceil(strip * unit()));
  surface_.reset(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width_, height_));
  if (cairo_surface_status(surface_.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  context_.reset(cairo_create(surface_.get()));
  cairo_t* const context = context_.get();
  if (strip > 0.0) {
    cairo_set_source_rgb(context, 0.93, 0.93, 0.93);
    cairo_paint(context);
  }
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

double Canvas::unit() const { return std::max(1.0, std::max(columns_, rows_) / kUnitSide); }

std::uint32_t* Canvas::row(int y) const {
  return reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface_.get()) +
                                          std::ptrdiff_t(y) *
                                              cairo_image_surface_get_stride(surface_.get()));
}

void Canvas::put_pixel(const OIIO::ImageSpec& spec, bool linear, const float* value, int x, int y) {
  const int alpha = spec.alpha_channel, colours = spec.nchannels - (alpha >= 0 ? 1 : 0);
  const float a = alpha >= 0 ? value[alpha] : 1.0f;
  const auto shown = [&](int c) {
    float plain = value[colours < 3 ? 0 : c];
    if (alpha >= 0) divide_alpha(plain, a);
    return linear ? encode_srgb(plain) : plain;
  };
  row(y)[x] = packed(shown(0), shown(1), shown(2), a);
}

void Canvas::add_rows(const OIIO::ImageSpec& spec, bool linear, const std::vector<float>& rows) {
  cairo_surface_flush(surface_.get());
  const auto channels = std::size_t(spec.nchannels);
  const std::size_t stride = std::size_t(frame_.width) * channels;
  for (std::size_t from = 0; from < rows.size(); from += stride, ++next_row_) {
    if (shrink_ == 1) {
      const int y = next_row_ * enlarge_;
      for (int x = 0; x < columns_; ++x) {
        put_pixel(spec, linear, &rows[from + std::size_t(x / enlarge_) * channels], x, y);
      }
      for (int k = 1; k < enlarge_; ++k) std::copy_n(row(y), columns_, row(y + k));
      continue;
    }
    const int in_block = next_row_ % shrink_;
    if (in_block == 0) block_sums_.assign(std::size_t(columns_) * channels, 0.0f);
    for (std::size_t k = 0; k < stride; ++k) {
      block_sums_[k / channels / std::size_t(shrink_) * channels + k % channels] += rows[from + k];
    }
    if (in_block != shrink_ - 1 && next_row_ != frame_.height - 1) continue;
    for (int x = 0; x < columns_; ++x) {
      const int count = (in_block + 1) * std::min(shrink_, frame_.width - x * shrink_);
      float* const mean = &block_sums_[std::size_t(x) * channels];
      for (std::size_t c = 0; c < channels; ++c) mean[c] /= float(count);
      put_pixel(spec, linear, mean, x, next_row_ / shrink_);
    }
  }
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::set_row(int y, const std::vector<Colour>& colours) {
  cairo_surface_flush(surface_.get());
  std::uint32_t* out = row(y);
  for (const Colour& c : colours) {
    *out++ = packed(float(c.red), float(c.green), float(c.blue), float(c.alpha));
  }
  cairo_surface_mark_dirty_rectangle(surface_.get(), 0, y, columns_, 1);
}

void Canvas::line_to(grid::Point p, bool first) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
  // Cairo's coordinates have 24 bits before the point.
  constexpr double kFar = 1e5;
  const double x = std::clamp((p.x - frame_.left) * scale_, -kFar, kFar);
  const double y = std::clamp((p.y - frame_.top) * scale_, -kFar, kFar);
  if (first)
    cairo_move_to(context_.get(), x, y);
  else
    cairo_line_to(context_.get(), x, y);
}

void Canvas::stroke(Colour colour, double width, bool keep) {
  cairo_t* const context = context_.get();
  cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, colour.alpha);
  cairo_set_line_width(context, width * unit());
  cairo_save(context);
  // The path is kept while the clip changes, so that lines stay out of the legend.
  const std::unique_ptr<cairo_path_t, decltype(&cairo_path_destroy)> path(cairo_copy_path(context),
                                                                          cairo_path_destroy);
  cairo_new_path(context);
  cairo_rectangle(context, 0, 0, columns_, rows_);
  cairo_clip(context);
  cairo_append_path(context, path.get());
  cairo_stroke(context);
  cairo_restore(context);
  if (keep) cairo_append_path(context, path.get());
}

void Canvas::fill_rectangle(double x, double y, double width, double height, Colour colour) {
  cairo_t* const context = context_.get();
  cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, colour.alpha);
  cairo_rectangle(context, x * unit(), rows_ + y * unit(), width * unit(), height * unit());
  cairo_fill(context);
}

void Canvas::write_text(double x, double y, const std::string& text, bool centred) {
  cairo_t* const context = context_.get();
  cairo_set_font_size(context, kTextSize * unit());
  cairo_set_source_rgb(context, 0.1, 0.1, 0.1);
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  const double before = centred ? extents.width / 2 + extents.x_bearing : 0.0;
  cairo_move_to(context, x * unit() - before, rows_ + y * unit());
  cairo_show_text(context, text.c_str());
}

void Canvas::write_to(OIIO::ImageOutput& output, const std::string& name,
                      const ShareDone& progress) const {
  cairo_surface_flush(surface_.get());
  bool opaque = true;
  for (int y = 0; y < height_ && opaque; ++y) {
    opaque = std::all_of(row(y), row(y) + width_, [](std::uint32_t p) { return p >> 24 == 255; });
  }
  const int channels = opaque ? 3 : 4;
  OIIO::ImageSpec spec(width_, height_, channels, OIIO::TypeDesc::UINT8);
  if (!opaque) spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("oiio:ColorSpace", "sRGB");
  const auto check = [&](bool done) {
    if (!done) throw std::runtime_error(name + ": cannot be written: " + output.geterror());
  };
  check(output.open(name, spec));
  std::vector<std::uint8_t> line(std::size_t(width_) * std::size_t(channels));
  for (int y = 0; y < height_; ++y) {
    auto* out = line.data();
    for (const std::uint32_t* p = row(y); p != row(y) + width_; ++p) {
      const std::uint32_t a = *p >> 24;
      for (const int shift : {16, 8, 0}) {
        const std::uint32_t value = *p >> shift & 255;
        *out++ = std::uint8_t(a == 0 ? 0 : std::min(255u, (value * 255 + a / 2) / a));
      }
      if (!opaque) *out++ = std::uint8_t(a);
    }
    check(output.write_scanline(y, 0, OIIO::TypeDesc::UINT8, line.data()));
    if (progress && y % 64 == 0) progress(double(y) / height_);
  }
  check(output.close());
}

void Canvas::write_png(const std::filesystem::path& file, const ShareDone& progress) const {
  write_to(*OIIO::ImageOutput::create("png"), file.string(), progress);
}

std::string Canvas::png() const {
  OIIO::Filesystem::IOVecOutput bytes;
  const auto output = OIIO::ImageOutput::create("png");
  output->set_ioproxy(&bytes);
  write_to(*output, "page.png", {});
  return {bytes.buffer().begin(), bytes.buffer().end()};
}

}  // namespace drumhead::driver
