// SPDX-License-Identifier: MIT
#include "krylov.h"

#include <algorithm>
#include <cmath>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

#include "kaczmarz_cycles.h"
#include "minres.h"

namespace drumhead::multigrid {
namespace {

// Cycles alone go on while each leaves less than this share of the residual.
constexpr double kCyclesSuffice = 0.85;
constexpr int kMostPlainCycles = 3;

template <class T>
class Gcr {
 public:
  Gcr(Hierarchy<T>& hierarchy, int top, bool pressure, grid::MemoryMeter& meter)
      : hierarchy_(hierarchy),
        level_(hierarchy[top]),
        pressure_(pressure),
        meter_(meter),
        cycle_(hierarchy, top, pressure, Cycle<T>::kDefinite) {
    if (hierarchy.traits().jump == 0.0 && level_.cuts.size() > 0) cycle_.relax_patches(meter);
    if (!level_.conforming) return;
    special_ = level_.conforming->rows;  // the cycle has them with its own clamp
    special_.linearise(membrane());
  }

  /// Goes on from the level's d, dq, whose right-hand side was f − Wᵀ dq; `start`: norm of that
  /// side.
  LinearReport solve(double start, LinearReport report, const LinearOptions& options);

 private:
  struct Direction {
    Vector<T> z, image;
    double norm2 = 0.0;
  };
  Vector<T> make_vector() {
    Vector<T> vector{
        grid::UnknownFields<T>(level_.nx, level_.ny, pressure_ && level_.pressure, meter_),
        std::vector<T>(level_.q.size(), T(0))};
    if (pressure_) vector.fields.listed.assign(level_.d.listed.size(), T(0));
    return vector;
  }
  kernels::Membrane<T> membrane() const {
    kernels::Membrane<T> m = pressure_ ? level_.membrane() : level_.harmonic();
    if (level_.conforming) m.special = &special_;
    return m;
  }
  void apply(const Vector<T>& d, Vector<T>& out);
  double dot(const Vector<T>& a, const Vector<T>& b) const;
  void combine(double a, const Vector<T>& x, double b, Vector<T>& y) const;
  bool step(Vector<T>& r, Vector<T>& x, const LinearOptions& options, std::size_t& stored);

