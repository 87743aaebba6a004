// SPDX-License-Identifier: MIT
#include "oracle_conforming.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumhead::oracle {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

Vector2d vector(grid::Point p) { return {p.x, p.y}; }
double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// 2-D index arithmetic and the walk over special cells.
class Builder {
 public:
  Builder(ConformingMembrane& membrane, const std::vector<double>& kappa, double gamma)
      : m_(membrane), cells_(membrane.cells), kappa_(kappa), gamma_(gamma) {}

  void run() {
    set_nodes();
    set_regular_cells();
    set_special_cells();
    join_parts();
    m_.stiffness.resize(m_.rest.rows(), m_.rest.rows());
    m_.stiffness.setFromTriplets(entries_.begin(), entries_.end());
  }

 private:
  int node(int i, int j) const { return j * (cells_.nx + 1) + i; }

  void hold(int n, const grid::HeldNode& held) {
    m_.rest.row(n) = vector(held.rest);
    m_.target.row(n) = vector(held.rest + held.wanted);
    if (std::isinf(held.stiffness))
      m_.known[std::size_t(n)] = 1;
    else
      m_.spring[n] = held.stiffness;
  }

  void set_nodes() {
    const int lattice = (cells_.nx + 1) * (cells_.ny + 1),
              all = lattice + int(cells_.curve_node.size());
    m_.rest.resize(all, 2);
    m_.known.assign(std::size_t(all), 0);
    m_.spring = VectorXd::Zero(all);
    for (int j = 0; j <= cells_.ny; ++j)
      for (int i = 0; i <= cells_.nx; ++i) {
        m_.rest.row(node(i, j)) = Vector2d(i, j);
        m_.known[std::size_t(node(i, j))] = i == 0 || j == 0 || i == cells_.nx || j == cells_.ny;
      }
    m_.target = m_.rest;
    for (int j = 0; j <= cells_.ny; ++j)
      for (int k = cells_.node_begin[std::size_t(j)]; k < cells_.node_begin[std::size_t(j) + 1];
           ++k)
        hold(node(cells_.node_column[std::size_t(k)], j), cells_.node[std::size_t(k)]);
    for (std::size_t k = 0; k < cells_.curve_node.size(); ++k)
      hold(lattice + int(k), cells_.curve_node[k]);
    for (const char known : m_.known) m_.unknown.push_back(known ? -1 : m_.unknowns++);
  }

