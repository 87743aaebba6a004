// SPDX-License-Identifier: MIT
#include "volume_gap.h"

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

#include "words.h"

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
double volume_gap(const Level<T>& level, double squares, double stiffness, double enough) {
  const double area = double(level.spacing) * double(level.spacing);
  // −A (J* − 1 − P/kappa)
  const kernels::Plane<const T> g = level.f.view().p, compliance = level.compliance.view();
  if (!level.pressure || (!compliance && level.compliance_value == T(0))) return 0.0;
  double gap = compliance ? kernels::squares_over<T>(g, compliance)
                          : squares / double(level.compliance_value);
  gap /= area;
  if (level.conforming) gap += part_gaps(level);
  gap *= 0.5;
  if (enough == 0.0 || gap <= enough * area * stiffness) return gap / (area * stiffness);
  const kernels::EnergySums sums = kernels::energy<T>(level.membrane(), {}, T(0));
  return gap / (sums.elastic + sums.volume);
}

template <class T>
double total_stiffness(const Level<T>& level) {
  const kernels::Plane<const T> mu = level.mu.view();
  if (!mu) return double(level.nx) * double(level.ny);
  double sum = 0.0;
  for (int j = 0; j < level.ny; ++j)
    for (int parity = 0; parity < 2; ++parity) {
      const T* half = mu.half(j, parity);
      for (int k = 0; k < kernels::half_count(level.nx, parity); ++k) sum += double(half[k]);
    }
  return sum;
}

template double volume_gap(const Level<float>&, double, double, double);
template double volume_gap(const Level<double>&, double, double, double);
template double total_stiffness(const Level<float>&);
template double total_stiffness(const Level<double>&);

void note_areas(SolveReport& report) {
  if (!report.exact && report.status == Status::converged && report.volume_gap > kMostVolumeGap)
    report.notes.push_back("curves and areas contradict one another on this lattice: share " +
                           figure(report.volume_gap) + " of the energy");
}

}  // namespace drumhead::multigrid
