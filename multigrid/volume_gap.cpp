// SPDX-License-Identifier: MIT
#include "volume_gap.h"

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {
namespace {

/// Σ g²/(A/kappa) over the parts of special cells, whose plane holds 0.
template <class T>
double part_gaps(const Level<T>& level) {
  const kernels::SpecialCells<T>& cells = level.conforming->cells;
  const kernels::Plane<const T> compliance = level.compliance.view();
  double sum = 0.0;
  for (int j = 0; j < level.ny; ++j)
    for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n) {
      const std::size_t c = std::size_t(n);
      const T soft = compliance ? compliance.at(cells.column[c], j) : level.compliance_value;
      for (int p = cells.part_begin[c]; p < cells.part_begin[c + 1] && soft > T(0); ++p) {
        const double g = double(level.f.listed[std::size_t(p)]);
        sum += g * g / (double(cells.area[std::size_t(p)]) * double(soft));
      }
    }
  return sum;
}

}  // namespace

template <class T>
double volume_gap(const Level<T>& level, double enough) {
  const double area = double(level.spacing) * double(level.spacing);
  // −A (J* − 1 − P/kappa)
  const kernels::Plane<const T> g = level.f.view().p, mu = level.mu.view();
  const kernels::Plane<const T> compliance = level.compliance.view();
  if (!level.pressure || (!compliance && level.compliance_value == T(0))) return 0.0;
  double gap = 0.0, rest = double(level.nx) * double(level.ny);
  if (!compliance) gap = kernels::dot<T>(g, g) / double(level.compliance_value);
  if (mu) rest = 0.0;
  for (int j = 0; j < level.ny && (compliance || mu); ++j)
    for (int i = 0; i < level.nx; ++i) {
      if (compliance && compliance.at(i, j) > T(0))
        gap += double(g.at(i, j)) * double(g.at(i, j)) / double(compliance.at(i, j));
      if (mu) rest += double(mu.at(i, j));
    }
  gap /= area;
  if (level.conforming) gap += part_gaps(level);
  gap *= 0.5;
  if (enough == 0.0 || gap <= enough * area * rest) return gap / (area * rest);
  const kernels::EnergySums sums = kernels::energy<T>(level.membrane(), {}, T(0));
  return gap / (sums.elastic + sums.volume);
}

template double volume_gap(const Level<float>&, double);
template double volume_gap(const Level<double>&, double);

void note_areas(SolveReport& report) {
  if (!report.exact && report.status == Status::converged && report.volume_gap > kMostVolumeGap)
    report.notes.push_back("curves and areas contradict one another on this lattice: share " +
                           std::to_string(report.volume_gap) + " of the energy");
}

}  // namespace drumhead::multigrid
