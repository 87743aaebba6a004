// SPDX-License-Identifier: MIT
#include "oracle_membrane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>

#include "oracle_newton.h"

namespace drumhead::oracle {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using Eigen::VectorXd;

Matrix2 cofactor(const Matrix2& F) {
  Matrix2 c;
  c << F(1, 1), -F(1, 0), -F(0, 1), F(0, 0);
  return c;
}
Matrix2 symmetric(const Matrix2& A) { return 0.5 * (A + A.transpose()); }
double inner(const Matrix2& A, const Matrix2& B) { return A.cwiseProduct(B).sum(); }

/// The closest rotation by its angle, and its derivative.
struct Rotation {
  double u, v;
  Matrix2 R;
  explicit Rotation(const Matrix2& F) : u(F(0, 0) + F(1, 1)), v(F(1, 0) - F(0, 1)) {
    const double angle = std::atan2(v, u);
    R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  }
  Matrix2 along(const Matrix2& dF) const {
    const double du = dF(0, 0) + dF(1, 1), dv = dF(1, 0) - dF(0, 1);
    Matrix2 quarter;
    quarter << 0, -1, 1, 0;
    return (u * dv - v * du) / (u * u + v * v) * quarter * R;
  }
};

struct Parameters {
  double mu, kappa, eps;
};
/// Energy and stress; derivative of the stress along dF.
using Energy = double (*)(const Matrix2&, const Parameters&);
using Stress = Matrix2 (*)(const Matrix2&, const Parameters&);
using Along = Matrix2 (*)(const Matrix2&, const Matrix2&, const Parameters&);
struct Law {
  const char* name;
  Energy energy;
  Stress stress;
  Along along;
};

const Law kLaws[] = {
    {"arap",
     [](const Matrix2& F, const Parameters& p) {
       return 0.5 * p.mu * (F - Rotation(F).R).squaredNorm();
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 { return p.mu * (F - Rotation(F).R); },
     [](const Matrix2& F, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       return p.mu * (dF - Rotation(F).along(dF));
     }},
    {"one_sided",
     [](const Matrix2& F, const Parameters& p) {
       const double lack = std::min(0.0, F.determinant() - p.eps);
       return 0.5 * p.kappa * lack * lack;
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 {
       return p.kappa * std::min(0.0, F.determinant() - p.eps) * cofactor(F);
     },
     [](const Matrix2& F, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       const double lack = F.determinant() - p.eps;
       if (lack >= 0.0) return Matrix2::Zero();
       return p.kappa * (inner(cofactor(F), dF) * cofactor(F) + lack * cofactor(dF));
     }},
    {"harmonic", [](const Matrix2& F, const Parameters& p) { return 0.5 * p.mu * F.squaredNorm(); },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 { return p.mu * F; },
     [](const Matrix2&, const Matrix2& dF, const Parameters& p) -> Matrix2 { return p.mu * dF; }},
    {"volume",
     [](const Matrix2& F, const Parameters& p) {
       return 0.5 * p.kappa * std::pow(F.determinant() - 1.0, 2);
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 {
       return p.kappa * (F.determinant() - 1.0) * cofactor(F);
     },
     [](const Matrix2& F, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       return p.kappa *
              (inner(cofactor(F), dF) * cofactor(F) + (F.determinant() - 1.0) * cofactor(dF));
     }},
    {"corotated",
     [](const Matrix2& F, const Parameters& p) {
       const Matrix2 R = Rotation(F).R;
       const double stretch = inner(R, F) - 2.0;
       return p.mu * (F - R).squaredNorm() + 0.5 * p.kappa * stretch * stretch;
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 {
       const Matrix2 R = Rotation(F).R;
       return 2.0 * p.mu * (F - R) + p.kappa * (inner(R, F) - 2.0) * R;
     },
     [](const Matrix2& F, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       const Rotation r(F);
       const Matrix2 dR = r.along(dF);
       return 2.0 * p.mu * (dF - dR) +
              p.kappa * ((inner(r.R, dF) + inner(dR, F)) * r.R + (inner(r.R, F) - 2.0) * dR);
     }},
    {"linear",
     [](const Matrix2& F, const Parameters& p) {
       const Matrix2 e = symmetric(F) - Matrix2::Identity();
       return p.mu * e.squaredNorm() + 0.5 * p.kappa * e.trace() * e.trace();
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 {
       const Matrix2 e = symmetric(F) - Matrix2::Identity();
       return 2.0 * p.mu * e + p.kappa * e.trace() * Matrix2::Identity();
     },
     [](const Matrix2&, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       return 2.0 * p.mu * symmetric(dF) + p.kappa * dF.trace() * Matrix2::Identity();
     }},
    {"neohookean",
     [](const Matrix2& F, const Parameters& p) {
       const double log = std::log(F.determinant());
       return 0.5 * p.mu * (F.squaredNorm() - 2.0) - p.mu * log + 0.5 * p.kappa * log * log;
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 {
       const Matrix2 inverse = F.inverse().transpose();
       return p.mu * (F - inverse) + p.kappa * std::log(F.determinant()) * inverse;
     },
     [](const Matrix2& F, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       const Matrix2 inverse = F.inverse().transpose();
       const double push = p.mu - p.kappa * std::log(F.determinant());
       return p.mu * dF + push * inverse * dF.transpose() * inverse +
              p.kappa * inner(inverse, dF) * inverse;
     }},
    {"stvk",
     [](const Matrix2& F, const Parameters& p) {
       const Matrix2 E = 0.5 * (F.transpose() * F - Matrix2::Identity());
       return p.mu * E.squaredNorm() + 0.5 * p.kappa * E.trace() * E.trace();
     },
     [](const Matrix2& F, const Parameters& p) -> Matrix2 {
       const Matrix2 E = 0.5 * (F.transpose() * F - Matrix2::Identity());
       return F * (2.0 * p.mu * E + p.kappa * E.trace() * Matrix2::Identity());
     },
     [](const Matrix2& F, const Matrix2& dF, const Parameters& p) -> Matrix2 {
       const Matrix2 E = 0.5 * (F.transpose() * F - Matrix2::Identity());
       const Matrix2 dE = symmetric(F.transpose() * dF);
       return dF * (2.0 * p.mu * E + p.kappa * E.trace() * Matrix2::Identity()) +
              F * (2.0 * p.mu * dE + p.kappa * dE.trace() * Matrix2::Identity());
     }},
};

/// A point of the cell and the law that acts there.
struct Point {
  std::string law;
  double s, t;
  double weight = 0.25;     ///< of the cell's area
  double least = 0.0;       ///< eigenvalue of the projected tangent, in mu
  bool of_corners = false;  ///< kappa is MembraneLattice::corner
};
std::vector<Point> points(const std::string& model) {
  const double g = 0.5 / std::sqrt(3.0);
  std::vector<Point> all;
  if (model == "fold-free") {
    for (const double t : {0.0, 1.0})
      for (const double s : {0.0, 1.0})
        for (const char* law : {"harmonic", "one_sided"})
          all.push_back({law, s, t, 0.25, 0.0, true});
    all.push_back({"volume", 0.5, 0.5, 1.0, -1.0});  // Eq. 6 makes up for −mu
    return all;
  }
  for (const double t : {0.5 - g, 0.5 + g})
    for (const double s : {0.5 - g, 0.5 + g}) all.push_back({model, s, t});
  if (model == "arap")
    for (const double t : {0.0, 1.0})
      for (const double s : {0.0, 1.0}) all.push_back({"one_sided", s, t});
  return all;
}

Matrix4d raised(const Matrix4d& tangent, double least) {
  const Eigen::SelfAdjointEigenSolver<Matrix4d> eigen(tangent);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(least).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

PointLaw law_at(const std::string& model, const Matrix2& F, double mu, double kappa, double eps) {
  const auto law = std::ranges::find(kLaws, model, &Law::name);
  if (law == std::end(kLaws)) throw std::invalid_argument("no law " + model);
  const Parameters p{mu, kappa, eps};
  PointLaw point{law->energy(F, p), law->stress(F, p), {}};
  for (int column = 0; column < 4; ++column) {
    Matrix2 dF = Matrix2::Zero();
    dF.data()[column] = 1.0;
    const Matrix2 change = law->along(F, dF, p);
    point.tangent.col(column) = Eigen::Map<const Vector4d>(change.data());
  }
  return point;
}

Matrix4d mean_projected_tangent(const std::string& model, const Matrix2& F, double mu, double kappa,
                                double eps, double corner) {
  Matrix4d sum = Matrix4d::Zero();
  for (const Point& p : points(model))
    sum += p.weight *
           raised(law_at(p.law, F, mu, p.of_corners ? corner : kappa, eps).tangent, p.least * mu);
  return sum;
}

MembraneSystem assemble(const MembraneLattice& lattice, bool projected) {
  const int columns = lattice.nx + 1;
  const Eigen::Index nodes = lattice.x.size();
  MembraneSystem system;
  system.gradient = VectorXd::Zero(2 * nodes);
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<Point> all = points(lattice.model);
  for (int j = 0; j < lattice.ny; ++j)
    for (int i = 0; i < lattice.nx; ++i) {
      const auto cell = std::size_t(j * lattice.nx + i);
      for (const Point& point : all) {
        const double s = point.s, t = point.t, h = lattice.h;
        const std::array<Eigen::Vector2d, 4> slope{{{-(1 - t) / h, -(1 - s) / h},
                                                    {(1 - t) / h, -s / h},
                                                    {-t / h, (1 - s) / h},
                                                    {t / h, s / h}}};
        Matrix2 F = Matrix2::Zero();
        std::array<int, 4> node{};
        for (int n = 0; n < 4; ++n) {
          node[std::size_t(n)] = (j + n / 2) * columns + i + n % 2;
          const int at = node[std::size_t(n)];
          F += Eigen::Vector2d(lattice.x[at], lattice.y[at]) * slope[std::size_t(n)].transpose();
        }
        const double mu = lattice.mu[cell];
        const double kappa = point.of_corners ? lattice.corner : lattice.kappa[cell];
        PointLaw law = law_at(point.law, F, mu, kappa, lattice.eps);
        if (projected) law.tangent = raised(law.tangent, point.least * mu);
        const double weight = point.weight * h * h;
        system.energy += weight * law.energy;
        // Columns: the derivative of (F11, F21, F12, F22) by a node's x, then by its y.
        Eigen::Matrix<double, 4, 8> derivative = Eigen::Matrix<double, 4, 8>::Zero();
        for (int n = 0; n < 4; ++n) {
          derivative(0, n) = derivative(1, 4 + n) = slope[std::size_t(n)].x();
          derivative(2, n) = derivative(3, 4 + n) = slope[std::size_t(n)].y();
        }
        const Vector4d stress = Eigen::Map<const Vector4d>(law.stress.data());
        const Eigen::Matrix<double, 8, 1> force = weight * derivative.transpose() * stress;
        const Eigen::Matrix<double, 8, 8> block =
            weight * derivative.transpose() * law.tangent * derivative;
        auto unknown = [&](int k) { return node[std::size_t(k % 4)] + (k / 4) * nodes; };
        for (int row = 0; row < 8; ++row) {
          system.gradient[unknown(row)] += force[row];
          for (int column = 0; column < 8; ++column)
            entries.emplace_back(unknown(row), unknown(column), block(row, column));
        }
      }
    }
  system.hessian.resize(2 * nodes, 2 * nodes);
  system.hessian.setFromTriplets(entries.begin(), entries.end());
  return system;
}

State newton(const OracleScene& scene, const std::string& model, double kappa, double eps,
             const State& start, int steps) {
  OracleScene rows = scene;  // the curve rows alone
  rows.mu.assign(rows.mu.size(), 0.0);
  MembraneLattice lattice{model, scene.n, scene.n, 1.0, eps, 1e4, scene.mu, {}, {}, {}};
  lattice.kappa.assign(scene.mu.size(), kappa);
  State state = start;
  auto index = [&](Eigen::Index unknown) {  // in the order of the scene's unknowns; −1: fixed
    const Eigen::Index nodes = state.x.size();
    const int at = scene.node_unknown[std::size_t(unknown % nodes)];
    return at < 0 ? -1 : at + (unknown < nodes ? 0 : scene.free_nodes);
  };
  for (int n = 0; n < steps; ++n) {
    lattice.x = state.x;
    lattice.y = state.y;
    const MembraneSystem elastic = assemble(lattice, false);
    OracleSystem system = assemble(rows, state, VectorXd::Zero(state.P.size()));
    std::vector<Eigen::Triplet<double>> entries;
    for (int column = 0; column < elastic.hessian.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(elastic.hessian, column); it; ++it)
        if (index(it.row()) >= 0 && index(it.col()) >= 0)
          entries.emplace_back(index(it.row()), index(it.col()), it.value());
    for (Eigen::Index u = 0; u < elastic.gradient.size(); ++u)
      if (index(u) >= 0) system.gradient[index(u)] += elastic.gradient[u];
    Eigen::SparseMatrix<double> hessian(system.matrix.rows(), system.matrix.cols());
    hessian.setFromTriplets(entries.begin(), entries.end());
    VectorXd step;
    solve(system.matrix + hessian, -system.gradient, 2 * scene.free_nodes, step);
    state = moved(scene, state, step, 1.0);
    if (step.head(2 * scene.free_nodes).lpNorm<Eigen::Infinity>() < 1e-12) break;
  }
  return state;
}

}  // namespace drumhead::oracle
