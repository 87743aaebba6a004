// SPDX-License-Identifier: MIT
#include "krylov.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/reduce.h>

#include "curve_strip.h"
#include "kaczmarz_cycles.h"
#include "minres.h"

namespace drumhead::multigrid {
namespace {

// Cycles alone go on while each leaves less than this share of the residual.
constexpr double kCyclesSuffice = 0.85;
constexpr int kMostPlainCycles = 3;
// LinearOptions::most_idle cycles gain nothing if together they leave more than this share.
constexpr double kIdle = 0.98;

template <class T>
class Gcr {
 public:
  /// `strip`: whether each cycle stands between two solutions of the strip beside the curves.
  Gcr(const NewtonSystem<T>& system, Cycle<T>& cycle, bool strip) : system_(system), cycle_(cycle) {
    if (strip) strip_.emplace(system);
  }

  /// Goes on from the level's d, dq, whose right-hand side was f − Wᵀ dq; `start`: norm of that
  /// side.
  LinearReport solve(double start, LinearReport report, const LinearOptions& options);

 private:
  struct Direction {
    Vector<T> z, image;
    double norm2 = 0.0;
  };
  void run_cycle(const Vector<T>& r, CycleKind kind);
  void set_direction(const Vector<T>& r, CycleKind kind, Direction& next);
  bool step(Vector<T>& r, Vector<T>& x, const LinearOptions& options, std::size_t& stored);

