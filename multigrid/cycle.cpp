// SPDX-License-Identifier: MIT
#include "cycle.h"

#include <algorithm>

#include <drumhead/kernels/blocks.h>
#include <drumhead/kernels/cuts.h>

namespace drumhead::multigrid {
namespace {

// sigma of the coarse levels' volume rows. Eliminating the nodes that a coarse level lacks gives 1
// at most. Two cycles from the interpolated solution leave of the error in x̂ at 128², kappa 100:
// S2 .050/.051/.055/.066 at .25/.5/1/2, S4 .083/.084/.093/.13; without it S2 diverges (48 times a
// cycle, kappa 1e4: 4e6 times). Conforming cells have the jump of own_jump beside it: at kappa 100,
// 200² a first cycle leaves .116, .098, .089, .084 px of S2 with .4, .2, .1, .05, S4 .42, .41, .40,
// .40.
constexpr double kPressureJump = 0.4, kConformingJump = 0.1;
// kappa/mu from which volume and curve rows contradict one another so much that the band beside the
// curves is relaxed once more after the coarse correction. What the first F-cycles leave (S2, kappa
// 1e4, 800²): .10, .31, .50 without; .07, .27, .59 with it; .06, .26, .61 with another one before
// the correction, .03, .34, .68 with two and two. S4, kappa 1e4, 800²: 581 work units without, 95
// with it. At kappa 10 it costs as much as it gains.
// Before the restriction on the top level, once, from kStiff on twice: what the interpolated state
// lacks is rough and beside the curves, one relaxation leaves most of it, and coarse levels take
// that for something smooth. Moves of the second and third step at 800², in those of the one
// before: S1 kappa 1 .46, .33 without and .38, .26 with it, S2 kappa 10 .43, .35 and .41, .27; S2
// kappa 1e4 on 400² takes 3 cycles instead of 10. Not where a mask of kappa is: S3 takes .91, 1.0
// and .93 of the steps at 200², 400², 800² (means of six offsets), and as long.
constexpr double kStiff = 30.0;
// Beside conforming curves always twice before the restriction. What a first cycle leaves at kappa
// 100, 200², then without it, once, twice and eight times, px: S2 .084, .078, .071, .051 (twice on
// all cells .064), S4 .40, .33, .28, .20 (.26). Newton steps on the finest level and time, 128² and
// 200², means of six offsets, instead of relaxing the list of special cells twice everywhere: S2
// kappa 10 3.0 (4.0), .75, kappa 100 4.0 (5.0), .92; S4 kappa 10 4.0 (5.0), .78, 100 5.2 (6.2), .7,
// 1e4 5.3 (8.5), .77; S1 1e4 14.7 (16.5), 1.
constexpr int kConformingBand = 2;
// The power method sees the largest eigenvalue from below, on the coarser levels.
constexpr int kPowerSteps = 8;
constexpr double kPowerMargin = 1.3;
// Up to this kappa/mu averaged rows do with one sweep of the top level's volume rows, after the
// curve rows on the way down and before them on the way up: S2, S4 kappa 10 take .96, .94 of the
// time at 200², .94, .98 at 800². On all levels S2, 64² takes 18 cycles instead of 3.
constexpr double kGentle = 20.0;
// And up to this one of all levels': S1 kappa 1, 200² to 800², .9 of the time. Not on larger
// lattices: S1 takes 5 cycles instead of 3 at 3200².
constexpr double kGentlest = 1.5;
constexpr std::size_t kManyNodes = 1000000;

}  // namespace

template <class T>
Cycle<T>::Cycle(Hierarchy<T>& hierarchy, int top, bool pressure, T most_clamp)
    : hierarchy_(hierarchy), top_(top), pressure_(pressure) {
  hierarchy.restrict_state(top);
  for (int l = top; l < hierarchy.size(); ++l) hierarchy[l].solid.averaged = l > top;
  clamp_width_ = std::min(hierarchy[top].clamp_width, most_clamp);
  hierarchy[top].pressure_jump = T(0);
  const double jump = hierarchy.conforming() ? kConformingJump : kPressureJump;
  for (int l = top + 1; l < hierarchy.size(); ++l) {
    hierarchy[l].clamp_width = clamp_width_;
    hierarchy[l].pressure_jump = T(jump / hierarchy.traits().stiffest);
  }
  if (pressure && kernels::isotropic(hierarchy.traits().model)) {
    prepare_relaxation();
  } else {
    for (int l = top; l < hierarchy.size(); ++l) linearise_special(l);
  }
  bottom_.factorise(hierarchy[hierarchy.size() - 1], pressure, T(hierarchy.traits().jump_inside));
  residual_.resize(hierarchy[top].dq.size());
  const SceneTraits& traits = hierarchy.traits();
  if (kernels::isotropic(traits.model)) return;
  const bool stiff = pressure && traits.stiffness >= kStiff;
  band_up_ = stiff ? 1 : 0;
  if (hierarchy[top].cuts.size() == 0 || !(traits.jump > 0.0)) return;
  const bool few = hierarchy[top].nodes() < kManyNodes;
  if (traits.stiffness <= kGentlest && few) last_once_ = hierarchy.size();
}

template <class T>
void Cycle<T>::relax_band() {
  const SceneTraits& traits = hierarchy_.traits();
  const Level<T>& level = hierarchy_[top_];
  if (kernels::isotropic(traits.model)) return;
  if (level.conforming) {
    band_down_ = kConformingBand;
    return;
  }
  if (level.cuts.size() == 0 || level.compliance) return;
  band_down_ = pressure_ && traits.stiffness >= kStiff ? 2 : 1;
  if (traits.stiffness <= kGentle) last_once_ = std::max(last_once_, top_);
}

template <class T>
void Cycle<T>::linearise_special(int l) {
  Level<T>& level = hierarchy_[l];
  if (!level.conforming) return;
  level.conforming->rows.linearise(system(l).membrane);
  if (has_regions(level)) level.conforming->regions.prepare(level.membrane());
}

/// Diagonal blocks of all levels, and the bound of their relaxations: from the coarser levels,
/// whose d and f are free.
template <class T>
void Cycle<T>::prepare_relaxation() {
  double largest = 0.0;
  for (int l = top_; l + 1 < hierarchy_.size(); ++l) {
    linearise_special(l);
    Solid<T>&solid = hierarchy_[l].solid, &coarse = hierarchy_[l + 1].solid;
    const kernels::LevelSystem<T> s = system(l);
    kernels::inverse_blocks<T>(
        s.membrane, {solid.block[0].view(), solid.block[1].view(), solid.block[2].view()});
    kernels::average_tangents<T>(s.membrane, coarse.tangent.view());
    if (l > top_)
      largest = std::max(largest, kPowerMargin * kernels::largest_eigenvalue(s, kPowerSteps));
  }
  linearise_special(hierarchy_.size() - 1);
  for (int l = top_; l < hierarchy_.size(); ++l)
    hierarchy_[l].solid.largest = largest > 0.0 ? T(largest) : T(2);
}

template <class T>
kernels::LevelSystem<T> Cycle<T>::system(int l) {
  Level<T>& level = hierarchy_[l];
  kernels::LevelSystem<T> s{.membrane = pressure_ ? level.membrane() : level.harmonic(),
                            .cuts = level.cuts.view(T(hierarchy_.traits().jump_inside)),
                            .d = level.d.view(),
                            .f = level.f.view(),
                            .dq = level.dq.data(),
                            .fq = level.fq.data(),
                            .band = &level.band,
                            .product = level.solid.product.view(),
                            .largest = level.solid.largest};
  s.membrane.clamp_width = clamp_width_;
  if (!pressure_) s.d.p = s.f.p = {};
  if (level.conforming && l + 1 < hierarchy_.size()) {
    s.transfer = &level.conforming->to_coarse;
    s.coarse_special = &hierarchy_[l + 1].conforming->rows;
  }
  return s;
}

template <class T>
void Cycle<T>::relax_by(Solver solver, grid::MemoryMeter& meter) {
  for (int l = top_; l < hierarchy_.size(); ++l) hierarchy_[l].pressure_jump = T(0);
  bottom_.factorise(hierarchy_[hierarchy_.size() - 1], pressure_,
                    T(hierarchy_.traits().jump_inside));
  smoother_.emplace(solver, meter);
  for (int l = top_; l + 1 < hierarchy_.size(); ++l) smoother_->add(system(l));
}

template <class T>
void Cycle<T>::relax_patches(grid::MemoryMeter& meter) {
  for (int l = top_; l + 1 < hierarchy_.size(); ++l) patches_.emplace_back(system(l), meter);
}

template <class T>
void Cycle<T>::run(CycleKind kind, bool from_zero) {
  descend(top_, kind, from_zero);
}

template <class T>
void Cycle<T>::descend(int l, CycleKind kind, bool from_zero) {
  Level<T>& level = hierarchy_[l];
  if (from_zero) std::ranges::fill(level.dq, T(0));
  Regions* regions = has_regions(level) ? &level.conforming->regions : nullptr;
  if (regions && l == top_) regions->keep_sums(level.f.view());
  if (regions && l > top_ && from_zero) regions->remove_sums(level.membrane(), level.f.view());
  if (l + 1 == hierarchy_.size()) {
    bottom_.solve(level);
    if (regions) regions->set_means(level.membrane(), level.d.view());
    if (l == top_)
      kernels::add_curve_force(level.cuts.view(T(0)), level.dq.data(), T(1), level.f.view());
    return;
  }
  relax_down(l, from_zero);
  restrict_cuts(l);
  descend(l + 1, kind, true);
  if (kind == CycleKind::f && l + 2 < hierarchy_.size()) descend(l + 1, CycleKind::v, false);
  prolong_cuts(l);
  relax_up(l);
  if (regions) regions->set_means(level.membrane(), level.d.view());
}

/// Relaxation, then restriction of the residual.
template <class T>
void Cycle<T>::relax_down(int l, bool from_zero) {
  const kernels::LevelSystem<T> fine = system(l), coarse = system(l + 1);
  kernels::RelaxStages stages{.from_zero = from_zero};
  if (sweeps_once(l)) stages.volume = kernels::VolumeSweeps::reverse;
  if (l == top_ && !smoother_ && patches_.empty()) stages.band = band_down_;
  if (smoother_) {
    stages.sweeps = kernels::Sweeps::none;
    if (from_zero) kernels::relax<T>(fine, stages, nullptr, nullptr, hierarchy_.scratch());
    smoother_->smooth(l - top_, fine);
    stages.from_zero = false;
  }
  if (!patches_.empty()) {
    kernels::relax<T>(fine, stages, nullptr, nullptr, hierarchy_.scratch());
    patches_[std::size_t(l - top_)].relax(fine);
    stages.from_zero = false;
    stages.sweeps = kernels::Sweeps::none;
  }
  kernels::relax<T>(fine, stages, nullptr, &coarse.f, hierarchy_.scratch());
}

/// Prolongation of the correction, then relaxation.
template <class T>
void Cycle<T>::relax_up(int l) {
  const kernels::LevelSystem<T> fine = system(l);
  const kernels::Unknowns<const T> correction = system(l + 1).d;
  kernels::RelaxStages stages;
  if (sweeps_once(l)) stages.volume = kernels::VolumeSweeps::forwards;
  if (!smoother_ && patches_.empty()) stages.band = band_up_;
  if (smoother_ || !patches_.empty()) stages.sweeps = kernels::Sweeps::none;
  kernels::relax<T>(fine, stages, &correction, nullptr, hierarchy_.scratch());
  if (!patches_.empty()) {
    patches_[std::size_t(l - top_)].relax(fine);
    kernels::relax<T>(fine, {}, nullptr, nullptr, hierarchy_.scratch());
  } else if (smoother_) {
    smoother_->smooth(l - top_, fine);
  }
}

template <class T>
void Cycle<T>::restrict_cuts(int l) {
  const kernels::LevelSystem<T> fine = system(l);
  Level<T>& coarse = hierarchy_[l + 1];
  std::ranges::fill(coarse.fq, T(0));
  kernels::cuts_residual<T>(fine.cuts, fine.fq, fine.d, fine.dq, residual_.data());
  const CutTransfer<T>& transfer = hierarchy_[l].to_coarse;
  for (std::size_t k = 0; k < transfer.parent.size(); ++k) {
    if (transfer.parent[k] < 0) continue;
    const std::size_t p = 2 * std::size_t(transfer.parent[k]);
    coarse.fq[p] += transfer.share[k] * residual_[2 * k];
    coarse.fq[p + 1] += transfer.share[k] * residual_[2 * k + 1];
  }
}

template <class T>
void Cycle<T>::prolong_cuts(int l) {
  Level<T>& fine = hierarchy_[l];
  const Level<T>& coarse = hierarchy_[l + 1];
  const CutTransfer<T>& transfer = fine.to_coarse;
  for (std::size_t k = 0; k < transfer.parent.size(); ++k) {
    const int parent = transfer.parent[k];
    for (std::size_t c = 0; c < 2; ++c) {
      residual_[2 * k + c] =
          parent < 0 ? T(0) : transfer.share[k] * coarse.dq[2 * std::size_t(parent) + c];
      fine.dq[2 * k + c] += residual_[2 * k + c];
    }
  }
  kernels::add_curve_force<T>(fine.cuts.view(T(0)), residual_.data(), T(1), fine.f.view());
}

template class Cycle<float>;
template class Cycle<double>;

}  // namespace drumhead::multigrid
