// SPDX-License-Identifier: MIT
// A scene of `drumhead warp` by drumhead and by its rivals, as pictures side by side and as rows of
// the table "warps" (warp_rivals.h): the paper's Figure 6, which has a thin-plate spline beside it.
//   warp_pictures SCENE.toml FOLDER [SPACING]
// writes FOLDER/<scene>-<method>.png and FOLDER/<scene>-<method>-checkerboard.png; SPACING px
// between the rivals' points, default a sixtieth of the picture's longer side. Keys of the scene
// that shape the membrane count (cells, margin, kappa, weights, turns), masks do not.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "curve_settings.h"
#include "image.h"
#include "pictures.h"
#include "progress.h"
#include "render.h"
#include "scene.h"
#include "svg_curves.h"
#include "svg_picture.h"
#include "warp_rivals.h"

namespace {

using namespace drumhead;

bool draw(const std::filesystem::path& file, const std::filesystem::path& folder, double spacing,
          bench::Results& results) {
  driver::Options options;
  driver::read_scene(file, options);
  const bool drawn = driver::has_extension(options.picture, ".svg");
  if (drawn && options.curves.empty()) options.curves = options.picture;
  const driver::Image picture =
      drawn ? driver::rasterise(options.picture) : driver::read_image(options.picture);
  const std::vector<driver::SvgCurve> curves =
      driver::read_curves(driver::SvgDocument(options.curves), picture.width(), picture.height(),
                          [](const std::string&) {});
  bench::WarpScene scene{
      file.stem().string(), {}, {options.kappa}, picture.width(), picture.height()};
  scene.problem.lattice = grid::make_lattice(scene.width, scene.height, options.lattice);
  scene.problem.curves = driver::apply_settings(options, curves);

  driver::Progress progress(true);
  driver::Seconds seconds;
  const driver::Frame frame = driver::frame_of(picture, scene.problem.lattice, false);
  const bench::Show show = [&](const std::string& method, const multigrid::Solution& solution) {
    const auto name = [&](const char* suffix) {
      return folder / (scene.name + "-" + method + suffix);
    };
    driver::make_pictures({picture, solution, curves, frame},
                          {.output = name(".png"), .checkerboard = name("-checkerboard.png")},
                          nullptr, progress, seconds);
  };
  if (!(spacing > 0.0)) spacing = std::max(scene.width, scene.height) / 60.0;
  bench::compare_membranes(scene, results, show);
  return bench::compare_rivals(scene, spacing, results, show);
}

}  // namespace

int main(int argc, char** argv) {
  const double spacing = argc == 4 ? std::atof(argv[3]) : 0.0;
  if (argc < 3 || argc > 4 || (argc == 4 && !(spacing > 0.0))) {
    std::fprintf(stderr, "usage: warp_pictures SCENE.toml FOLDER [SPACING > 0]\n");
    return 2;
  }
  try {
    std::filesystem::create_directories(argv[2]);
    bench::Results results(argc, argv);
    return draw(argv[1], argv[2], spacing, results) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "warp_pictures: %s\n", error.what());
    return 2;
  }
}
