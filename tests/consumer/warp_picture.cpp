// SPDX-License-Identifier: MIT
#include <drumhead/multigrid/warp.h>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace drumhead;

/// The outline of a square about (200, 150), in pixels.
std::vector<grid::CubicBezier> square(double side) {
  const double x = 200 - side / 2, y = 150 - side / 2, r = x + side, b = y + side;
  return {grid::straight({x, y}, {r, y}), grid::straight({r, y}, {r, b}),
          grid::straight({r, b}, {x, b}), grid::straight({x, b}, {x, y})};
}

int main() {
  constexpr int w = 400, h = 300, rgb = 3;
  std::vector<float> picture(w * h * rgb), warped(w * h * rgb);
  for (int y = 110; y < 190; ++y)  // a red square of 80 × 80 pixels, to be made 120 × 120
    for (int x = 160; x < 240; ++x) picture[(y * w + x) * rgb] = 1.0F;

  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(w, h, {.cells = 100});
  problem.curves = {{.name = "square", .source = square(80), .target = square(120)}};
  const multigrid::Solution warp = multigrid::solve(problem);
  const kernels::LatticeMapView map = map_of(warp);  // a window: `warp` must outlive it
  const kernels::Resampler resampler({picture.data(), w, h, rgb, w * rgb}, map);
  resampler.render({warped.data(), w, h, rgb, w * rgb});

  double red = 0.0;
  for (const float value : warped) red += value;
  const kernels::Position corner = kernels::forward_position(map, {160.0, 110.0});
  std::printf("%.0f red pixels; (160, 110) went to (%.1f, %.1f)\n", red, corner.x, corner.y);
  const double off = std::hypot(corner.x - 140.0, corner.y - 90.0);
  return std::abs(red / (120 * 120) - 1.0) < 0.01 && off < 0.5 ? 0 : 1;
}
