// SPDX-License-Identifier: MIT
#include "scene.h"

#include <algorithm>

namespace drumhead::multigrid {
namespace {

// kappa is capped where a further increase changes nothing that is seen.
constexpr double kMostKappa = 1e4;

}  // namespace

grid::Material capped(const grid::Material& material, SolveReport& report) {
  grid::Material out = material;
  if (kernels::isotropic(material.model)) return out;
  bool changed = out.kappa > kMostKappa;
  out.kappa = std::min(out.kappa, kMostKappa);
  for (float& kappa : out.kappa_cells) {
    changed = changed || kappa > float(kMostKappa);
    kappa = std::min(kappa, float(kMostKappa));
  }
  if (changed)
    report.notes.push_back(
        "kappa above 1e4 mu was taken as 1e4 mu; exact constraints take it as it is");
  return out;
}

double largest_mu(const grid::Material& material) {
  if (material.mu_cells.empty()) return 1.0;
  return double(*std::ranges::max_element(material.mu_cells));
}

double largest_kappa(const grid::Material& material) {
  if (material.kappa_cells.empty()) return material.kappa;
  return double(*std::ranges::max_element(material.kappa_cells));
}

bool has_pressure(const grid::Material& material) {
  return material.model == kernels::Model::crpm && largest_kappa(material) > 0.0;
}

bool has_tips(const WarpProblem& problem) {
  const grid::Lattice& lattice = problem.lattice;
  const grid::Point low = lattice.origin_px, high = lattice.rest_px(lattice.nx, lattice.ny);
  const double near = lattice.cell_px / 4.0;
  auto inside = [&](grid::Point p) {
    return std::min({p.x - low.x, p.y - low.y, high.x - p.x, high.y - p.y}) > near;
  };
  return std::ranges::any_of(problem.curves, [&](const grid::CurvePair& curve) {
    const grid::Point first = curve.source.front().control[0],
                      last = curve.source.back().control[3];
    return grid::length(last - first) > 1e-3 * near && (inside(first) || inside(last));
  });
}

double smallest_feature(const WarpProblem& problem) {
  double smallest = std::max(problem.lattice.nx, problem.lattice.ny);
  for (const grid::CurvePair& curve : problem.curves) {
    grid::Point low = curve.source.front().control[0], high = low;
    for (const grid::CubicBezier& segment : curve.source)
      for (const grid::Point& p : segment.control) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    smallest = std::min(smallest, grid::length(high - low) / problem.lattice.cell_px);
  }
  return smallest;
}

}  // namespace drumhead::multigrid
