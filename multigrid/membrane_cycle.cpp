// SPDX-License-Identifier: MIT
#include "membrane_cycle.h"

#include <algorithm>

#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {
namespace {

// There and back; on the 8² cells of the bottom each leaves about a tenth of the error.
constexpr int kBottomSweeps = 8;

}  // namespace

template <class T>
MembraneCycle<T>::MembraneCycle(const NewtonSystem<T>& system)
    : hierarchy_(system.hierarchy()), top_(system.top()), pressure_(system.pressure()) {
  hierarchy_.restrict_state(top_);
  for (int l = top_; l < hierarchy_.size(); ++l) {
    // P is no unknown here, but the kernels look at its planes.
    hierarchy_[l].d.p.clear();
    hierarchy_[l].f.p.clear();
  }
}

template <class T>
kernels::LevelSystem<T> MembraneCycle<T>::system(int l) const {
  Level<T>& level = hierarchy_[l];
  kernels::LevelSystem<T> s{.membrane = pressure_ ? level.membrane() : level.harmonic(),
                            .d = level.d.view(),
                            .f = level.f.view()};
  s.membrane.clamp_width = std::min(level.clamp_width, T(1));
  if (!pressure_) s.d.p = s.f.p = {};
  return s;
}

template <class T>
void MembraneCycle<T>::apply(const kernels::Unknowns<const T>& r, const kernels::Unknowns<T>& z) {
  const kernels::LevelSystem<T> fine = system(top_);
  kernels::combine<T>(T(1), r.x, T(0), fine.f.x);
  kernels::combine<T>(T(1), r.y, T(0), fine.f.y);
  descend(top_);
  kernels::combine<T>(T(1), kernels::Plane<const T>(fine.d.x), T(0), z.x);
  kernels::combine<T>(T(1), kernels::Plane<const T>(fine.d.y), T(0), z.y);
}

template <class T>
void MembraneCycle<T>::descend(int l) {
  using kernels::Sweeps;
  const kernels::LevelSystem<T> fine = system(l);
  const auto relax = [&](kernels::RelaxStages stages, const kernels::Unknowns<const T>* up,
                         const kernels::Unknowns<T>* down) {
    kernels::relax<T>(fine, stages, up, down, hierarchy_.scratch());
  };
  if (l + 1 == hierarchy_.size()) {
    for (int n = 0; n < kBottomSweeps; ++n) {
      relax({.from_zero = n == 0, .sweeps = Sweeps::nodes}, nullptr, nullptr);
      relax({.sweeps = Sweeps::nodes_reversed}, nullptr, nullptr);
    }
    return;
  }
  const kernels::LevelSystem<T> coarse = system(l + 1);
  relax({.from_zero = true, .sweeps = Sweeps::nodes}, nullptr, &coarse.f);
  descend(l + 1);
  const kernels::Unknowns<const T> correction = coarse.d;
  relax({.sweeps = Sweeps::nodes_reversed}, &correction, nullptr);
}

template class MembraneCycle<float>;
template class MembraneCycle<double>;

}  // namespace drumhead::multigrid
