// SPDX-License-Identifier: MIT
#include "overlay.h"

#include <cairo.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "render.h"

namespace drumhead::driver {
namespace {

constexpr double kGreatestSide = 16384, kLeastSide = 500, kEnlargedSide = 1000;
constexpr double kLineGap = 12;          // pixels of the overlay
constexpr double kLineShare = 1.0 / 48;  // of its longer side

struct Colour {
  double red = 0, green = 0, blue = 0, alpha = 1;
};
constexpr Colour kLattice{1, 1, 1, 0.6}, kShade{0, 0, 0, 0.35};
constexpr Colour kTarget{0, 0.85, 1, 1}, kSource{0.95, 0.1, 0.1, 1}, kPin{1, 1, 1, 1};

double scale_of(double side) {
  if (side > kGreatestSide) return kGreatestSide / side;
  return side < kLeastSide ? std::ceil(kEnlargedSide / side) : 1.0;
}

/// The picture as it is shown on a screen: float pictures are linear and get sRGB's curve.
std::uint8_t shown(float value, bool linear) {
  double x = std::clamp(double(value), 0.0, 1.0);
  if (!(x >= 0)) x = 0;
  if (linear) x = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return std::uint8_t(std::lround(255 * x));
}

class Overlay {
 public:
  Overlay(const Image& picture, const multigrid::Solution& solution)
      : solution_(solution),
        map_(map_of(solution)),
        scale_(scale_of(std::max(picture.width(), picture.height()))),
        side_(scale_ * std::max(picture.width(), picture.height())),
        surface_(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, pixels(picture.width()),
                                            pixels(picture.height())),
                 cairo_surface_destroy),
        context_(cairo_create(surface_.get()), cairo_destroy) {
    cairo_scale(context_.get(), scale_, scale_);
    draw_picture(picture);
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context_.get(), CAIRO_LINE_CAP_ROUND);
  }

  void draw_lattice() {
    const grid::Lattice& lattice = solution_.lattice;
    const double gap = std::max(kLineGap, kLineShare * side_) / scale_;
    const int stride = std::max(1, int(std::ceil(gap / lattice.cell_px - 1e-9)));
    for (int j = 0; j <= lattice.ny; j += stride) {
      for (int i = 0; i <= lattice.nx; ++i) line_to(warped(lattice.rest_px(i, j)), i == 0);
    }
    for (int i = 0; i <= lattice.nx; i += stride) {
      for (int j = 0; j <= lattice.ny; ++j) line_to(warped(lattice.rest_px(i, j)), j == 0);
    }
    stroke(kShade, 2.4, true);
    stroke(kLattice, 1.0);
  }

  void draw_target(const SvgCurve& curve) {
    add(curve.pair.target, [](grid::Point p) { return p; });
    stroke(kShade, 8.5, true);
    stroke(curve.pin ? kPin : kTarget, curve.pin ? 4.0 : 6.5);
  }

  void draw_warped_source(const SvgCurve& curve) {
    add(curve.pair.source, [this](grid::Point p) { return warped(p); });
    stroke(kSource, 2.0);
  }

  void write(const std::filesystem::path& file) {
    cairo_surface_flush(surface_.get());
    cairo_status_t status = cairo_status(context_.get());
    if (status == CAIRO_STATUS_SUCCESS) {
      status = cairo_surface_write_to_png(surface_.get(), file.c_str());
    }
    if (status != CAIRO_STATUS_SUCCESS) {
      throw std::runtime_error(file.string() +
                               ": cannot be written: " + cairo_status_to_string(status));
    }
  }

 private:
  int pixels(int side) const { return std::max(1, int(std::lround(side * scale_))); }

  void draw_picture(const Image& picture) {
    const int width = picture.width(), height = picture.height(), channels = picture.channels();
    const int alpha = picture.spec.alpha_channel;
    const int colours = channels - (alpha >= 0 ? 1 : 0);
    const bool linear = picture.spec.format.is_floating_point();
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> base(
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height), cairo_surface_destroy);
    unsigned char* const data = cairo_image_surface_get_data(base.get());
    if (!data) throw std::runtime_error("overlay: the picture is too large");
    for (int y = 0; y < height; ++y) {
      auto* row = reinterpret_cast<std::uint32_t*>(
          data + std::ptrdiff_t(y) * cairo_image_surface_get_stride(base.get()));
      for (int x = 0; x < width; ++x) {
        const float* p = &picture.pixels[(std::size_t(y) * width + x) * channels];
        const auto value = [&](int c) {
          return std::uint32_t(shown(p[colours < 3 ? 0 : c], linear));
        };
        const std::uint32_t a = alpha >= 0 ? shown(p[alpha], false) : 255;
        const auto kept = [a](std::uint32_t colour) { return std::min(colour, a); };
        row[x] = a << 24 | kept(value(0)) << 16 | kept(value(1)) << 8 | kept(value(2));
      }
    }
    cairo_surface_mark_dirty(base.get());
    cairo_set_source_surface(context_.get(), base.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(context_.get()),
                             scale_ < 1 ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
    cairo_paint(context_.get());
  }

  grid::Point warped(grid::Point rest) const {
    const kernels::Position p = kernels::forward_position(map_, {rest.x, rest.y});
    return {p.x, p.y};
  }

  void line_to(grid::Point p, bool first) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    // Cairo's coordinates have 24 bits before the point.
    p.x = std::clamp(p.x, -1e5, 1e5), p.y = std::clamp(p.y, -1e5, 1e5);
    if (first)
      cairo_move_to(context_.get(), p.x, p.y);
    else
      cairo_line_to(context_.get(), p.x, p.y);
  }

  /// The chain's points carried by `place`, dense enough to follow every cell.
  template <class Place>
  void add(const std::vector<grid::CubicBezier>& chain, const Place& place) {
    bool first = true;
    for (const grid::CubicBezier& piece : chain) {
      const double step = std::min(solution_.lattice.cell_px / 2, 3 / scale_);
      const int points = std::clamp(int(std::ceil(grid::arc_length(piece) / step)), 1, 100000);
      for (int k = first ? 0 : 1; k <= points; ++k) {
        line_to(place(piece.at(double(k) / points)), first);
        first = false;
      }
    }
  }

  /// Strokes the current path, `width` in units that grow with the picture: 1 at 1200 pixels or
  /// less.
  void stroke(Colour colour, double width, bool keep = false) {
    cairo_set_source_rgba(context_.get(), colour.red, colour.green, colour.blue, colour.alpha);
    cairo_set_line_width(context_.get(), width * std::max(1.0, side_ / 1200) / scale_);
    if (keep)
      cairo_stroke_preserve(context_.get());
    else
      cairo_stroke(context_.get());
  }

  const multigrid::Solution& solution_;
  const kernels::LatticeMapView map_;
  const double scale_;
  const double side_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace

void write_overlay(const Image& warped, const multigrid::Solution& solution,
                   const std::vector<SvgCurve>& curves, const std::filesystem::path& file) {
  Overlay overlay(warped, solution);
  overlay.draw_lattice();
  for (const SvgCurve& curve : curves) overlay.draw_target(curve);
  for (const SvgCurve& curve : curves) {
    if (!curve.pin) overlay.draw_warped_source(curve);
  }
  overlay.write(file);
}

}  // namespace drumhead::driver
