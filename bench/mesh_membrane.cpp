// SPDX-License-Identifier: MIT
#include "mesh_membrane.h"

#include <algorithm>
#include <cmath>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>

#include "nested_newton.h"

namespace drumhead::bench {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;
using Corners = Eigen::Matrix<double, 2, 3>;

Vector2d left_turn(const Vector2d& v) { return {-v.y(), v.x()}; }

/// One mesh with its state.
class MeshLevel {
 public:
  MeshLevel(const CurveMesh& mesh, double kappa) : mesh_(mesh), kappa_(kappa) {
    solver_.cholmod().print = 0;  // standard output is for the rows
    const std::size_t vertices = mesh.rest.size();
    unknown_.assign(vertices, -1);
    for (std::size_t v = 0; v < vertices; ++v)
      if (!mesh.known[v]) unknown_[v] = unknowns_++;
    moved = mesh.target;
    P = VectorXd::Zero(mesh.patches);
    area_ = VectorXd::Zero(mesh.patches);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const int s : mesh.patch[t]) area_[s] += rest_area(t) / 3.0;
  }

  /// A full step; its RMS over the vertices. Negative: no factorisation was possible.
  double step(double theta, MeshWarp& cost) {
    const double start = now();
    assemble(theta);
    double assembled = now();
    cost.assemble_seconds += assembled - start;
    if (!factorise(cost) && theta > 1.0) {
      // Unclamped pressures may make it indefinite far from the solution.
      cost.solve_seconds += now() - assembled;
      assemble(1.0);
      factorise(cost);
      assembled = now();
    }
    if (solver_.info() != Eigen::Success) return -1.0;
    const VectorXd dx = solver_.solve(right_);
    P += (kappa_ * (B_ * dx + gap_)).cwiseQuotient(area_);
    for (std::size_t v = 0; v < moved.size(); ++v)
      if (const int u = unknown_[v]; u >= 0) moved[v] += dx.segment<2>(2 * u);
    cost.solve_seconds += now() - assembled;
    return dx.norm() / std::sqrt(double(moved.size()));
  }

