// SPDX-License-Identifier: MIT
#include "warp_rivals.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "nested_newton.h"
#if DRUMHEAD_BENCH_OPENCV_SHAPE
#include <opencv2/shape/shape_transformer.hpp>
#endif

namespace drumhead::bench {
namespace {

constexpr double kHit = 1e-5;        // px: own points are met to rounding
constexpr double kGapSpacing = 0.5;  // px

struct Rival {
  std::string name;
  std::function<PointWarp(const PointPairs&)> fit;
  double hit_px = kHit;
};

#if DRUMHEAD_BENCH_OPENCV_SHAPE
/// In single precision: it may miss its own points by some pixels (12 were seen).
PointWarp opencv_spline(const PointPairs& points) {
  const auto row = [](const std::vector<Complex>& from) {
    std::vector<cv::Point2f> to;
    for (const Complex p : from) to.emplace_back(float(p.real()), float(p.imag()));
    return to;
  };
  std::vector<cv::DMatch> matches;
  for (int k = 0; k < int(points.from.size()); ++k) matches.emplace_back(k, k, 0.0F);
  const auto spline = cv::createThinPlateSplineShapeTransformer();
  spline->estimateTransformation(row(points.from), row(points.to), matches);
  return [spline, row](Complex v) {
    std::vector<cv::Point2f> out;
    spline->applyTransformation(row({v}), out);
    return Complex(out[0].x, out[0].y);
  };
}
#endif

std::vector<Rival> rivals() {
  return {
    {"thin-plate spline", thin_plate_spline},
#if DRUMHEAD_BENCH_OPENCV_SHAPE
        {"OpenCV thin-plate spline", opencv_spline, 30.0},
#endif
        {"moving least squares, rigid",
         [](const PointPairs& points) { return moving_least_squares(points, Fit::rigid); }},
        {"moving least squares, similarity",
         [](const PointPairs& points) { return moving_least_squares(points, Fit::similarity); }},
        {"Shepard", shepard},
  };
}

std::string file_name(std::string name) {
  std::string out;
  for (const char c : name)
    if (c != ',') out += c == ' ' ? '-' : c;
  return out;
}

Json row_of(const WarpScene& scene, const std::string& method, const multigrid::Solution& solution,
            double seconds, const WarpQuality& found) {
  return {{"scene", scene.name},
          {"width", scene.width},
          {"height", scene.height},
          {"method", method},
          {"n", std::max(solution.lattice.nx, solution.lattice.ny)},
          {"status", multigrid::name(solution.report.status)},
          {"seconds", seconds},
          {"gap_rms_px", found.gap_rms_px},
          {"gap_max_px", found.gap_max_px},
          {"folded_share", found.folded_share},
          {"rms_J", found.rms_J}};
}

void run_membrane(const WarpScene& scene, double kappa, multigrid::CurveMethod method,
                  Results& results, const Show& show) {
  multigrid::WarpProblem problem = scene.problem;
  problem.material.kappa = kappa;
  multigrid::SolverOptions options;
  options.threads = 1;
  options.curve_method = method;
  const double start = now();
  const multigrid::Solution solution = multigrid::solve(problem, options);
  const double seconds = now() - start;
  const kernels::LatticeMapView map = map_of(solution);
  const WarpQuality found = quality(scene, solution, [&](Complex p) {
    const kernels::Position to = kernels::forward_position(map, {p.real(), p.imag()});
    return Complex(to.x, to.y);
  });
  const std::string name = std::string("drumhead, ") + multigrid::name(method);
  Json row = row_of(scene, name, solution, seconds, found);
  row["kappa"] = kappa;
  results.row("warps", row);
  if (show) show(file_name(name) + "-" + words(kappa), solution);
}

bool run_rival(const WarpScene& scene, const Rival& rival, double spacing, Results& results,
               const Show& show) {
  multigrid::Solution solution;
  solution.lattice = scene.problem.lattice;
  const double start = now();
  const PointPairs points = points_on(scene.problem.curves, solution.lattice, spacing);
  const PointWarp warp = rival.fit(points);
  evaluate(warp, solution.lattice, solution.u_px, solution.v_px);
  const double seconds = now() - start;
  double miss = 0.0;
  for (std::size_t k = 0; k < points.from.size(); ++k)
    miss = std::max(miss, std::abs(warp(points.from[k]) - points.to[k]));
  if (!(miss <= rival.hit_px)) {
    std::fprintf(stderr, "%s on %s misses a point of its own by %g px\n", rival.name.c_str(),
                 scene.name.c_str(), miss);
    return false;
  }
  Json row = row_of(scene, rival.name, solution, seconds, quality(scene, solution, warp));
  row["points"] = points.from.size();
  row["spacing_px"] = spacing;
  results.row("warps", row);
  if (show) show(file_name(rival.name), solution);
  return true;
}

}  // namespace

WarpQuality quality(const WarpScene& scene, const multigrid::Solution& solution,
                    const PointWarp& warp) {
  WarpQuality found;
  const PointPairs dense = points_on(scene.problem.curves, kGapSpacing);
  for (std::size_t k = 0; k < dense.from.size(); ++k) {
    const double gap = std::abs(warp(dense.from[k]) - dense.to[k]);
    found.gap_rms_px += gap * gap;
    found.gap_max_px = std::max(found.gap_max_px, gap);
  }
  found.gap_rms_px = std::sqrt(found.gap_rms_px / double(dense.from.size()));

  const int w = scene.width, h = scene.height;
  std::vector<kernels::Position> moved(std::size_t(w) * std::size_t(h));
  kernels::forward_map(map_of(solution), {moved.data(), w, h, w, 0, 0});
  const auto at = [&](int a, int b) {
    return moved[std::size_t(b) * std::size_t(w) + std::size_t(a)];
  };
  double sum = 0.0, folded = 0.0;
  for (int b = 0; b + 1 < h; ++b)
    for (int a = 0; a + 1 < w; ++a) {
      const kernels::Position p00 = at(a, b), p10 = at(a + 1, b), p01 = at(a, b + 1),
                              p11 = at(a + 1, b + 1);
      const double J =
          0.5 * ((p11.x - p00.x) * (p01.y - p10.y) - (p11.y - p00.y) * (p01.x - p10.x));
      sum += (J - 1.0) * (J - 1.0);
      folded += J <= 0.0;
    }
  const double squares = double(w - 1) * double(h - 1);
  found.rms_J = std::sqrt(sum / squares);
  found.folded_share = folded / squares;
  return found;
}

void compare_membranes(const WarpScene& scene, Results& results, const Show& show) {
  for (const double kappa : scene.kappas)
    for (const auto method : {multigrid::CurveMethod::averaged, multigrid::CurveMethod::conforming})
      run_membrane(scene, kappa, method, results, show);
}

bool compare_rivals(const WarpScene& scene, double spacing, Results& results, const Show& show) {
  bool right = true;
  for (const Rival& rival : rivals()) right &= run_rival(scene, rival, spacing, results, show);
  return right;
}

}  // namespace drumhead::bench
