// SPDX-License-Identifier: MIT
#include "analysis.h"

#include <algorithm>
#include <cmath>

namespace drumhead::multigrid {
namespace {

constexpr std::size_t kMostPlaces = 20;

/// Displacement in px at a rest point, bilinear in its cell.
grid::Point displacement(const Solution& s, grid::Point px) {
  const grid::Point at = s.lattice.to_cells(px);
  const int i = std::clamp(int(std::floor(at.x)), 0, s.lattice.nx - 1);
  const int j = std::clamp(int(std::floor(at.y)), 0, s.lattice.ny - 1);
  const double x = at.x - i, y = at.y - j;
  const std::size_t row = std::size_t(s.lattice.nx) + 1, k = std::size_t(j) * row + std::size_t(i);
  auto bilinear = [&](const std::vector<double>& f) {
    return (1 - y) * ((1 - x) * f[k] + x * f[k + 1]) +
           y * ((1 - x) * f[k + row] + x * f[k + row + 1]);
  };
  return {bilinear(s.u_px), bilinear(s.v_px)};
}

}  // namespace

std::vector<CurveReport> curve_gaps(const Solution& solution,
                                    const std::vector<grid::CurvePair>& curves) {
  std::vector<CurveReport> reports;
  for (const grid::CurvePair& curve : curves) {
    CurveReport report{.name = curve.name};
    double squares = 0.0;
    for (const grid::SegmentPair& pair : grid::matched(curve)) {
      const double length = grid::arc_length(pair.source);
      const int points = std::max(1, int(std::ceil(4.0 * length / solution.lattice.cell_px)));
      for (int n = 0; n < points; ++n) {
        const double t = (n + 0.5) / points;
        const grid::Point source = pair.source.at(t);
        const double gap =
            grid::length(source + displacement(solution, source) - pair.target.at(t));
        const double ds = grid::length(pair.source.derivative(t)) / points;
        squares += gap * gap * ds;
        report.length_px += ds;
        if (gap > report.gap_max_px) {
          report.gap_max_px = gap;
          report.worst_px = source;
        }
      }
    }
    report.gap_rms_px = report.length_px > 0.0 ? std::sqrt(squares / report.length_px) : 0.0;
    reports.push_back(report);
  }
  return reports;
}

CellJ cell_J(const Solution& s, int i, int j) {
  const double h = s.lattice.cell_px;
  const std::size_t row = std::size_t(s.lattice.nx) + 1, k = std::size_t(j) * row + std::size_t(i);
  auto node = [&](std::size_t n, double x, double y) {
    return grid::Point{x + s.u_px[n] / h, y + s.v_px[n] / h};
  };
  const grid::Point p00 = node(k, 0, 0), p10 = node(k + 1, 1, 0), p01 = node(k + row, 0, 1),
                    p11 = node(k + row + 1, 1, 1);
  return {0.5 * grid::cross(p11 - p00, p01 - p10),
          std::min({grid::cross(p10 - p00, p01 - p00), grid::cross(p10 - p00, p11 - p10),
                    grid::cross(p11 - p01, p01 - p00), grid::cross(p11 - p01, p11 - p10)})};
}

FoldReport find_folds(const Solution& s) {
  FoldReport folds;
  folds.min_J = folds.min_corner_J = 1.0;
  const double h = s.lattice.cell_px;
  for (int j = 0; j < s.lattice.ny; ++j)
    for (int i = 0; i < s.lattice.nx; ++i) {
      const auto [centre, least] = cell_J(s, i, j);
      folds.min_J = std::min(folds.min_J, centre);
      folds.min_corner_J = std::min(folds.min_corner_J, least);
      folds.inverted_cells += centre < 0.0;
      folds.folded_cells += least < 0.0;
      if (least < 0.0 && folds.places_px.size() < kMostPlaces)
        folds.places_px.push_back(s.lattice.rest_px(i, j) + grid::Point{0.5 * h, 0.5 * h});
    }
  return folds;
}

}  // namespace drumhead::multigrid