  void set_regular_cells() {
    for (int j = 0; j < cells_.ny; ++j)
      for (int i = 0; i < cells_.nx; ++i) {
        if (cells_.find_cell(i, j) >= 0) continue;
        const std::vector<int> loop{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
        for (std::size_t n = 0; n < 4; ++n) {  // mu/4 |edge|²
          const int a = loop[n], b = loop[(n + 1) % 4];
          entries_.insert(entries_.end(), {{a, a, .5}, {b, b, .5}, {a, b, -.5}, {b, a, -.5}});
        }
        const double kappa = kappa_[std::size_t(j * cells_.nx + i)];
        if (kappa > 0.0) m_.rows.push_back({loop, 1.0, kappa});
      }
  }

  void set_special_cells() {
    for (int j = 0; j < cells_.ny; ++j)
      for (int c = cells_.cell_begin[std::size_t(j)]; c < cells_.cell_begin[std::size_t(j) + 1];
           ++c)
        for (int p = cells_.part_begin[std::size_t(c)]; p < cells_.part_begin[std::size_t(c) + 1];
             ++p)
          add_part(c, j, p);
  }

  void add_part(int c, int j, int p) {
    const int i = cells_.cell_column[std::size_t(c)];
    std::vector<int> outline;
    for (int n = cells_.part_node_begin[std::size_t(p)];
         n < cells_.part_node_begin[std::size_t(p) + 1]; ++n) {
      const int code = cells_.part_node[std::size_t(n)];
      outline.push_back(code < 4 ? node(i + (code & 1), j + (code >> 1))
                                 : node(0, cells_.ny + 1) + code - 4);
    }
    for (int t = cells_.part_triangle_begin[std::size_t(p)];
         t < cells_.part_triangle_begin[std::size_t(p) + 1]; ++t) {
      const grid::PartTriangle& tri = cells_.triangle[std::size_t(t)];
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          entries_.push_back({outline[std::size_t(tri.node[a])], outline[std::size_t(tri.node[b])],
                              tri.area * dot(tri.gradient[a], tri.gradient[b])});
    }
    const double kappa = kappa_[std::size_t(j * cells_.nx + i)];
    if (!(kappa > 0.0)) return;
    for (std::size_t n = 0; n < outline.size(); ++n) {
      const int a = outline[n], b = outline[(n + 1) % outline.size()];
      if (!held(a) || !held(b))
        pieces_.push_back({std::min(a, b), std::max(a, b), int(m_.rows.size()), c});
    }
    m_.rows.push_back({std::move(outline), cells_.part_area[std::size_t(p)], kappa});
  }

  bool held(int n) const {
    const int lattice = node(0, cells_.ny + 1);
    return n >= lattice || cells_.find_node(n % (cells_.nx + 1), n / (cells_.nx + 1)) >= 0;
  }

  void join_parts() {
    Entries entries;
    std::ranges::sort(pieces_);
    for (std::size_t n = 0; n + 1 < pieces_.size(); ++n) {
      const auto& [from, to, a, cell] = pieces_[n];
      const auto& [other_from, other_to, b, other] = pieces_[n + 1];
      if (from != other_from || to != other_to || cell == other) continue;
      const double ka = m_.rows[std::size_t(a)].kappa, kb = m_.rows[std::size_t(b)].kappa;
      const double strength = 0.5 * gamma_ * (ka == kb ? 1.0 : std::min(ka, kb) / std::max(ka, kb));
      entries.insert(entries.end(),
                     {{a, a, strength}, {b, b, strength}, {a, b, -strength}, {b, a, -strength}});
    }
    m_.jump.resize(Eigen::Index(m_.rows.size()), Eigen::Index(m_.rows.size()));
    m_.jump.setFromTriplets(entries.begin(), entries.end());
  }

  ConformingMembrane& m_;
  const grid::ConformingCells& cells_;
  const std::vector<double>& kappa_;
  double gamma_;
  Entries entries_;
  std::vector<std::array<int, 4>> pieces_;  ///< of outlines: two nodes, the row, its cell
};

}  // namespace

double deformed_area(const ConformingRow& row, const Positions& x) {
  double twice = 0.0;
  const std::vector<int>& loop = row.outline;
  for (std::size_t n = 0; n < loop.size(); ++n)
    twice += cross(x.row(loop[n]).transpose(), x.row(loop[(n + 1) % loop.size()]).transpose());
  return 0.5 * twice;
}

Sparse area_derivatives(const ConformingMembrane& m, const Positions& x) {
  Entries entries;
  for (std::size_t r = 0; r < m.rows.size(); ++r) {
    const std::vector<int>& loop = m.rows[r].outline;
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const int u = m.unknown[std::size_t(loop[n])];
      if (u < 0) continue;
      const int before = loop[(n + loop.size() - 1) % loop.size()],
                after = loop[(n + 1) % loop.size()];
      entries.push_back({int(r), u, 0.5 * (x(after, 1) - x(before, 1))});
      entries.push_back({int(r), m.unknowns + u, 0.5 * (x(before, 0) - x(after, 0))});
    }
  }
  Sparse B(Eigen::Index(m.rows.size()), 2 * m.unknowns);
  B.setFromTriplets(entries.begin(), entries.end());
  return B;
}