  Hierarchy<T>& hierarchy_;
  Level<T>& level_;
  bool pressure_;
  grid::MemoryMeter& meter_;
  Cycle<T> cycle_;
  kernels::SpecialRows<T> special_;  ///< of the equations, where the lattice conforms to curves
  std::vector<Direction> directions_;
};

template <class T>
void Gcr<T>::apply(const Vector<T>& d, Vector<T>& out) {
  const kernels::Cuts<T> cuts = level_.cuts.view(T(hierarchy_.traits().jump));
  kernels::apply_hessian<T>(membrane(), d.fields.view(), out.fields.view());
  kernels::add_curve_force<T>(cuts, d.q.data(), T(-1), out.fields.view());
  kernels::apply_cuts<T>(cuts, d.fields.view(), d.q.data(), out.q.data());
}

/// Momentum rows, volume rows (per cell side, so that all rows are of one size on every level),
/// curve rows.
template <class T>
double Gcr<T>::dot(const Vector<T>& a, const Vector<T>& b) const {
  const auto av = a.fields.view(), bv = b.fields.view();
  const double volume = kernels::dot<T>(av.p, bv.p) + kernels::dot_listed<T>(av, bv);
  double sum = kernels::dot<T>(av.x, bv.x) + kernels::dot<T>(av.y, bv.y) +
               volume / double(level_.spacing * level_.spacing);
  for (std::size_t k = 0; k < a.q.size(); ++k) sum += double(a.q[k]) * double(b.q[k]);
  return sum;
}

template <class T>
void Gcr<T>::combine(double a, const Vector<T>& x, double b, Vector<T>& y) const {
  kernels::combine<T>(T(a), x.fields.view(), T(b), y.fields.view());
  for (std::size_t k = 0; k < x.q.size(); ++k)
    y.q[k] = T(a) * x.q[k] + (b == 0.0 ? T(0) : T(b) * y.q[k]);
}

/// One cycle on r, made orthogonal to the stored images; false if it yields no direction.
template <class T>
bool Gcr<T>::step(Vector<T>& r, Vector<T>& x, const LinearOptions& options, std::size_t& stored) {
  const kernels::LevelSystem<T> system = cycle_.system(hierarchy_.index_of(level_));
  const kernels::Unknowns<const T> correction = system.d;
  kernels::combine<T>(T(1), r.fields.view(), T(0), system.f);
  level_.fq = r.q;
  cycle_.run(options.kind, true);

  if (directions_.size() < std::size_t(options.directions) && stored >= directions_.size())
    directions_.push_back({make_vector(), make_vector(), 0.0});
  // The slot of `next` still holds the oldest pair; it is dropped from the orthogonalisation.
  Direction& next = directions_[stored % directions_.size()];
  const std::size_t kept = std::min(stored, directions_.size());
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
  if (!(next.norm2 > 0.0) || !std::isfinite(next.norm2)) return false;
  const double alpha = dot(r, next.image) / next.norm2;
  combine(alpha, next.z, 1.0, x);
  combine(-alpha, next.image, 1.0, r);
  ++stored;
  return true;
}

template <class T>
LinearReport Gcr<T>::solve(double start, LinearReport report, const LinearOptions& options) {
  Vector<T> x = make_vector(), r = make_vector();
  kernels::Unknowns<T> d = level_.d.view(), f = level_.f.view();
  if (!pressure_) d.p = f.p = {};
  kernels::combine<T>(T(1), d, T(0), x.fields.view());
  x.q = level_.dq;
  // r = (f − Wᵀ dq) − H d
  apply(x, r);
  kernels::add_curve_force<T>(level_.cuts.view(T(0)), level_.dq.data(), T(-1), f);
  kernels::combine<T>(T(1), f, T(-1), r.fields.view());
  for (std::size_t k = 0; k < r.q.size(); ++k) r.q[k] = level_.fq[k] - r.q[k];

  std::size_t stored = 0;
  while (report.cycles < options.most_cycles) {
    ++report.cycles;
    if (!step(r, x, options, stored)) break;
    report.residual = std::sqrt(dot(r, r)) / start;
    if (report.residual <= options.reduction) break;
  }
  kernels::combine<T>(T(1), x.fields.view(), T(0), d);
  level_.dq = x.q;
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
  // Without the jump in the equations a cycle's own residual is of another system.
  const bool same = hierarchy.traits().jump == hierarchy.traits().jump_inside;
  if (same) {
    std::vector<T> curve(level.dq.size());
    // With the clamp of a large theta the cycle itself diverges (S4, kappa 1e4, 128²: 22 times a
    // cycle; the definite one leaves .16). One definite cycle is a step for the equations too; from
    // where it ends a second one would go on to the solution of the clamped system.
    Cycle<T> cycle(hierarchy, top, pressure, Cycle<T>::kDefinite);
    kernels::LevelSystem<T> system = cycle.system(top);
    const bool once = pressure && level.clamp_width > system.membrane.clamp_width;
    system.membrane.clamp_width = level.clamp_width;
    for (bool enough = false; !enough && report.cycles < kMostPlainCycles;) {
      cycle.run(options.kind, report.cycles == 0);
      ++report.cycles;
      const double before = report.residual;
      report.residual = residual_norm(hierarchy, system, curve) / start;
      if (report.residual <= options.content) return report;
      enough = once || !(report.residual < kCyclesSuffice * before);
    }
  }
  if (!(report.residual < 1.0)) {  // nothing gained: start from zero
    if (same)
      kernels::add_curve_force<T>(level.cuts.view(T(0)), level.dq.data(), T(-1), level.f.view());
    level.d.clear();
    std::ranges::fill(level.dq, T(0));
    report.residual = 1.0;
  }
  return Gcr<T>(hierarchy, top, pressure, meter).solve(start, report, options);
}

template LinearReport solve_linear(Hierarchy<float>&, int, bool, double, const LinearOptions&,
                                   grid::MemoryMeter&);
template LinearReport solve_linear(Hierarchy<double>&, int, bool, double, const LinearOptions&,
                                   grid::MemoryMeter&);

}  // namespace drumhead::multigrid
