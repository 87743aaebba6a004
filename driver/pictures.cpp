// SPDX-License-Identifier: MIT
#include "pictures.h"

#include <algorithm>
#include <optional>

#include "canvas.h"
#include "field_pictures.h"
#include "overlay.h"
#include "plate.h"
#include "render.h"
#include "stopwatch.h"

namespace drumhead::driver {
namespace {

class Pictures {
 public:
  Pictures(const PictureTask& task, Progress& progress, Seconds& seconds)
      : task_(task), progress_(progress), seconds_(seconds) {}

  /// The warped picture to its file, and under the lines of those that show it.
  void warp(const PictureFiles& files, PagePictures* page) {
    std::optional<Canvas> overlay, small;
    if (!files.overlay.empty()) overlay.emplace(task_.frame, Canvas::kFileSide);
    if (page) small.emplace(task_.frame, Canvas::kPageSide);
    if (overlay || small || !files.output.empty()) render(files.output, overlay, small);
    if (overlay) {
      draw_overlay(task_.solution, task_.curves, *overlay);
      write(*overlay, files.overlay, "the overlay");
    }
    if (!small) return;
    page->after = small->png();
    draw_overlay(task_.solution, task_.curves, *small);
    page->overlay = small->png();
    seconds_.render += watch_.lap();
  }

  /// The source picture where the warped one stands.
  void show_source(PagePictures& page) {
    const Image& picture = task_.picture;
    const Frame& frame = task_.frame;
    OIIO::ImageSpec spec = picture.spec;
    Canvas canvas(frame, Canvas::kPageSide);
    const auto channels = std::ptrdiff_t(picture.channels());
    const int from = std::max(0, -frame.left), past = std::max(0, frame.left);
    const int width = std::min(frame.width - from, picture.width() - past);
    std::vector<float> row(std::size_t(frame.width) * std::size_t(channels));
    for (int y = frame.top; y < frame.top + frame.height; ++y) {
      std::ranges::fill(row, 0.0f);
      if (y >= 0 && y < picture.height() && width > 0) {
        const auto first =
            picture.pixels.begin() + (std::ptrdiff_t(y) * picture.width() + past) * channels;
        std::copy_n(first, width * channels, row.begin() + from * channels);
      }
      if (task_.plate) lay_over(*task_.plate, frame, y - frame.top, row);
      canvas.add_rows(spec, picture.linear(), row);
    }
    page.before = canvas.png();
    seconds_.render += watch_.lap();
  }

  void checkerboard(const std::filesystem::path& file) {
    Canvas canvas(task_.frame, Canvas::kFileSide);
    draw_checkerboard(task_.solution, task_.picture.width(), task_.picture.height(), task_.threads,
                      canvas, share("rendering the checkerboard"));
    write(canvas, file, "the checkerboard");
  }

  void jacobian(const std::filesystem::path& file) {
    Canvas canvas(task_.frame, Canvas::kFileSide, kLegendStrip);
    draw_jacobian(task_.solution, task_.curves, task_.threads, canvas, share("rendering det J"));
    write(canvas, file, "det J");
  }

  void jacobian(PagePictures& page) {
    Canvas canvas(task_.frame, Canvas::kPageSide, kLegendStrip);
    draw_jacobian(task_.solution, task_.curves, task_.threads, canvas);
    page.jacobian = canvas.png();
    seconds_.render += watch_.lap();
  }

 private:
  ShareDone share(const std::string& phase) {
    return [this, phase](double done) { progress_.show(phase, done); };
  }

  void render(const std::filesystem::path& output, std::optional<Canvas>& overlay,
              std::optional<Canvas>& small) {
    const Frame& frame = task_.frame;
    const bool linear = task_.picture.linear();
    progress_.show("rendering", 0.0);
    const Renderer renderer(task_.picture, task_.solution, frame, task_.border, task_.threads);
    std::optional<ImageWriter> writer;
    if (!output.empty()) writer.emplace(renderer.spec(), task_.picture.decoded, output);
    const int step = band_rows(frame.width);
    for (int top = 0; top < frame.height; top += step) {
      std::vector<float> rows = renderer.rows(top, std::min(step, frame.height - top));
      if (task_.plate) lay_over(*task_.plate, frame, top, rows);
      if (overlay) overlay->add_rows(renderer.spec(), linear, rows);
      if (small) small->add_rows(renderer.spec(), linear, rows);
      seconds_.render += watch_.lap();
      if (writer) writer->write(std::move(rows));
      seconds_.write += watch_.lap();
      progress_.show(writer ? "rendering and writing" : "rendering",
                     std::min(1.0, double(top + step) / frame.height));
    }
    if (writer) writer->close();
    seconds_.write += watch_.lap();
  }

  void write(const Canvas& canvas, const std::filesystem::path& file, const std::string& what) {
    seconds_.render += watch_.lap();
    canvas.write_png(file, share("writing " + what));
    seconds_.write += watch_.lap();
  }

  const PictureTask& task_;
  Progress& progress_;
  Seconds& seconds_;
  Stopwatch watch_;
};

}  // namespace

void make_pictures(const PictureTask& task, const PictureFiles& files, PagePictures* page,
                   Progress& progress, Seconds& seconds) {
  Pictures pictures(task, progress, seconds);
  pictures.warp(files, page);
  if (!files.checkerboard.empty()) pictures.checkerboard(files.checkerboard);
  if (!files.jacobian.empty()) pictures.jacobian(files.jacobian);
  if (!page) return;
  progress.show("drawing the page's pictures");
  pictures.show_source(*page);
  pictures.jacobian(*page);
}

}  // namespace drumhead::driver
