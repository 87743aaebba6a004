// SPDX-License-Identifier: MIT
#include "pictures.h"

#include <algorithm>
#include <optional>

#include "canvas.h"
#include "field_pictures.h"
#include "overlay.h"
#include "render.h"
#include "stopwatch.h"

namespace drumhead::driver {
namespace {

class Pictures {
 public:
  Pictures(const PictureTask& task, Progress& progress, Seconds& seconds)
      : task_(task), progress_(progress), seconds_(seconds) {}

  /// The warped picture to its file, and under the lines of those that show it.
  void warp(const PictureFiles& files) {
    std::optional<Canvas> overlay;
    if (!files.overlay.empty()) overlay.emplace(task_.frame, Canvas::kFileSide);
    if (overlay || !files.output.empty()) render(files.output, overlay);
    if (overlay) {
      draw_overlay(task_.solution, task_.curves, *overlay);
      write(*overlay, files.overlay, "the overlay");
    }
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

 private:
  ShareDone share(const std::string& phase) {
    return [this, phase](double done) { progress_.show(phase, done); };
  }

  void render(const std::filesystem::path& output, std::optional<Canvas>& overlay) {
    const Frame& frame = task_.frame;
    const bool linear = task_.picture.linear();
    progress_.show("rendering", 0.0);
    const Renderer renderer(task_.picture, task_.solution, frame, task_.border, task_.threads);
    std::optional<ImageWriter> writer;
    if (!output.empty()) writer.emplace(renderer.spec(), task_.picture.decoded, output);
    const int step = band_rows(frame.width);
    for (int top = 0; top < frame.height; top += step) {
      std::vector<float> rows = renderer.rows(top, std::min(step, frame.height - top));
      if (overlay) overlay->add_rows(renderer.spec(), linear, rows);
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

void make_pictures(const PictureTask& task, const PictureFiles& files, Progress& progress,
                   Seconds& seconds) {
  Pictures pictures(task, progress, seconds);
  pictures.warp(files);
  if (!files.checkerboard.empty()) pictures.checkerboard(files.checkerboard);
  if (!files.jacobian.empty()) pictures.jacobian(files.jacobian);
}

}  // namespace drumhead::driver
