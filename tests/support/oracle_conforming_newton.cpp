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

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

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

void count_folds(const ConformingMembrane& m, ConformingResult& result) {
  const grid::ConformingCells& cells = m.cells;
  const Positions& x = result.state.x;
  std::vector<int> outline;
  for (int j = 0; j < cells.ny; ++j)
    for (int c = cells.cell_begin[std::size_t(j)]; c < cells.cell_begin[std::size_t(j) + 1]; ++c)
      for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1]; ++p)
        for (int t = cells.part_triangle_begin[std::size_t(p)];
             t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
          outline.clear();
          for (const int n : cells.triangle[std::size_t(t)].node) {
            const int code =
                cells.part_node[std::size_t(cells.part_node_begin[std::size_t(p)] + n)];
            outline.push_back(code >= 4 ? (cells.nx + 1) * (cells.ny + 1) + code - 4
                                        : (j + (code >> 1)) * (cells.nx + 1) +
                                              cells.cell_column[std::size_t(c)] + (code & 1));
          }
          result.folded_triangles += deformed_area({outline, 0.0, 0.0}, x) < 0.0;
        }
  for (const ConformingRow& row : m.rows) {
    if (row.outline.size() != 4 || row.area != 1.0) continue;
    bool folded = false;
    for (std::size_t n = 0; n < 4; ++n) {
      const Vector2d at = x.row(row.outline[n]);
      const Vector2d to = x.row(row.outline[(n + 1) % 4]), from = x.row(row.outline[(n + 3) % 4]);
      folded |= cross(to - at, from - at) < 0.0;
    }
    result.folded_cells += folded;
  }
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
  for (; result.steps < most_steps && !result.converged; ++result.steps) {
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
  count_folds(m, result);
  return result;
}

}  // namespace drumhead::oracle
