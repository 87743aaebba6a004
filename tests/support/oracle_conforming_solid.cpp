// SPDX-License-Identifier: MIT
#include "oracle_conforming_solid.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>
#include <Eigen/SparseLU>

namespace drumhead::oracle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector4d;

/// Nodes and the gradients of their shape functions.
struct Slopes {
  std::vector<int> node;
  std::vector<Vector2d> slope;
};

class Assembly {
 public:
  Assembly(const ConformingMembrane& m, const SolidLaw& law, const Positions& x, bool projected)
      : m_(m), law_(law), x_(x), projected_(projected) {
    system_.gradient = Eigen::VectorXd::Zero(2 * m.unknowns);
    const grid::ConformingCells& cells = m.cells;
    for (int j = 0; j < cells.ny; ++j)
      for (int i = 0; i < cells.nx; ++i) {
        const int c = cells.find_cell(i, j);
        if (c < 0) {
          add_regular(i, j);
          continue;
        }
        for (int p = cells.part_begin[std::size_t(c)]; p < cells.part_begin[std::size_t(c) + 1];
             ++p)
          add_part(c, p, j);
      }
    add_springs();
    system_.hessian.resize(2 * m.unknowns, 2 * m.unknowns);
    system_.hessian.setFromTriplets(entries_.begin(), entries_.end());
  }
  MembraneSystem system_;

 private:
  int number(int i, int j) const { return j * (m_.cells.nx + 1) + i; }

  void add_regular(int i, int j) {
    auto at = [&](double s, double t) {
      return Slopes{{number(i, j), number(i + 1, j), number(i, j + 1), number(i + 1, j + 1)},
                    {{t - 1, s - 1}, {1 - t, -s}, {-t, 1 - s}, {t, s}}};
    };
    if (law_.model == "fold-free") {
      for (int n = 0; n < 4; ++n) add_fold_free(at(n % 2, n / 2), 0.25);
      return add(at(0.5, 0.5), 1.0, "volume", 1.0, law_.kappa, -1.0);
    }
    const double g = 0.5 / std::sqrt(3.0);
    for (const double t : {0.5 - g, 0.5 + g})
      for (const double s : {0.5 - g, 0.5 + g}) add(at(s, t), 0.25, law_.model, 1.0, law_.kappa);
    for (int n = 0; n < 4 && law_.model == "arap"; ++n)
      add(at(n % 2, n / 2), 0.25, "one_sided", 1.0, law_.kappa);
  }

  /// Its density but for the part with kappa.
  void add_fold_free(const Slopes& at, double weight) {
    add(at, weight, "harmonic", 1.0, 0.0);
    add(at, weight, "one_sided", 1.0, law_.corner);
  }

  void add_springs() {
    for (std::size_t n = 0; n < m_.unknown.size(); ++n) {
      const double s = m_.spring[Eigen::Index(n)];
      const int u = m_.unknown[n];
      if (u < 0 || s == 0.0) continue;
      const Eigen::RowVector2d off = x_.row(Eigen::Index(n)) - m_.target.row(Eigen::Index(n));
      system_.energy += 0.5 * s * off.squaredNorm();
      for (const int axis : {0, 1}) {
        const int row = u + axis * m_.unknowns;
        system_.gradient[row] += s * off[axis];
        entries_.emplace_back(row, row, s);
      }
    }
  }

