// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <drumhead/multigrid/warp.h>

using namespace drumhead;

int main() {  // a disc of a 1000 × 1000 picture moves 300 pixels to the right
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(1000, 1000, {.cells = 64, .margin = 0.0});
  problem.material.kappa = 10.0;
  grid::CurvePair rim{.name = "rim"};
  for (int k = 0; k < 360; ++k) {
    const auto at = [](double x, int degrees) {
      const double a = degrees * 3.14159265358979 / 180.0;
      return grid::Point{x + 100.0 * std::cos(a), 500.0 + 100.0 * std::sin(a)};
    };
    rim.source.push_back(grid::straight(at(350, k), at(350, k + 1)));
    rim.target.push_back(grid::straight(at(650, k), at(650, k + 1)));
  }
  problem.curves.push_back(rim);
  const multigrid::Solution solution = multigrid::solve(problem);
  const double gap = solution.report.curves[0].gap_rms_px;
  std::printf("%s, the rim is met to %.2f px\n", name(solution.report.status), gap);
  return solution.report.status == multigrid::Status::converged && gap < 1.0 ? 0 : 1;
}