  const NewtonSystem<T>& system_;
  Cycle<T>& cycle_;
  std::optional<CurveStrip<T>> strip_;
  std::vector<Direction> directions_;
};

/// One cycle on r, from zero; its correction is the level's.
template <class T>
void Gcr<T>::run_cycle(const Vector<T>& r, CycleKind kind) {
  kernels::combine<T>(T(1), r.fields.view(), T(0), cycle_.system(system_.top()).f);
  system_.level().fq = r.q;
  cycle_.run(kind, true);
}

template <class T>
void Gcr<T>::set_direction(const Vector<T>& r, CycleKind kind, Direction& next) {
  const double kept = strip_ ? 1.0 : 0.0;
  if (strip_) {
    next.z.fields.clear();
    std::ranges::fill(next.z.q, T(0));
    strip_->add_solution(r, next.z);
    system_.residual(r, next.z, next.image);
  }
  run_cycle(strip_ ? next.image : r, kind);
  kernels::combine<T>(T(1), system_.correction(), T(kept), next.z.fields.view());
  for (std::size_t k = 0; k < next.z.q.size(); ++k)
    next.z.q[k] = T(kept) * next.z.q[k] + system_.level().dq[k];
  if (strip_) {
    system_.residual(r, next.z, next.image);
    strip_->add_solution(next.image, next.z);
  }
  system_.apply(next.z, next.image);
}

/// One cycle on r, made orthogonal to the stored images; false if it yields no direction.
template <class T>
bool Gcr<T>::step(Vector<T>& r, Vector<T>& x, const LinearOptions& options, std::size_t& stored) {
  if (directions_.size() < std::size_t(options.directions) && stored >= directions_.size())
    directions_.push_back({system_.make_vector(), system_.make_vector(), 0.0});
  // The slot of `next` still holds the oldest pair; it is dropped from the orthogonalisation.
  Direction& next = directions_[stored % directions_.size()];
  const std::size_t kept = std::min(stored, directions_.size());
  set_direction(r, options.kind, next);
  for (std::size_t n = 1; n <= kept; ++n) {
    Direction& old = directions_[(stored - n) % directions_.size()];
    if (&old == &next) continue;
    const double beta = system_.product_of_residuals(next.image, old.image) / old.norm2;
    system_.combine(-beta, old.z, 1.0, next.z);
    system_.combine(-beta, old.image, 1.0, next.image);
  }
  next.norm2 = system_.product_of_residuals(next.image, next.image);
  if (!(next.norm2 > 0.0) || !std::isfinite(next.norm2)) return false;
  const double alpha = system_.product_of_residuals(r, next.image) / next.norm2;
  system_.combine(alpha, next.z, 1.0, x);
  system_.combine(-alpha, next.image, 1.0, r);
  ++stored;
  return true;
}

template <class T>
LinearReport Gcr<T>::solve(double start, LinearReport report, const LinearOptions& options) {
  Level<T>& level = system_.level();
  Vector<T> x = system_.make_vector(), r = system_.make_vector();
  kernels::combine<T>(T(1), system_.correction(), T(0), x.fields.view());
  x.q = level.dq;
  // r = (f − Wᵀ dq) − H d
  const kernels::Unknowns<T> f = cycle_.system(system_.top()).f;
  system_.apply(x, r);
  kernels::add_curve_force<T>(level.cuts.view(T(0)), level.dq.data(), T(-1), f);
  kernels::combine<T>(T(1), f, T(-1), r.fields.view());
  for (std::size_t k = 0; k < r.q.size(); ++k) r.q[k] = level.fq[k] - r.q[k];

  std::size_t stored = 0;
  double mark = std::numeric_limits<double>::infinity();
  for (int idle = 0; report.cycles < options.most_cycles && idle < options.most_idle; ++idle) {
    ++report.cycles;
    if (!step(r, x, options, stored)) break;
    report.residual = system_.norm(r) / start;
    if (report.residual <= options.reduction) break;
    if (report.residual > kIdle * mark) continue;
    mark = report.residual;
    idle = -1;
  }
  system_.set_correction(x);
  return report;
}

/// Norm of f − H d of a level whose f carries the curve forces.
template <class T>
double residual_norm(Hierarchy<T>& hierarchy, const kernels::LevelSystem<T>& system,
                     std::vector<T>& curve) {
  double sum = kernels::residual_norm2<T>(system, hierarchy.scratch());
  kernels::cuts_residual<T>(system.cuts, system.fq, system.d, system.dq, curve.data());
  for (const T value : curve) sum += double(value) * double(value);
  return std::sqrt(sum);
}

/// Cycles alone, from zero, while each gains enough: true if they do all that is asked for.
template <class T>
bool cycles_suffice(Hierarchy<T>& hierarchy, int top, double start, const LinearOptions& options,
                    Cycle<T>& cycle, LinearReport& report) {
  std::vector<T> curve(hierarchy[top].dq.size());
  kernels::LevelSystem<T> system = cycle.system(top);
  // One definite cycle is a step for the equations too; from where it ends a second one would go on
  // to the solution of the clamped system.
  const bool once = cycle.pressure() && hierarchy[top].clamp_width > system.membrane.clamp_width;
  system.membrane.clamp_width = hierarchy[top].clamp_width;
  for (bool enough = false; !enough && report.cycles < kMostPlainCycles;) {
    cycle.run(options.kind, report.cycles == 0);
    ++report.cycles;
    const double before = report.residual;
    report.residual = residual_norm(hierarchy, system, curve) / start;
    if (report.residual <= options.content) return true;
    enough = once || !(report.residual < kCyclesSuffice * before);
  }
  return false;
}

}  // namespace

template <class T>
LinearReport solve_linear(Hierarchy<T>& hierarchy, int top, bool pressure, double start,
                          const LinearOptions& options, grid::MemoryMeter& meter) {
  Level<T>& level = hierarchy[top];
  LinearReport report;
  if (start == 0.0 || !std::isfinite(start)) {
    level.d.clear();
    std::ranges::fill(level.dq, T(0));
    report.residual = start;
    return report;
  }
  switch (options.solver) {
    case Solver::gcr:
      break;
    case Solver::kaczmarz:
    case Solver::coloured_kaczmarz:
      return solve_by_kaczmarz<T>({hierarchy, top, pressure, meter}, start, options);
    case Solver::minres:
    case Solver::minres_multigrid:
      return solve_by_minres<T>({hierarchy, top, pressure, meter}, start, options);
  }
  // With the clamp of a large theta the cycle itself diverges (S4, kappa 1e4, 128²: 22 times a
  // cycle; the definite one leaves .16).
  Cycle<T> cycle(hierarchy, top, pressure, Cycle<T>::kDefinite);
  if (options.band) cycle.relax_band();
  // Without the jump in the equations a cycle's own residual is of another system.
  const bool same = hierarchy.traits().jump == hierarchy.traits().jump_inside;
  if (same && options.unmeasured) {
    cycle.run(options.kind, true);
    return {.cycles = 1, .residual = std::numeric_limits<double>::quiet_NaN()};
  }
  if (same && cycles_suffice(hierarchy, top, start, options, cycle, report)) return report;
  if (!(report.residual < 1.0)) {  // nothing gained: start from zero
    if (same)
      kernels::add_curve_force<T>(level.cuts.view(T(0)), level.dq.data(), T(-1), level.f.view());
    level.d.clear();
    std::ranges::fill(level.dq, T(0));
    report.residual = 1.0;
  }
  const bool exact = hierarchy.traits().jump == 0.0 && level.cuts.size() > 0;
  const bool strip = exact && level.nodes() >= kStripNodes;
  if (exact && !strip) cycle.relax_patches(meter);
  const bool as_cycle = cycle.system(top).membrane.clamp_width == level.clamp_width &&
                        !kernels::isotropic(hierarchy.traits().model);
  using Rows = typename NewtonSystem<T>::Rows;
  const NewtonSystem<T> system(hierarchy, top, pressure, meter,
                               as_cycle ? Rows::levels : Rows::own);
  return Gcr<T>(system, cycle, strip).solve(start, report, options);
}

template LinearReport solve_linear(Hierarchy<float>&, int, bool, double, const LinearOptions&,
                                   grid::MemoryMeter&);
template LinearReport solve_linear(Hierarchy<double>&, int, bool, double, const LinearOptions&,
                                   grid::MemoryMeter&);

}  // namespace drumhead::multigrid
