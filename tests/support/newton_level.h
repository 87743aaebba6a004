// SPDX-License-Identifier: MIT
#pragma once
// The Newton system that the finest level of a scene begins with: at the solution, restricted to
// the next level and interpolated back (kappa infinite: at that of kappa 1e4). For tests and
// benchmarks of the linear solvers, on private headers of multigrid/.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>
#include <drumhead/multigrid/warp.h>

#include "exact_rows.h"
#include "krylov.h"
#include "nested.h"

namespace drumhead::scenes {

template <class T>
class NewtonLevel {
 public:
  /// `jump`: qs of the equations and of the preconditioner; `theta`: clamp of P in the Hessian;
  /// `most_weight`: d of hard curves.
  NewtonLevel(const multigrid::WarpProblem& problem, double jump, double theta,
              multigrid::CurveMethod method = multigrid::CurveMethod::averaged,
              double most_weight = kMostWeight)
      : hierarchy_(
            problem.lattice, compressible(problem.material),
            grid::cut(method == multigrid::CurveMethod::averaged ? problem.curves
                                                                 : std::vector<grid::CurvePair>{},
                      problem.lattice, most_weight),
            {.pressure = problem.material.kappa > 0.0,
             .stiffness = grid::largest_stiffness(problem.material),
             .jump = jump,
             .jump_inside = jump},
            meter_) {
    if (method == multigrid::CurveMethod::conforming)
      hierarchy_.conform(problem.curves, problem.lattice, meter_);
    multigrid::SolveReport report;
    multigrid::nested_iteration(hierarchy_,
                                {.smallest_feature = kSmallestFeature * double(problem.lattice.nx)},
                                1.0, meter_, report);
    hierarchy_.prolong_state(0);
    for (int l = 0; std::isinf(problem.material.kappa) && l < hierarchy_.size(); ++l)
      hierarchy_[l].compliance_value = T(0);
    level().clamp_centre = median_pressure();
    level().clamp_width = T(theta);
  }

  /// No jump in the equations, in the preconditioner that of exact rows.
  void drop_jump() {
    hierarchy_.drop_jump(multigrid::jump_kept(level().nodes(), hierarchy_.traits().jump_inside));
  }

  multigrid::Level<T>& level() { return hierarchy_[0]; }
  bool pressure() { return bool(level().pressure); }
  multigrid::NewtonSystem<T> system() { return {hierarchy_, 0, pressure(), meter_}; }

  /// Solves for the force at the state.
  multigrid::LinearReport solve(const multigrid::LinearOptions& options) {
    return multigrid::solve_linear<T>(hierarchy_, 0, pressure(), set_force(), options, meter_);
  }

  /// The right-hand side; returns its norm.
  double set_force() {
    multigrid::Level<T>& l = level();
    const kernels::Cuts<T> cuts = system().cuts();
    kernels::force<T>(system().membrane(), l.f.view());
    kernels::add_curve_force<T>(cuts, l.q.data(), T(1), l.f.view());
    kernels::apply_cuts<T>(cuts, {l.ux.view(), l.uy.view(), {}}, l.q.data(), l.fq.data());
    for (std::size_t k = 0; k < l.wanted.size(); ++k) {
      l.fq[2 * k] = T(-(l.wanted[k].x + double(l.fq[2 * k])));
      l.fq[2 * k + 1] = T(-(l.wanted[k].y + double(l.fq[2 * k + 1])));
    }
    return system().norm(system().right_hand_side());
  }

  /// Seconds of a Hessian–vector product, the least of several.
  template <class Clock>
  double product_seconds() {
    double least = 1e9;
    for (int n = 0; n < 20; ++n) {
      const auto start = Clock::now();
      kernels::apply_hessian<T>(system().membrane(), level().d.view(), level().f.view());
      const std::chrono::duration<double> seconds = Clock::now() - start;
      least = std::min(least, seconds.count());
    }
    return least;
  }

 private:
  /// The state is that of the kappa which multigrid::solve takes for infinity.
  static grid::Material compressible(grid::Material material) {
    material.kappa = std::min(material.kappa, 1e4);
    return material;
  }
  T median_pressure() {
    std::vector<T> values;
    const kernels::Plane<T> p = level().pressure.view();
    for (int j = 0; j < p.rows; ++j)
      for (int i = 0; i < p.columns; ++i) values.push_back(p.at(i, j));
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.empty() ? T(0) : *middle;
  }

  // As multigrid::solve has them.
  static constexpr double kMostWeight = 1e6;
  static constexpr double kSmallestFeature = 0.2;  // of the square's side

  grid::MemoryMeter meter_;
  multigrid::Hierarchy<T> hierarchy_;
};

}  // namespace drumhead::scenes
