// SPDX-License-Identifier: MIT
// Newton's method on the conforming cells' assembled system.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/SparseCholesky>

#include "oracle_conforming.h"

namespace drumhead::oracle {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kMostCondensed = 1e4;  // kappa of a row in the condensed matrix
constexpr double kExact = 1e6;          // theta above which the pressure is not clamped
constexpr double kMeritKappa = 100.0;   // stiffer rows enter the merit with this

/// [H Bᵀ; B −C] (dx, dP) = (f, g) by condensation of the pressures and refinement.
class Saddle {
 public:
  Saddle(const ConformingMembrane& m, const Sparse& H, const Sparse& B) : H_(H), B_(B) {
    const Eigen::Index rows = Eigen::Index(m.rows.size());
    VectorXd softened(rows), compliance(rows);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const ConformingRow& row = m.rows[std::size_t(r)];
      compliance[r] = row.area / row.kappa;
      softened[r] = row.area / std::min(row.kappa, kMostCondensed);
    }
    compliance_ = m.jump + Sparse(compliance.asDiagonal());
    condensed_.compute(m.jump + Sparse(softened.asDiagonal()));
    const Sparse matrix = H + Sparse(B.transpose() * Sparse(condensed_.solve(B)));
    factor_.compute(matrix);
    if (factor_.info() != Eigen::Success) throw std::runtime_error("oracle: singular matrix");
  }

  void solve(const VectorXd& f, const VectorXd& g, VectorXd& dx, VectorXd& dP) const {
    dx = VectorXd::Zero(f.size());
    dP = VectorXd::Zero(g.size());
    const double scale = std::max(f.norm() + g.norm(), 1e-300);
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 200; ++pass) {
      const VectorXd rf = f - H_ * dx - B_.transpose() * dP;
      const VectorXd rg = g - B_ * dx + compliance_ * dP;
      const double left = rf.norm() + rg.norm();
      if (left < 1e-12 * scale || (pass > 5 && left > 0.999 * last)) break;
      last = left;
      const VectorXd step = factor_.solve(rf + B_.transpose() * condensed_.solve(rg));
      dP += condensed_.solve(B_ * step - rg);
      dx += step;
    }
  }

 private:
  const Sparse &H_, &B_;
  Sparse compliance_;
  Eigen::SimplicialLDLT<Sparse> condensed_, factor_;
};

ConformingState moved(const ConformingMembrane& m, const ConformingState& state, const VectorXd& dx,
                      const VectorXd& dP, double t) {
  ConformingState next = state;
  for (std::size_t n = 0; n < m.unknown.size(); ++n) {
    const int u = m.unknown[n];
    if (u >= 0) next.x.row(Eigen::Index(n)) += t * Vector2d(dx[u], dx[m.unknowns + u]);
  }
  if (dP.size() == next.P.size()) next.P += t * dP;
  return next;
}

double merit(const ConformingMembrane& m, const Positions& x, const VectorXd& P) {
  double sum = elastic_energy(m, x) + spring_energy(m, x);
  const VectorXd jumps = m.jump * P;
  for (std::size_t r = 0; r < m.rows.size(); ++r) {
    const ConformingRow& row = m.rows[r];
    const double excess = deformed_area(row, x) / row.area - 1.0;
    const bool joined = m.joined(r);
    if (row.kappa <= kMeritKappa && !joined) {
      sum += row.area * 0.5 * row.kappa * excess * excess;
      continue;
    }
    const double p = P[Eigen::Index(r)];
    const double c = excess - p / row.kappa - jumps[Eigen::Index(r)] / row.area;
    sum += row.area * (p * c + 0.5 * std::min(row.kappa, kMeritKappa) * c * c);
  }
  return sum;
}

VectorXd clamped(const VectorXd& P, double theta) {
  if (theta > kExact || P.size() == 0) return P;
  std::vector<double> sorted(P.begin(), P.end());
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return (P.array() - *middle).cwiseMax(-theta).cwiseMin(theta);
}

}  // namespace

ConformingResult newton(const ConformingMembrane& m, const Positions* from, int most_steps) {
  ConformingResult result;
  ConformingState& now = result.state;
  now.x = from ? *from : m.rest;
  for (std::size_t n = 0; n < m.known.size(); ++n)
    if (m.known[n]) now.x.row(Eigen::Index(n)) = m.target.row(Eigen::Index(n));
  now.P = VectorXd::Zero(Eigen::Index(m.rows.size()));
  if (!from) {  // the membrane without pressures
    const Sparse H = hessian(m, now.P);
    Eigen::SimplicialLDLT<Sparse> factor(H);
    ConformingState start = now;
    now = moved(m, now, factor.solve(-gradient(m, start).head(2 * m.unknowns)), {}, 1.0);
  }
  double theta = 1.0;
  for (int n = 0; n < most_steps && !result.converged; ++n) {
    const Sparse H = hessian(m, clamped(now.P, theta)), B = area_derivatives(m, now.x);
    const VectorXd g = gradient(m, now);
    VectorXd dx, dP;
    Saddle(m, H, B).solve(-g.head(2 * m.unknowns), -g.tail(g.size() - 2 * m.unknowns), dx, dP);
    const VectorXd P = now.P + dP;
    const double before = merit(m, now.x, P);
    double t = 1.0;
    while (t > 1e-8 && merit(m, moved(m, now, dx, dP, t).x, P) > before + 1e-12 * std::abs(before))
      t *= 0.5;
    if (t <= 1e-8) {
      if (theta == 1.0) break;
      theta = 1.0;
      continue;
    }
    now = moved(m, now, dx, dP, t);
    result.converged = t == 1.0 && dx.lpNorm<Eigen::Infinity>() < 1e-8;
    theta = t == 1.0 ? 8.0 * theta : std::max(1.0, theta / 8.0);
  }
  return result;
}

}  // namespace drumhead::oracle
