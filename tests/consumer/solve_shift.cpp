// SPDX-License-Identifier: MIT
#include <drumhead/multigrid/warp.h>
#include <cmath>
#include <cstdio>

using namespace drumhead;

int main() {  // in a picture of 1000 × 1000 pixels, a disc moves 300 pixels to the right
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(1000, 1000, {.cells = 64, .margin = 0.0});
  problem.material.kappa = 10.0;  // resistance to compression, in units of the stiffness mu
  const auto rim = [](double x, int degrees) {
    const double a = degrees * 3.14159265358979 / 180.0;
    return grid::Point{x + 100.0 * std::cos(a), 500.0 + 100.0 * std::sin(a)};
  };
  grid::CurvePair disc{.name = "disc"};
  for (int k = 0; k < 360; ++k) {
    disc.source.push_back(grid::straight(rim(350, k), rim(350, k + 1)));
    disc.target.push_back(grid::straight(rim(650, k), rim(650, k + 1)));
  }
  problem.curves = {disc};
  const multigrid::Solution warp = multigrid::solve(problem);  // node (i, j): warp.u_px, warp.v_px
  const double gap = warp.report.curves[0].gap_rms_px;
  std::printf("%s, the rim is met to %.2f px\n", name(warp.report.status), gap);
  return warp.report.status == multigrid::Status::converged && gap < 1.0 ? 0 : 1;
}
