// SPDX-License-Identifier: MIT
#include "kaczmarz_smoother.h"

namespace drumhead::multigrid {
namespace {

// The paper's numbers of sweeps. Its damping is not given: from 0.5 on sweeps diverge at kappa 10.
constexpr int kSweepsNearCurves = 5, kSweepsEverywhere = 2;
constexpr double kDamping = 0.375;
// Coloured sweeps of a relaxation. One takes as many sweeps in all for kappa 1, a sixth more
// for 10.
constexpr int kColouredSweeps = 2;
constexpr double kOverRelaxation = 1.45;

}  // namespace

template <class T>
KaczmarzSmoother<T>::KaczmarzSmoother(Solver solver, grid::MemoryMeter& meter)
    : solver_(solver), meter_(meter) {}

template <class T>
KaczmarzSmoother<T>::~KaczmarzSmoother() {
  for (const LevelRows& rows : levels_) meter_.remove(rows.bytes);
}

template <class T>
void KaczmarzSmoother<T>::add(const kernels::LevelSystem<T>& system) {
  const int nx = system.d.x.columns - 1, ny = system.d.x.rows - 1;
  const bool pressure = bool(system.d.p);
  const auto cuts = std::size_t(system.cuts.count);
  LevelRows& rows = levels_.emplace_back(LevelRows{.nodes = {nx, ny, system.cuts}});
  if (pressure) rows.alpha2 = grid::Field<T>(nx, ny, meter_);
  if (solver_ == Solver::kaczmarz) {
    rows.e = grid::UnknownFields<T>(nx, ny, pressure, meter_);
    rows.eq.resize(4 * cuts);
  }
  rows.beta2.resize(cuts);
  kernels::balance_rows<T>(system.membrane, system.cuts, rows.alpha2.view(), rows.beta2.data());
  rows.bytes = rows.nodes.bytes() + (rows.beta2.size() + rows.eq.size()) * sizeof(T);
  meter_.add(rows.bytes);
}

template <class T>
void KaczmarzSmoother<T>::smooth(int l, const kernels::LevelSystem<T>& system) {
  using kernels::Reach;
  LevelRows& rows = levels_[std::size_t(l)];
  kernels::KaczmarzSystem<T> all{.level = system,
                                 .nodes = rows.nodes.view(),
                                 .alpha2 = rows.alpha2.view(),
                                 .beta2 = rows.beta2.data()};
  if (solver_ == Solver::coloured_kaczmarz) {
    all.omega = T(kOverRelaxation);
    for (int n = 0; n < kColouredSweeps; ++n) kernels::coloured_kaczmarz<T>(all, Reach::everywhere);
    return;
  }
  const kernels::KaczmarzSystem<T> near = all;
  all.omega = T(kDamping);
  for (int n = 0; n < kSweepsNearCurves; ++n)
    kernels::coloured_kaczmarz<T>(near, Reach::near_curves);
  for (int n = 0; n < kSweepsEverywhere; ++n)
    kernels::damped_kaczmarz<T>(all, rows.e.view(), rows.eq.data());
  for (int n = 0; n < kSweepsNearCurves; ++n)
    kernels::coloured_kaczmarz<T>(near, Reach::near_curves);
}

template class KaczmarzSmoother<float>;
template class KaczmarzSmoother<double>;

}  // namespace drumhead::multigrid
