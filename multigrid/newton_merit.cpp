// SPDX-License-Identifier: MIT
// The merit function of a step, and the search along it.
#include <algorithm>
#include <cmath>
#include <limits>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>

#include "newton.h"

namespace drumhead::multigrid {
namespace {

constexpr double kShortestStep = 1e-4;

}  // namespace

template <class T>
void Newton<T>::prepare_curve_merit() {
  const kernels::Cuts<T> cuts = level_.cuts.view(T(hierarchy_.traits().jump));
  const std::size_t values = level_.q.size();
  gap_.assign(values, 0.0);
  slope_.assign(values, 0.0);
  std::vector<T> q(values), image(values), zero(values, T(0));
  for (std::size_t k = 0; k < values; ++k) q[k] = level_.q[k] + level_.dq[k];
  const kernels::Unknowns<const T> u{level_.ux.view(), level_.uy.view(), {}};
  kernels::apply_cuts<T>(cuts, u, q.data(), image.data());
  penalty_ = 0.0;
  for (std::size_t k = 0; k < values; ++k) {
    const grid::Point b = level_.wanted[k / 2];
    gap_[k] = (k % 2 ? b.y : b.x) + double(image[k]);
    penalty_ = std::max(penalty_, 1.5 * std::abs(double(q[k])) / double(cuts.length[k / 2]));
  }
  kernels::apply_cuts<T>(cuts, level_.d.view(), zero.data(), image.data());
  for (std::size_t k = 0; k < values; ++k) slope_[k] = double(image[k]);
}

template <class T>
double Newton<T>::curve_merit(double step) const {
  const kernels::Cuts<T> cuts = level_.cuts.view(T(0));
  double sum = 0.0;
  for (std::size_t k = 0; k < gap_.size(); ++k)
    sum += double(cuts.length[k / 2]) * std::abs(gap_[k] + step * slope_[k]);
  return penalty_ * sum;
}

/// Σ q⁺·(b − W (x̂ + step d)): with the membrane's energy the Lagrangian, whose slope along a step
/// of Newton's method is −dᵀ H d.
template <class T>
double Newton<T>::curve_work(double step) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < gap_.size(); ++k)
    sum += (double(level_.q[k]) + double(level_.dq[k])) * (gap_[k] + step * slope_[k]);
  return sum;
}

template <class T>
double Newton<T>::line_search(double longest) {
  prepare_curve_merit();
  const kernels::Membrane<T> membrane = level_.membrane();
  // arap with corners: gaps counted absolutely outweigh them, and what the linear solver leaves of
  // the gaps would shorten steps (ML at 192², kappa 1e4: 109 steps, 70 with the Lagrangian).
  const bool lagrangian = level_.solid.law.relief > T(0);
  auto merit = [&](double step) {
    const kernels::EnergySums sums = kernels::energy<T>(membrane, level_.d.view(), T(step));
    return sums.elastic + sums.volume_merit + sums.constraint +
           (lagrangian ? curve_work(step) : curve_merit(step));
  };
  const double before = merit(0.0);
  // Cell energies are rounded, and so is the gap of every row.
  double curve_length = 0.0;
  const kernels::Cuts<T> cuts = level_.cuts.view(T(0));
  for (int k = 0; k < cuts.count; ++k) curve_length += double(cuts.length[k]);
  const double slack = 4.0 * (double(std::numeric_limits<T>::epsilon()) * std::abs(before) +
                              penalty_ * curve_length * precision());
  for (double step = longest; step >= kShortestStep; step *= 0.5)
    if (merit(step) <= before + slack) return step;
  return 0.0;
}

template double Newton<float>::line_search(double);
template double Newton<double>::line_search(double);

}  // namespace drumhead::multigrid
