// SPDX-License-Identifier: MIT
#include <drumhead/multigrid/warp.h>
#include <cmath>
#include <cstdio>
#include <string>

using namespace drumhead;

int main() {  // one of nine discs in a picture of 1000 × 1000 pixels is dragged to the right
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(1000, 1000, {.cells = 128, .margin = 0.0});
  for (int n = 0; n < 9; ++n) {
    const auto rim = [n](int k) {
      const double a = k * 3.14159265358979 / 10.0;
      return grid::Point{173 + 330 * (n % 3) + 80 * std::cos(a),
                         169 + 330 * (n / 3) + 80 * std::sin(a)};
    };
    grid::CurvePair disc{.name = "disc " + std::to_string(n)};
    for (int k = 0; k < 20; ++k) disc.source.push_back(grid::straight(rim(k), rim(k + 1)));
    disc.target = disc.source;
    problem.curves.push_back(disc);
  }
  multigrid::KeptLevels kept;
  multigrid::Solution warp = multigrid::solve(problem, {.kept = &kept});
  for (int step = 0; step < 8; ++step) {
    for (grid::CubicBezier& segment : problem.curves[4].target)
      for (grid::Point& p : segment.control) p.x += 5.0;
    warp = multigrid::solve(problem, {.tolerance_px = 0.5, .start = &warp, .kept = &kept});
  }
  const double u = warp.u_px[64 * 129 + 64];  // of the node in the middle, which the disc carries
  std::printf("%s, the middle went %.1f px; the last step cut for %.2f ms and solved for %.2f\n",
              name(warp.report.status), u, 1e3 * warp.report.cut_seconds,
              1e3 * warp.report.solve_seconds);
  return warp.report.status == multigrid::Status::converged && std::abs(u - 40.0) < 1.0 ? 0 : 1;
}
