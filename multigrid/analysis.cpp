// SPDX-License-Identifier: MIT
#include "analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <drumhead/kernels/folds.h>

namespace drumhead::multigrid {
namespace {

constexpr std::size_t kMostPlaces = 20;

double cross(kernels::Position a, kernels::Position b) { return a.x * b.y - a.y * b.x; }

/// Twice the areas of a triangle at rest and deformed.
std::array<double, 2> areas(const kernels::MapTriangle& triangle) {
  std::array<kernels::Position, 2> rest, moved;
  for (std::size_t k = 0; k < 2; ++k) {
    const kernels::Position r{triangle.rest[k + 1].x - triangle.rest[0].x,
                              triangle.rest[k + 1].y - triangle.rest[0].y};
    rest[k] = r;
    moved[k] = {r.x + triangle.displacement[k + 1].x - triangle.displacement[0].x,
                r.y + triangle.displacement[k + 1].y - triangle.displacement[0].y};
  }
  return {cross(rest[0], rest[1]), cross(moved[0], moved[1])};
}

}  // namespace

std::vector<CurveReport> curve_gaps(const Solution& solution,
                                    const std::vector<grid::CurvePair>& curves) {
  const kernels::LatticeMapView map = map_of(solution);
  const double spacing = 0.25 * solution.lattice.cell_px;  // of what is looked at
  std::vector<CurveReport> reports;
  for (const grid::CurvePair& curve : curves) {
    CurveReport report{.name = curve.name};
    double squares = 0.0, seen = 0.0, unseen = 0.0;  // of arc length
    grid::for_matched(curve, [&](const grid::CubicBezier& source, const grid::CubicBezier& target) {
      const double length = grid::arc_length(source);
      unseen += length;
      if (seen > 0.0 && unseen < spacing) return;  // most chords of a polyline
      const int points = std::max(1, int(std::ceil(length / spacing)));
      for (int n = 0; n < points; ++n) {
        const double t = (n + 0.5) / points;
        const grid::Point rest = source.at(t);
        const kernels::Position to = kernels::forward_position(map, {rest.x, rest.y});
        const double gap = grid::length(grid::Point{to.x, to.y} - target.at(t));
        const double speed = length > 0.0 ? grid::length(source.derivative(t)) / length : 1.0;
        squares += gap * gap * speed * unseen / points;
        if (gap > report.gap_max_px) {
          report.gap_max_px = gap;
          report.worst_px = rest;
        }
      }
      seen += unseen;
      unseen = 0.0;
    });
    report.length_px = seen + unseen;
    report.gap_rms_px = seen > 0.0 ? std::sqrt(squares / seen) : 0.0;
    reports.push_back(report);
  }
  return reports;
}

double triangle_J(const kernels::MapTriangle& triangle) {
  const auto [before, after] = areas(triangle);
  return after / before;
}

namespace {

/// Of cell (i, j), which is split cell c; c −1: it is bilinear.
CellJ cell_J(const Solution& s, int i, int j, int c) {
  if (c >= 0) {
    const kernels::SplitCellsView split = s.split.view();
    double rest = 0.0, moved = 0.0, least = std::numeric_limits<double>::infinity();
    for (int t = split.triangle_begin[c]; t < split.triangle_begin[c + 1]; ++t) {
      const auto [before, after] = areas(split.triangle[t]);
      rest += before;
      moved += after;
      least = std::min(least, after / before);
    }
    return {moved / rest, least};
  }
  const double scale = 1.0 / s.lattice.cell_px;
  const std::size_t row = std::size_t(s.lattice.nx) + 1, k = std::size_t(j) * row + std::size_t(i);
  auto node = [&](std::size_t n, double x, double y) {
    return grid::Point{x + scale * s.u_px[n], y + scale * s.v_px[n]};
  };
  const grid::Point p00 = node(k, 0, 0), p10 = node(k + 1, 1, 0), p01 = node(k + row, 0, 1),
                    p11 = node(k + row + 1, 1, 1);
  return {0.5 * grid::cross(p11 - p00, p01 - p10),
          std::min({grid::cross(p10 - p00, p01 - p00), grid::cross(p10 - p00, p11 - p10),
                    grid::cross(p11 - p01, p01 - p00), grid::cross(p11 - p01, p11 - p10)})};
}

/// The rest centre of a folded cell, of a split one that of its most inverted triangle.
grid::Point fold_place(const Solution& s, int i, int j) {
  const kernels::SplitCellsView split = s.split.view();
  const int c = split.find(i, j);
  if (c < 0) return s.lattice.rest_px(i, j) + 0.5 * s.lattice.cell_px * grid::Point{1.0, 1.0};
  grid::Point place;
  double least = std::numeric_limits<double>::infinity();
  for (int t = split.triangle_begin[c]; t < split.triangle_begin[c + 1]; ++t) {
    const kernels::MapTriangle& triangle = split.triangle[t];
    const double J = triangle_J(triangle);
    if (J >= least) continue;
    least = J;
    place = {};
    for (const kernels::Position& corner : triangle.rest)
      place = place + (1.0 / 3.0) * grid::Point{corner.x, corner.y};
  }
  return place;
}

}  // namespace

CellJ cell_J(const Solution& s, int i, int j) { return cell_J(s, i, j, s.split.view().find(i, j)); }

FoldReport find_folds(const Solution& s) {
  FoldReport folds;
  const kernels::LatticeMapView map = map_of(s);
  const std::vector<kernels::RowFolds> rows = kernels::count_folds(map);
  for (int j = 0; j < s.lattice.ny; ++j) {
    kernels::RowFolds row = rows[std::size_t(j)];
    const int begin = map.split.row_begin ? map.split.row_begin[j] : 0;
    const int end = map.split.row_begin ? map.split.row_begin[j + 1] : 0;
    for (int c = begin; c < end; ++c) {
      const auto [centre, least] = cell_J(s, map.split.column[c], j, c);
      row.least_J = std::min(row.least_J, centre);
      row.least_corner_J = std::min(row.least_corner_J, least);
      row.inverted += centre < 0.0;
      row.folded += least < 0.0;
    }
    folds.min_J = std::min(folds.min_J, row.least_J);
    folds.min_corner_J = std::min(folds.min_corner_J, row.least_corner_J);
    folds.inverted_cells += row.inverted;
    folds.folded_cells += row.folded;
    if (row.folded == 0) continue;
    for (int i = 0; i < s.lattice.nx && folds.places_px.size() < kMostPlaces; ++i)
      if (cell_J(s, i, j).least_corner < 0.0) folds.places_px.push_back(fold_place(s, i, j));
  }
  return folds;
}

}  // namespace drumhead::multigrid
