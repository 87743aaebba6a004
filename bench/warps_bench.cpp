// SPDX-License-Identifier: MIT
// What people warp pictures with instead, beside drumhead, on the study scenes as pictures of
// 1000 × 1000 px: rows of the table "warps" (warp_rivals.h).
//   warps_bench [SPACING…]     px between the rivals' points, default 32 8
#include <cstdio>

#include "support/scene_problem.h"
#include "warp_rivals.h"

namespace drumhead::bench {
namespace {

constexpr int kPicture = 1000, kCells = 250;

WarpScene in_pixels(const scenes::Scene& scene) {
  WarpScene result{
      scene.name, scenes::problem(scene, kCells, 1.0), {1.0, 10.0}, kPicture, kPicture};
  result.problem.lattice.cell_px *= kPicture;
  result.problem.lattice.side_px *= kPicture;
  const auto scale = [](std::vector<grid::CubicBezier>& chain) {
    for (grid::CubicBezier& segment : chain)
      for (grid::Point& p : segment.control) p = double(kPicture) * p;
  };
  for (grid::CurvePair& pair : result.problem.curves) {
    scale(pair.source);
    scale(pair.target);
  }
  return result;
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  std::vector<double> spacings;
  for (int k = 1; k < argc; ++k) {
    spacings.push_back(std::atof(argv[k]));
    if (!(spacings.back() >= 1.0)) {
      std::fprintf(stderr, "warps_bench: spacing %s: must be at least 1\n", argv[k]);
      return 2;
    }
  }
  if (spacings.empty()) spacings = {32.0, 8.0};
  bench::Results results(argc, argv);
  bool right = true;
  const double offset = scenes::kStudyOffset;
  for (const scenes::Scene& study :
       {scenes::sponge(offset), scenes::roundabout(90.0, offset), scenes::shift(offset)}) {
    const bench::WarpScene scene = bench::in_pixels(study);
    bench::compare_membranes(scene, results);
    for (const double spacing : spacings) right &= bench::compare_rivals(scene, spacing, results);
  }
  return right ? 0 : 1;
}