Sparse hessian(const ConformingMembrane& m, const VectorXd& pressure) {
  Entries entries;
  for (int column = 0; column < m.stiffness.outerSize(); ++column)
    for (Sparse::InnerIterator at(m.stiffness, column); at; ++at) {
      const int a = m.unknown[std::size_t(at.row())], b = m.unknown[std::size_t(at.col())];
      if (a < 0 || b < 0) continue;
      entries.push_back({a, b, at.value()});
      entries.push_back({m.unknowns + a, m.unknowns + b, at.value()});
    }
  for (std::size_t n = 0; n < m.unknown.size(); ++n) {
    const int u = m.unknown[n];
    if (u < 0 || m.spring[Eigen::Index(n)] == 0.0) continue;
    entries.push_back({u, u, m.spring[Eigen::Index(n)]});
    entries.push_back({m.unknowns + u, m.unknowns + u, m.spring[Eigen::Index(n)]});
  }
  for (std::size_t r = 0; r < m.rows.size(); ++r) {
    const std::vector<int>& loop = m.rows[r].outline;
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const int a = m.unknown[std::size_t(loop[n])],
                b = m.unknown[std::size_t(loop[(n + 1) % loop.size()])];
      if (a < 0 || b < 0) continue;
      const double half = 0.5 * pressure[Eigen::Index(r)];  // of x_a y_b − x_b y_a
      entries.insert(entries.end(), {{a, m.unknowns + b, half},
                                     {m.unknowns + b, a, half},
                                     {b, m.unknowns + a, -half},
                                     {m.unknowns + a, b, -half}});
    }
  }
  Sparse H(2 * m.unknowns, 2 * m.unknowns);
  H.setFromTriplets(entries.begin(), entries.end());
  return H;
}

ConformingMembrane conforming_membrane(const std::vector<grid::CurvePair>& curves,
                                       const grid::Lattice& lattice,
                                       const std::vector<double>& kappa, double gamma) {
  ConformingMembrane membrane;
  membrane.cells = grid::conform(curves, lattice);
  Builder(membrane, kappa, gamma).run();
  return membrane;
}

double elastic_energy(const ConformingMembrane& m, const Positions& x) {
  return 0.5 * x.cwiseProduct(m.stiffness * x).sum();
}
double spring_energy(const ConformingMembrane& m, const Positions& x) {
  return 0.5 * (x - m.target).rowwise().squaredNorm().dot(m.spring);
}

ConformingEnergy energy(const ConformingMembrane& m, const ConformingState& state) {
  ConformingEnergy sum;
  const double area = double(m.cells.nx) * m.cells.ny;
  sum.elastic = elastic_energy(m, state.x) / area;
  sum.constraint = spring_energy(m, state.x) / area;
  sum.volume = -0.5 * state.P.dot(m.jump * state.P) / area;
  for (std::size_t r = 0; r < m.rows.size(); ++r) {
    const ConformingRow& row = m.rows[r];
    const double excess = deformed_area(row, state.x) / row.area - 1.0,
                 p = state.P[Eigen::Index(r)];
    if (m.joined(r))
      sum.volume += row.area * p * (excess - 0.5 * p / row.kappa) / area;
    else if (std::isfinite(row.kappa))
      sum.volume += 0.5 * row.kappa * row.area * excess * excess / area;
  }
  return sum;
}

VectorXd gradient(const ConformingMembrane& m, const ConformingState& state) {
  const Positions force = m.stiffness * state.x + m.spring.asDiagonal() * (state.x - m.target);
  VectorXd out(2 * m.unknowns + Eigen::Index(m.rows.size()));
  out.setZero();
  for (std::size_t n = 0; n < m.unknown.size(); ++n) {
    const int u = m.unknown[n];
    if (u < 0) continue;
    out[u] = force(Eigen::Index(n), 0);
    out[m.unknowns + u] = force(Eigen::Index(n), 1);
  }
  out.tail(out.size() - 2 * m.unknowns) -= m.jump * state.P;
  out.head(2 * m.unknowns) += area_derivatives(m, state.x).transpose() * state.P;
  for (std::size_t r = 0; r < m.rows.size(); ++r) {
    const ConformingRow& row = m.rows[r];
    out[2 * m.unknowns + Eigen::Index(r)] +=
        deformed_area(row, state.x) - row.area - row.area * state.P[Eigen::Index(r)] / row.kappa;
  }
  return out;
}

}  // namespace drumhead::oracle
