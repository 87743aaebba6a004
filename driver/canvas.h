// SPDX-License-Identifier: MIT
#pragma once
// A picture of 8 bits that shows a frame at a size made for looking at, with lines and text over
// it. Lines and text grow with the picture, so that it looks the same at any size when it fills the
// same part of a screen.
#include <cairo.h>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "frame.h"
#include "image.h"

namespace drumhead::driver {

/// Not multiplied by alpha, sRGB, 0…1.
struct Colour {
  double red = 0, green = 0, blue = 0, alpha = 1;
};

class Canvas {
 public:
  /// The greatest side of a picture file, and of a picture on a page.
  static constexpr int kFileSide = 16384, kPageSide = 1024;

  /// Of the frame's size; enlarged by a whole factor where the frame's longer side has less than
  /// 500 pixels, made smaller by one where it has more than `greatest_side`. Below the frame
  /// `strip` units (see stroke) of room, at least 600 wide, for a legend.
  Canvas(const Frame& frame, int greatest_side, double strip = 0.0);

  const Frame& frame() const { return frame_; }
  /// The frame's part, in the canvas's pixels, and how many of them a picture's pixel has.
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double scale() const { return scale_; }
  /// Canvas pixels per unit of line width: 1 at 1200 pixels or less, more in proportion beyond.
  double unit() const;

  /// The frame's next rows from the top, as Image holds them; `linear`: colours are light. What is
  /// above 1 shows as 1.
  void add_rows(const OIIO::ImageSpec& spec, bool linear, const std::vector<float>& rows);

  /// Row y of the frame's part, columns() colours.
  void set_row(int y, const std::vector<Colour>& colours);

  /// Path and stroke in picture pixels, `width` in units. A path begins with `first`; points that
  /// are not finite are left out.
  void line_to(grid::Point p, bool first);
  void stroke(Colour colour, double width, bool keep = false);

  /// In units from the strip's left top corner.
  void fill_rectangle(double x, double y, double width, double height, Colour colour);
  /// `text` with its baseline at y, beginning at x, or around x.
  void write_text(double x, double y, const std::string& text, bool centred = false);

  /// Throws std::runtime_error naming `file`.
  void write_png(const std::filesystem::path& file, const ShareDone& progress = {}) const;
  /// The file's bytes.
  std::string png() const;

 private:
  std::uint32_t* row(int y) const;
  void put_pixel(const OIIO::ImageSpec& spec, bool linear, const float* value, int x, int y);
  void write_to(OIIO::ImageOutput& output, const std::string& name,
                const ShareDone& progress) const;

  Frame frame_;
  double scale_;
  int shrink_ = 1, enlarge_ = 1;
  int columns_, rows_, width_, height_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
  int next_row_ = 0;               // of the frame
  std::vector<float> block_sums_;  // of the rows that make one row of a canvas that is smaller
};

}  // namespace drumhead::driver
