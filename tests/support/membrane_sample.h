// SPDX-License-Identifier: MIT
#pragma once
// Small lattices of the isotropic membranes for the tests of their kernels: random moduli per cell,
// and states from rest to folded.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <drumhead/kernels/model.h>

#include "kernel_cases.h"
#include "oracle_membrane.h"

namespace drumhead::fields {

using Eigen::Matrix2d;
using Eigen::VectorXd;
using kernels::Model;

inline constexpr double kExact = 1e30;  // clamp of the exact Hessian
inline constexpr double kEps = 0.2;
inline constexpr double kCorner = 1.25;  // fold-free: stiffness of corners
inline constexpr double kFloor = 0.01;   // no J of a state in the domain of neohookean is below it

inline std::vector<Model> models() {
  std::vector<Model> all;
  for (const kernels::ModelInfo& info : kernels::kModels)
    if (kernels::isotropic(info.model)) all.push_back(info.model);
  return all;
}

/// A membrane with mu and kappa per cell on a lattice of its own.
template <class T>
struct Sample {
  int nx, ny;
  Random random;
  OwnedPlane<T> ux, uy, mu, kappa;
  kernels::Membrane<T> membrane;

  Sample(Model model, int nx_, int ny_, double spacing, unsigned seed)
      : nx(nx_),
        ny(ny_),
        random(seed),
        ux(nx + 1, ny + 1),
        uy(nx + 1, ny + 1),
        mu(nx, ny),
        kappa(nx, ny) {
    mu.fill(random, 0.5, 3.0);
    kappa.fill(random, 0.0, 4.0);
    membrane.ux = ux.view();
    membrane.uy = uy.view();
    membrane.spacing = T(spacing);
    membrane.mu.cells = mu.view();
    membrane.law = {.model = model,
                    .kappa = {T(1), kappa.view()},
                    .eps = T(model == Model::neohookean ? kFloor : kEps),
                    .corner = T(model == Model::fold_free ? kCorner : 0.0)};
    membrane.clamp_width = T(kExact);
  }
  /// x̂ = F X, and `noise` cells besides.
  void deform(const Matrix2d& F, double noise) {
    const double h = double(membrane.spacing);
    auto set = [&](OwnedPlane<T>& u, int row) {
      u.set([&](int i, int j) {
        return h * (F(row, 0) * i + F(row, 1) * j - (row ? j : i) + random.number(-noise, noise));
      });
    };
    set(ux, 0);
    set(uy, 1);
  }
  oracle::MembraneLattice lattice() const {
    oracle::MembraneLattice l{std::string(name(membrane.law.model)),
                              nx,
                              ny,
                              double(membrane.spacing),
                              kEps,
                              kCorner,
                              {},
                              {},
                              {},
                              {}};
    const std::vector<T> m = mu.values(), k = kappa.values(), x = ux.values(), y = uy.values();
    l.mu.assign(m.begin(), m.end());
    l.kappa.assign(k.begin(), k.end());
    l.x.resize(Eigen::Index(x.size()));
    l.y.resize(Eigen::Index(y.size()));
    for (int node = 0; node < int(x.size()); ++node) {
      l.x[node] = double(x[std::size_t(node)]) + l.h * (node % (nx + 1));
      l.y[node] = double(y[std::size_t(node)]) + l.h * (node / (nx + 1));
    }
    return l;
  }
  OwnedUnknowns<T> unknowns() const { return {nx, ny, false}; }
};

/// x, then y of all nodes; the boundary is 0.
template <class T>
VectorXd packed(const OwnedUnknowns<T>& u) {
  const std::vector<T> values = fields::joined({u.x.values(), u.y.values()});
  return Eigen::Map<const Eigen::Matrix<T, -1, 1>>(values.data(), Eigen::Index(values.size()))
      .template cast<double>();
}
inline VectorXd inside(const VectorXd& all, int nx, int ny) {
  VectorXd result = all;
  for (Eigen::Index u = 0; u < all.size(); ++u) {
    const Eigen::Index node = u % ((nx + 1) * (ny + 1)), i = node % (nx + 1), j = node / (nx + 1);
    if (i == 0 || j == 0 || i == nx || j == ny) result[u] = 0.0;
  }
  return result;
}

inline Matrix2d turned(double degrees) {
  return Eigen::Rotation2Dd(degrees * 3.14159265358979323846 / 180.0).toRotationMatrix();
}
/// An affine state, with noise.
struct State {
  const char* name;
  Matrix2d F;
  double noise;
  bool collapsed;  ///< J ≤ 0: not in the domain of neohookean
};
inline std::vector<State> states() {
  Matrix2d stretch, squeeze, flat, mirrored;
  stretch << 1.5, 0.25, -0.125, 0.75;
  squeeze << 0.5, 0.0, 0.125, 0.25;
  flat << 1.0, 0.5, 0.5, 0.25;
  mirrored << -0.5, 0.25, 0.125, 0.75;
  return {{"rest", Matrix2d::Identity(), 0.0, false},
          {"turned", turned(70), 0.0, false},
          {"almost turned back", turned(179), 0.0, false},
          {"stretched", stretch, 0.05, false},
          {"squeezed", turned(-30) * squeeze, 0.02, false},
          {"J = 0", flat, 0.0, true},
          {"J < 0", mirrored, 0.0, true},
          {"folded here and there", Matrix2d::Identity(), 0.5, true}};
}

/// body(sample, state) for every model in its domain.
template <class T, class F>
void for_samples(F&& body) {
  unsigned seed = 0;
  for (const Model model : models())
    for (const State& state : states()) {
      if (state.collapsed && model == Model::neohookean) continue;
      for (const auto& [nx, ny] : {std::pair{2, 2}, {3, 2}, {5, 4}, {4, 7}}) {
        Sample<T> sample(model, nx, ny, nx == 4 ? 2.0 : 1.0, ++seed);
        sample.deform(state.F, state.noise);
        SCOPED_TRACE(std::string(name(model)) + ", " + state.name + ", " + std::to_string(nx) +
                     " x " + std::to_string(ny));
        body(sample, state);
      }
    }
}

inline double relative(const VectorXd& found, const VectorXd& expected, double scale) {
  return (found - expected).lpNorm<Eigen::Infinity>() /
         std::max(expected.lpNorm<Eigen::Infinity>(), scale);
}

}  // namespace drumhead::fields