  /// x̂ and P of a coarser mesh, interpolated.
  void interpolate(const CurveMesh& coarse, const MeshLevel& from) {
    const auto places = coarse.places_of(mesh_.rest);
    for (std::size_t v = 0; v < moved.size(); ++v) {
      if (mesh_.known[v]) continue;
      const auto& corners = coarse.triangles[std::size_t(places[v].triangle)];
      moved[v].setZero();
      for (std::size_t k = 0; k < 3; ++k)
        moved[v] += places[v].share[k] * from.moved[std::size_t(corners[k])];
    }
    std::vector<Vector2d> centres(std::size_t(mesh_.patches), Vector2d::Zero());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      Vector2d centre = Vector2d::Zero();
      for (const int v : mesh_.triangles[t]) centre += mesh_.rest[std::size_t(v)] / 3.0;
      for (const int s : mesh_.patch[t])
        centres[std::size_t(s)] += rest_area(t) / (3.0 * area_[s]) * centre;
    }
    const auto there = coarse.places_of(centres);
    for (Eigen::Index s = 0; s < P.size(); ++s) {
      P[s] = 0.0;
      for (const int c : coarse.patch[std::size_t(there[std::size_t(s)].triangle)])
        P[s] += from.P[c] / 3.0;
    }
  }

  int folded() const {
    int count = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      count += doubled_area(mesh_.triangles[t], moved) <= 0.0;
    return count;
  }

  std::vector<Vector2d> moved;
  VectorXd P;

 private:
  static double doubled_area(const std::array<int, 3>& corner, const std::vector<Vector2d>& at) {
    const Vector2d a = at[std::size_t(corner[0])];
    const Vector2d ab = at[std::size_t(corner[1])] - a, ac = at[std::size_t(corner[2])] - a;
    return ab.x() * ac.y() - ab.y() * ac.x();
  }
  double rest_area(std::size_t t) const {
    return 0.5 * doubled_area(mesh_.triangles[t], mesh_.rest);
  }

  /// Sides opposite to the corners, counterclockwise.
  static Corners sides(const std::array<int, 3>& corner, const std::vector<Vector2d>& at) {
    Corners side;
    for (std::size_t k = 0; k < 3; ++k)
      side.col(Eigen::Index(k)) =
          at[std::size_t(corner[(k + 2) % 3])] - at[std::size_t(corner[(k + 1) % 3])];
    return side;
  }

  /// A_ = K + G(P_H) + kappa Bᵀ A⁻¹ B, of its lower triangle; right_; B_; gap_ = A (J̄ − 1 −
  /// P/kappa).
  void assemble(double theta) {
    const VectorXd P_H = clamped(P, theta);
    Entries stiffness, volume;
    VectorXd gradient = VectorXd::Zero(2 * unknowns_), mean = VectorXd::Zero(mesh_.patches);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& corner = mesh_.triangles[t];
      const double area = rest_area(t);
      // Gradients of the corners' shares are the left turns of the sides, by twice the area; the
      // moved triangle's area changes with a corner by half the left turn of its moved side.
      const Corners rest = sides(corner, mesh_.rest), now_at = sides(corner, moved);
      double pressure = 0.0, pressure_H = 0.0;
      for (const int s : mesh_.patch[t]) {
        pressure += P[s] / 3.0;
        pressure_H += P_H[s] / 3.0;
        mean[s] += doubled_area(corner, moved) / 6.0;
      }
      const Eigen::Matrix3d K = rest.transpose() * rest / (4.0 * area);
      for (int a = 0; a < 3; ++a) {
        const int u = unknown_[std::size_t(corner[std::size_t(a)])];
        if (u < 0) continue;
        const Vector2d dA = 0.5 * left_turn(now_at.col(a));
        for (int b = 0; b < 3; ++b) {
          const auto v = std::size_t(corner[std::size_t(b)]);
          gradient.segment<2>(2 * u) += K(a, b) * moved[v];
          add_block(stiffness, u, unknown_[v], K(a, b), 0.5 * pressure_H * turn(a, b));
        }
        gradient.segment<2>(2 * u) += pressure * dA;
        for (const int s : mesh_.patch[t])
          for (int axis = 0; axis < 2; ++axis) volume.emplace_back(s, 2 * u + axis, dA[axis] / 3.0);
      }
    }
    const int size = 2 * unknowns_;
    B_.resize(mesh_.patches, size);
    B_.setFromTriplets(volume.begin(), volume.end());
    gap_ = mean - area_ - area_.cwiseProduct(P) / kappa_;
    const VectorXd stiff = kappa_ * area_.cwiseInverse();
    Sparse K_G(size, size);
    K_G.setFromTriplets(stiffness.begin(), stiffness.end());
    const Sparse BDB = B_.transpose() * stiff.asDiagonal() * B_;
    A_ = K_G + BDB;
    right_ = -gradient - B_.transpose() * stiff.cwiseProduct(gap_);
  }

  /// +1 for the corner after a, −1 for the one before it.
  static int turn(int a, int b) { return a == b ? 0 : (b == (a + 1) % 3 ? 1 : -1); }

  /// ∂²(doubled area)/∂x_a ∂y_b = turn: the block is [k, g; −g, k].
  static void add_block(Entries& entries, int u, int v, double k, double g) {
    if (v < 0) return;
    entries.emplace_back(2 * u, 2 * v, k);
    entries.emplace_back(2 * u + 1, 2 * v + 1, k);
    entries.emplace_back(2 * u, 2 * v + 1, g);
    entries.emplace_back(2 * u + 1, 2 * v, -g);
  }

  bool factorise(MeshWarp& cost) {
    if (!analysed_) solver_.analyzePattern(A_);
    analysed_ = true;
    solver_.factorize(A_);
    ++cost.factorisations;
    cost.solver_bytes = std::max(cost.solver_bytes, double(solver_.cholmod().memory_usage));
    return solver_.info() == Eigen::Success;
  }

  const CurveMesh& mesh_;
  const double kappa_;
  std::vector<int> unknown_;
  int unknowns_ = 0;
  VectorXd area_, right_, gap_;
  Sparse A_, B_;
  Eigen::CholmodSupernodalLLT<Sparse> solver_;
  bool analysed_ = false;
};

}  // namespace

MeshWarp solve_on_mesh(const scenes::Scene& scene, int n, double kappa) {
  MeshWarp result;
  std::unique_ptr<CurveMesh> coarse_mesh;
  std::unique_ptr<MeshLevel> coarse;
  double theta = 1.0;
  for (const int cells : nested_lattices(n)) {
    const double start = now();
    auto mesh = std::make_unique<CurveMesh>(mesh_along_curves(scene, cells));
    const double meshed = now();
    auto level = std::make_unique<MeshLevel>(*mesh, kappa);
    if (coarse) level->interpolate(*coarse_mesh, *coarse);
    result.mesh_seconds += meshed - start;
    result.assemble_seconds += now() - meshed;
    result.newton_finest = newton_steps(!coarse, theta, [&](double t) {
      const double dx = result.solved ? level->step(t, result) : 0.0;
      result.solved &= dx >= 0.0;
      return NewtonStep{std::max(0.0, dx) * cells, 1.0};
    });
    result.newton += result.newton_finest;
    coarse = std::move(level);
    coarse_mesh = std::move(mesh);
  }
  result.moved = coarse->moved;
  result.folded = coarse->folded();
  coarse.reset();
  result.mesh = std::move(*coarse_mesh);
  return result;
}

}  // namespace drumhead::bench
