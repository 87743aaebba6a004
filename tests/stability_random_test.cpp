// SPDX-License-Identifier: MIT
// Random scenes whose targets fit together: one smooth map carries all curves, which cross, touch,
// run parallel, end in cells, or are shorter than one (random_curves.h). From kappa 0 to 1e4 mu
// they are solved.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include <drumhead/multigrid/warp.h>

#include "support/random_curves.h"

namespace drumhead {
namespace {

using grid::Point;

/// Four bumps that shift what is near them, and nothing at the edge of an n × n square.
class SmoothMap {
 public:
  SmoothMap(grid::RandomCurves& random, int n) : n_(n) {
    for (Bump& bump : bumps_) {
      bump.radius = random.number(0.12, 0.35) * n;
      bump.centre = {random.number(0.1, 0.9) * n, random.number(0.1, 0.9) * n};
      bump.shift = {random.number(-0.4, 0.4) * bump.radius, random.number(-0.4, 0.4) * bump.radius};
    }
  }
  Point operator()(Point at) const {
    const double edge = std::min({at.x, at.y, n_ - at.x, n_ - at.y});
    const double s = std::clamp(edge / (0.15 * n_), 0.0, 1.0), fade = s * s * (3.0 - 2.0 * s);
    Point out = at;
    for (const Bump& bump : bumps_) {
      const double r = grid::length(at - bump.centre) / bump.radius;
      out = out + fade * std::exp(-r * r) * bump.shift;
    }
    return out;
  }
  /// The curve as chords, each carried to its image.
  grid::CurvePair carried(const grid::CurvePair& curve) const {
    grid::CurvePair out{.name = curve.name, .source = {}, .target = {}, .weight = curve.weight};
    const int pieces = curve.source.size() > 20 ? 1 : 12;
    for (const grid::CubicBezier& segment : curve.source)
      for (int k = 0; k < pieces; ++k) {
        const Point a = segment.at(double(k) / pieces), b = segment.at(double(k + 1) / pieces);
        out.source.push_back(grid::straight(a, b));
        out.target.push_back(grid::straight((*this)(a), (*this)(b)));
      }
    return out;
  }

 private:
  struct Bump {
    Point centre, shift;
    double radius = 0.0;
  };
  double n_;
  std::array<Bump, 4> bumps_;
};

multigrid::WarpProblem random_problem(unsigned seed, double kappa) {
  const int n = std::array{24, 48, 64, 100}[seed % 4];
  grid::RandomCurves random(seed, n, n);
  const SmoothMap map(random, n);
  multigrid::WarpProblem problem{.lattice = grid::unit_lattice(n, n), .material = {}, .curves = {}};
  problem.material.kappa = kappa;
  for (int count = random.whole(1, 5); count > 0; --count) {
    grid::CurvePair curve = random.any();
    curve.name = "curve " + std::to_string(count);
    problem.curves.push_back(map.carried(curve));
  }
  return problem;
}

struct Bound {
  double kappa;
  int scenes, unsolved;
};
void PrintTo(const Bound& b, std::ostream* out) { *out << "kappa " << b.kappa; }
class FittingTargets : public testing::TestWithParam<Bound> {};

TEST_P(FittingTargets, AreSolved) {
  const auto [kappa, scenes, most] = GetParam();
  int unsolved = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    const multigrid::Solution solution = multigrid::solve(random_problem(unsigned(seed), kappa));
    for (const double u : solution.u_px) ASSERT_TRUE(std::isfinite(u)) << seed;
    for (const double v : solution.v_px) ASSERT_TRUE(std::isfinite(v)) << seed;
    if (solution.report.status == multigrid::Status::converged) continue;
    ++unsolved;
    std::printf("kappa %g, seed %d, %d²: %s\n", kappa, seed, solution.lattice.nx,
                multigrid::name(solution.report.status));
  }
  EXPECT_LE(unsolved, most);
}

// At kappa/mu 1e4 closed curves whose area changes press with hundreds of mu, and of 60 scenes 17
// once ended otherwise.
INSTANTIATE_TEST_SUITE_P(Random, FittingTargets,
                         testing::Values(Bound{0.0, 60, 0}, Bound{1.0, 60, 0}, Bound{10.0, 60, 0},
                                         Bound{100.0, 60, 0}, Bound{1e3, 60, 1},
                                         Bound{1e4, 60, 4}));

}  // namespace
}  // namespace drumhead