  void add_part(int c, int p, int j) {
    const grid::ConformingCells& cells = m_.cells;
    Slopes mean;
    for (int t = cells.part_triangle_begin[std::size_t(p)];
         t < cells.part_triangle_begin[std::size_t(p) + 1]; ++t) {
      const grid::PartTriangle& triangle = cells.triangle[std::size_t(t)];
      const double share = triangle.area / cells.part_area[std::size_t(p)];
      Slopes own;
      for (std::size_t a = 0; a < 3; ++a) {
        const int code =
            cells.part_node[std::size_t(cells.part_node_begin[std::size_t(p)] + triangle.node[a])];
        own.node.push_back(
            code >= 4 ? number(0, cells.ny + 1) + code - 4
                      : number(cells.cell_column[std::size_t(c)] + (code & 1), j + (code >> 1)));
        own.slope.push_back({triangle.gradient[a].x, triangle.gradient[a].y});
        mean.node.push_back(own.node.back());
        mean.slope.push_back(share * own.slope.back());
      }
      if (law_.model == "fold-free") {
        add_fold_free(own, triangle.area);
        continue;
      }
      add(own, triangle.area, law_.model, 1.0, 0.0);
      if (law_.model == "arap") add(own, triangle.area, "one_sided", 1.0, law_.kappa);
    }
    if (law_.model == "fold-free")
      add(mean, cells.part_area[std::size_t(p)], "volume", 1.0, law_.kappa, -1.0);
    else if (law_.model != "arap")
      add(mean, cells.part_area[std::size_t(p)], law_.model, 0.0, law_.kappa);
  }

  /// `least`: eigenvalue of the projected tangent.
  void add(const Slopes& at, double weight, const std::string& model, double mu, double kappa,
           double least = 0.0) {
    Matrix2 F = Matrix2::Zero();
    for (std::size_t n = 0; n < at.node.size(); ++n)
      F += x_.row(at.node[n]).transpose() * at.slope[n].transpose();
    const PointLaw law = law_at(model, F, mu, kappa, law_.eps);
    Eigen::Matrix4d tangent = law.tangent;
    if (projected_) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(tangent);
      tangent = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(least).asDiagonal() *
                eigen.eigenvectors().transpose();
    }
    const Eigen::Index count = Eigen::Index(at.node.size());
    Eigen::Matrix4Xd derivative = Eigen::Matrix4Xd::Zero(4, 2 * count);
    for (Eigen::Index n = 0; n < count; ++n) {
      derivative(0, n) = derivative(1, count + n) = at.slope[std::size_t(n)].x();
      derivative(2, n) = derivative(3, count + n) = at.slope[std::size_t(n)].y();
    }
    const Eigen::VectorXd force =
        weight * derivative.transpose() * Eigen::Map<const Vector4d>(law.stress.data());
    const Eigen::MatrixXd block = weight * derivative.transpose() * tangent * derivative;
    system_.energy += weight * law.energy;
    auto unknown = [&](Eigen::Index k) {
      const int n = m_.unknown[std::size_t(at.node[std::size_t(k % count)])];
      return n < 0 ? -1 : n + (k < count ? 0 : m_.unknowns);
    };
    for (Eigen::Index row = 0; row < 2 * count; ++row) {
      if (unknown(row) < 0) continue;
      system_.gradient[unknown(row)] += force[row];
      for (Eigen::Index column = 0; column < 2 * count; ++column)
        if (unknown(column) >= 0)
          entries_.emplace_back(unknown(row), unknown(column), block(row, column));
    }
  }

  const ConformingMembrane& m_;
  const SolidLaw& law_;
  const Positions& x_;
  bool projected_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

MembraneSystem assemble(const ConformingMembrane& membrane, const SolidLaw& law, const Positions& x,
                        bool projected) {
  return Assembly(membrane, law, x, projected).system_;
}

Positions newton(const ConformingMembrane& membrane, const SolidLaw& law, Positions x, int steps) {
  for (int step = 0; step < steps; ++step) {
    const MembraneSystem system = assemble(membrane, law, x, false);
    Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(system.hessian);
    if (factor.info() != Eigen::Success) throw std::runtime_error("oracle: singular matrix");
    const Eigen::VectorXd dx = factor.solve(-system.gradient);
    for (std::size_t n = 0; n < membrane.unknown.size(); ++n)
      if (const int u = membrane.unknown[n]; u >= 0)
        x.row(Eigen::Index(n)) += Vector2d(dx[u], dx[membrane.unknowns + u]);
    if (dx.lpNorm<Eigen::Infinity>() < 1e-12) break;
  }
  return x;
}

}  // namespace drumhead::oracle
