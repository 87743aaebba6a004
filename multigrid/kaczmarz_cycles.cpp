// SPDX-License-Identifier: MIT
#include "kaczmarz_cycles.h"

#include <drumhead/kernels/reduce.h>

#include "cycle.h"

namespace drumhead::multigrid {
namespace {

// Kaczmarz's method shrinks the error, not the residual, which may rise for a while.
constexpr double kDiverged = 10.0;

}  // namespace

template <class T>
LinearReport solve_by_kaczmarz(const NewtonSystem<T>& system, double start,
                               const LinearOptions& options) {
  const Vector<T> f = system.right_hand_side();  // the cycle works in the level's own
  Cycle<T> cycle(system.hierarchy(), system.top(), system.pressure(), Cycle<T>::kAsEquations);
  cycle.relax_by(options.solver, system.meter());
  Level<T>& level = system.level();
  Vector<T> x = system.make_vector(), best = system.make_vector(), r = system.make_vector();
  system.combine(1.0, f, 0.0, r);
  const kernels::Unknowns<T> right = cycle.system(system.top()).f;
  LinearReport report;
  while (report.cycles < options.most_cycles) {
    kernels::combine<T>(T(1), r.fields.view(), T(0), right);
    level.fq = r.q;
    cycle.run(CycleKind::v, true);
    ++report.cycles;
    kernels::combine<T>(T(1), kernels::Unknowns<const T>(system.correction()), T(1),
                        x.fields.view());
    for (std::size_t k = 0; k < x.q.size(); ++k) x.q[k] += level.dq[k];
    system.residual(f, x, r);
    const double residual = system.norm(r) / start;
    if (residual < report.residual) {
      report.residual = residual;
      system.combine(1.0, x, 0.0, best);
    }
    if (residual <= options.reduction || !(residual < kDiverged)) break;
  }
  system.set_correction(best);
  return report;
}

template LinearReport solve_by_kaczmarz(const NewtonSystem<float>&, double, const LinearOptions&);
template LinearReport solve_by_kaczmarz(const NewtonSystem<double>&, double, const LinearOptions&);

}  // namespace drumhead::multigrid
