// SPDX-License-Identifier: MIT
// A scene of the driver through a thin-plate spline instead of the membrane: the same curves,
// sampled, and the same fixed edge.
//   spline_pictures SCENE.toml SPACING OUT.png CHECKERBOARD.png     px between the points, >= 1
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "curve_settings.h"
#include "pictures.h"
#include "point_warps.h"
#include "render.h"
#include "scene.h"
#include "svg_picture.h"

namespace drumhead::bench {
namespace {

void draw(const char* scene, double spacing, const driver::PictureFiles& files) {
  driver::Options options;
  driver::read_scene(scene, options);
  const driver::Image picture = driver::rasterise(options.picture);
  const driver::SvgCurves drawing =
      driver::read_curves(driver::SvgDocument(options.picture), picture.width(), picture.height());
  multigrid::Solution solution;
  solution.lattice = grid::make_lattice(picture.width(), picture.height(), options.lattice);
  const PointPairs points =
      points_on(driver::apply_settings(options, drawing.curves), solution.lattice, spacing);
  evaluate(thin_plate_spline(points), solution.lattice, solution.u_px, solution.v_px);
  int folded = 0;
  for (int j = 0; j < solution.lattice.ny; ++j)
    for (int i = 0; i < solution.lattice.nx; ++i)
      folded += multigrid::cell_J(solution, i, j).least_corner < 0.0;
  driver::Progress progress(true);
  driver::Seconds seconds;
  driver::make_pictures({.picture = picture,
                         .solution = solution,
                         .curves = drawing.curves,
                         .frame = driver::frame_of(picture, solution.lattice, false)},
                        files, nullptr, progress, seconds);
  std::printf("%s: %zu points, %d of %zu cells folded\n", scene, points.from.size(), folded,
              solution.lattice.cells());
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  const double spacing = argc == 5 ? std::atof(argv[2]) : 0.0;
  if (!(spacing >= 1.0)) {
    std::fprintf(stderr, "usage: spline_pictures SCENE.toml SPACING OUT.png CHECKERBOARD.png\n");
    return 2;
  }
  try {
    drumhead::bench::draw(argv[1], spacing, {.output = argv[3], .checkerboard = argv[4]});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spline_pictures: %s\n", error.what());
    return 2;
  }
  return 0;
}
