// SPDX-License-Identifier: MIT
#include "truth.h"

#include <cmath>
#include <complex>
#include <stdexcept>

#include "solution_values.h"
#include "support/radial_reference.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

// Algebraic error of the reference, as a share of the picture: 0.003 px. Single precision does not
// hold much less on that lattice.
constexpr double kTolerance = 3e-6;
constexpr double kInner = .22, kOuter = .40;  // the roundabout's circles

/// Displacements of the exact roundabout, turned by 90°, at the nodes of the n × n lattice.
void fill_exact(double kappa, int n, std::vector<double>& u, std::vector<double>& v) {
  const double offset = scenes::kStudyOffset;
  const std::complex<double> centre(.5 + offset, .5 + .7 * offset);
  const oracle::RadialReference exact(kInner, kOuter, std::acos(0.0), kappa);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::complex<double> rest(double(i) / n, double(j) / n);
      const std::complex<double> moved = centre + exact.at(rest - centre) - rest;
      u.push_back(moved.real());
      v.push_back(moved.imag());
    }
}

}  // namespace

Truth::Truth(const scenes::Scene& scene, double kappa) : exact_(scene.name.starts_with("S2")) {
  if (exact_) {
    fill_exact(kappa, kFinest, u_, v_);
    return;
  }
  multigrid::Solution solution = multigrid::solve(
      scenes::problem(scene, kFinest, kappa),
      {.curve_method = multigrid::CurveMethod::conforming, .tolerance_px = kTolerance});
  if (solution.report.status != multigrid::Status::converged)
    throw std::runtime_error("the reference of " + scene.name + " ends with " +
                             multigrid::name(solution.report.status));
  u_ = std::move(solution.u_px);
  v_ = std::move(solution.v_px);
}

Truth::Error Truth::error(int n, std::span<const double> u, std::span<const double> v) const {
  if (n < 1 || kFinest % n != 0)
    throw std::invalid_argument("n " + std::to_string(n) + ": must divide " +
                                std::to_string(kFinest));
  const std::size_t stride = kFinest / n;
  Error error;
  double squares = 0.0;
  for (std::size_t j = 0; j <= std::size_t(n); ++j)
    for (std::size_t i = 0; i <= std::size_t(n); ++i) {
      const std::size_t here = j * std::size_t(n + 1) + i;
      const std::size_t fine = (j * (kFinest + 1) + i) * stride;
      const double miss = kPicture * std::hypot(u[here] - u_[fine], v[here] - v_[fine]);
      squares += miss * miss;
      error.max_px = std::max(error.max_px, miss);
    }
  error.rms_px = std::sqrt(squares) / (n + 1);
  return error;
}

int Truth::most_cells() const { return exact_ ? kFinest : kFinest / 4; }

}  // namespace drumhead::bench
