// SPDX-License-Identifier: MIT
#include "corners.h"

#include <algorithm>

#include <drumhead/kernels/blocks.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

namespace drumhead::multigrid {
namespace {

// Stiffness of corners in mu: the largest that pressures need, and that to begin with on a level
// whose pressures come from a coarser one. (At first the hierarchy makes it 10.) Each move takes it
// by a factor.
constexpr double kMostRelief = 300.0, kGrows = 5.5, kRestart = kMostRelief / kGrows;
// And the largest where folds are left with that: fold-free's tips (S1, kappa 10, 200²) have 20
// folded cells with 300, none with 3000.
constexpr double kLastRelief = 1e4;
// Onset of corners of stiffness 10, and what each move leaves of it.
constexpr double kFirstOnset = 0.5, kNarrows = 0.43;
// Onsets below this make no difference.
constexpr double kNoOnset = 1e-4;

}  // namespace

template <class T>
Corners<T>::Corners(Level<T>& level, double onset) : level_(level), onset_(onset) {
  kernels::Law<T>& law = level.solid.law;
  if (!act()) return;
  const bool again = double(law.relief) > kRestart;
  if (again) soften(kRestart);
  law.onset = T(std::max(onset, kFirstOnset * (again ? kNarrows : 1.0)));
}

template <class T>
void Corners<T>::soften(double relief) {
  kernels::Law<T>& law = level_.solid.law;
  const T scale = law.relief / T(relief);  // a shift is a pressure over the stiffness
  law.relief = T(relief);
  for (grid::Field<T>& shift : level_.solid.shift)
    kernels::combine<T>(T(0), kernels::Plane<const T>(shift.view()), scale, shift.view());
  if (level_.conforming)
    for (T& shift : level_.conforming->shift) shift *= scale;
}

template <class T>
void Corners<T>::move() {
  kernels::Law<T>& law = level_.solid.law;
  auto& shift = level_.solid.shift;
  if (double(law.relief) < kMostRelief)
    soften(std::min(kMostRelief, kGrows * double(law.relief)));
  else if (unfolded())
    kernels::update_corner_pressure<T>(
        level_.membrane(), {shift[0].view(), shift[1].view(), shift[2].view(), shift[3].view()},
        level_.conforming ? level_.conforming->shift.data() : nullptr);
  else if (law.corner > T(0))
    soften(std::min(kLastRelief, kGrows * double(law.relief)));
  law.onset = T(std::max(onset_, kNarrows * double(law.onset)));
}

template <class T>
bool Corners<T>::last() const {
  const kernels::Law<T>& law = level_.solid.law;
  return double(law.relief) >= kMostRelief &&
         double(law.onset) <= std::max(1.001 * onset_, kNoOnset) &&
         (law.corner == T(0) || double(law.relief) >= kLastRelief || unfolded());
}

template <class T>
double Corners<T>::least_J() const {
  return kernels::energy<T>(level_.membrane(), {}, T(0)).least_J;
}

template class Corners<float>;
template class Corners<double>;

}  // namespace drumhead::multigrid
