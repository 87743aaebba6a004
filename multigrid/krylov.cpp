// SPDX-License-Identifier: MIT
#include "krylov.h"

#include <algorithm>
#include <cmath>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {

template <class T>
Krylov<T>::Krylov(Hierarchy<T>& hierarchy, int top, bool pressure, grid::MemoryMeter& meter)
    : hierarchy_(hierarchy), level_(hierarchy[top]), pressure_(pressure), meter_(meter) {}

template <class T>
Vector<T> Krylov<T>::make_vector() {
  return {grid::UnknownFields<T>(level_.nx, level_.ny, pressure_, meter_),
          std::vector<T>(level_.q.size(), T(0))};
}

template <class T>
void Krylov<T>::apply(const Vector<T>& d, Vector<T>& out) {
  const kernels::Cuts<T> cuts = level_.cuts.view(T(hierarchy_.traits().jump));
  kernels::apply_hessian<T>(pressure_ ? level_.membrane() : level_.harmonic(), d.fields.view(),
                            out.fields.view());
  kernels::add_curve_force<T>(cuts, d.q.data(), T(-1), out.fields.view());
  kernels::apply_cuts<T>(cuts, d.fields.view(), d.q.data(), out.q.data());
}

/// Momentum rows, volume rows (per cell side, so that all rows are of one size on every level), curve rows.
template <class T>
double Krylov<T>::dot(const Vector<T>& a, const Vector<T>& b) const {
  const auto av = a.fields.view(), bv = b.fields.view();
  double sum = kernels::dot<T>(av.x, bv.x) + kernels::dot<T>(av.y, bv.y) +
               kernels::dot<T>(av.p, bv.p) / double(level_.spacing * level_.spacing);
  for (std::size_t k = 0; k < a.q.size(); ++k) sum += double(a.q[k]) * double(b.q[k]);
  return sum;
}

template <class T>
void Krylov<T>::combine(double a, const Vector<T>& x, double b, Vector<T>& y) const {
  kernels::combine<T>(T(a), x.fields.view(), T(b), y.fields.view());
  for (std::size_t k = 0; k < x.q.size(); ++k) y.q[k] = T(a) * x.q[k] + (b == 0.0 ? T(0) : T(b) * y.q[k]);
}

template <class T>
KrylovReport Krylov<T>::solve(Vector<T>& b, Vector<T>& x, const KrylovOptions& options) {
  KrylovReport report;
  const double start = std::sqrt(dot(b, b));
  x.fields.clear();
  std::ranges::fill(x.q, T(0));
  if (start == 0.0 || !std::isfinite(start)) {
    report.residual = start == 0.0 ? 0.0 : std::nan("");
    return report;
  }
  const int top = hierarchy_.index_of(level_);
  Cycle<T> cycle(hierarchy_, top, pressure_);
  const kernels::Unknowns<const T> correction = cycle.system(top).d;
  std::size_t stored = 0;
  while (report.cycles < options.most_cycles) {
    ++report.cycles;
    kernels::combine<T>(T(1), b.fields.view(), T(0), level_.f.view());
    level_.fq = b.q;
    cycle.run(options.kind);

    if (directions_.size() < std::size_t(options.directions) && stored >= directions_.size())
      directions_.push_back({make_vector(), make_vector(), 0.0});
    Direction& next = directions_[stored % directions_.size()];
    const std::size_t kept = std::min(stored, directions_.size());
    // The slot of `next` still holds the oldest pair; it is dropped from the orthogonalisation.
    kernels::combine<T>(T(1), correction, T(0), next.z.fields.view());
    next.z.q = level_.dq;
    apply(next.z, next.image);
    for (std::size_t n = 1; n <= kept; ++n) {
      Direction& old = directions_[(stored - n) % directions_.size()];
      if (&old == &next) continue;
      const double beta = dot(next.image, old.image) / old.norm2;
      combine(-beta, old.z, 1.0, next.z);
      combine(-beta, old.image, 1.0, next.image);
    }
    next.norm2 = dot(next.image, next.image);
    if (!(next.norm2 > 0.0) || !std::isfinite(next.norm2)) break;
    const double alpha = dot(b, next.image) / next.norm2;
    combine(alpha, next.z, 1.0, x);
    combine(-alpha, next.image, 1.0, b);
    ++stored;
    report.residual = std::sqrt(dot(b, b)) / start;
    if (report.residual <= options.reduction) break;
  }
  return report;
}

template class Krylov<float>;
template class Krylov<double>;

}  // namespace drumhead::multigrid
