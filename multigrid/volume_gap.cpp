// SPDX-License-Identifier: MIT
#include "volume_gap.h"

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {

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
  gap *= 0.5 / area;
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
