// SPDX-License-Identifier: MIT
#pragma once
// A small lattice that conforms to a moved circle and a held open arc, each hard or soft, with a
// random state, for the tests of the kernels and of the relaxation; and its operator, assembled by
// unit vectors.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Dense>

#include <drumhead/kernels/elastic.h>

#include "cycle.h"

namespace drumhead::conforming_scene {

using grid::Point;
using multigrid::Level;

inline constexpr int kNx = 13, kNy = 11;
inline constexpr double kKappa = 10.0;

inline constexpr double kHard = std::numeric_limits<double>::infinity();

/// Weights of the circle and of the arc.
struct Weights {
  double circle = kHard, arc = kHard;
};
inline constexpr Weights kWeights[]{{kHard, kHard}, {40.0, kHard}, {500.0, 3.0}};

/// A circle that is moved and stretched, and a held arc that ends inside.
inline std::vector<grid::CurvePair> curves(Weights weights) {
  auto at = [](double cx, double cy, double rx, double ry, double a) {
    return Point{cx + rx * std::cos(a), cy + ry * std::sin(a)};
  };
  grid::CurvePair circle{.name = "circle"}, arc{.name = "arc"};
  circle.weight = weights.circle;
  arc.weight = weights.arc;
  for (int k = 0; k < 90; ++k) {
    const double a = k * std::numbers::pi / 45.0, b = (k + 1) * std::numbers::pi / 45.0;
    circle.source.push_back(grid::straight(at(5.3, 5.1, 2.6, 2.6, a), at(5.3, 5.1, 2.6, 2.6, b)));
    circle.target.push_back(grid::straight(at(5.9, 5.3, 3.0, 2.2, a), at(5.9, 5.3, 3.0, 2.2, b)));
    if (k >= 20) continue;
    arc.source.push_back(grid::straight(at(10.2, 6.1, 1.3, 3.1, a), at(10.2, 6.1, 1.3, 3.1, b)));
  }
  arc.target = arc.source;
  return {circle, arc};
}

struct Scene {
  grid::MemoryMeter meter;
  grid::Lattice lattice{kNx, kNy, 1.0, {0.0, 0.0}, 13.0};
  multigrid::Hierarchy<double> hierarchy;
  Level<double>& level;

  explicit Scene(Weights weights = {}) : Scene(curves(weights)) {}
  explicit Scene(const std::vector<grid::CurvePair>& pairs)
      : hierarchy(lattice, {.mu = 1.0, .kappa = kKappa}, grid::cut({}, lattice, 1e6), {}, meter),
        level(hierarchy[0]) {
    hierarchy.conform(pairs, lattice, meter);
    std::mt19937 bits(7);
    std::uniform_real_distribution<double> number(-0.15, 0.15);
    for_interior([&](int i, int j) {
      level.ux.view().at(i, j) = number(bits);
      level.uy.view().at(i, j) = number(bits);
    });
    for (auto* nodes : {&special_cells().held, &special_cells().crossing})
      for (kernels::HeldNode<double>& node : *nodes)
        if (!node.known()) node.off_x = number(bits), node.off_y = number(bits);
    multigrid::set_held<double>(*level.conforming, level.ux.view(), level.uy.view());
    for (int j = 0; j < kNy; ++j)
      for (int i = 0; i < kNx; ++i) level.pressure.view().at(i, j) = 10.0 * number(bits);
    for (double& p : level.conforming->pressure) p = 10.0 * number(bits);
    level.clamp_width = 1e30;
  }
  const grid::ConformingCells& cells() const { return level.conforming->geometry; }
  kernels::SpecialCells<double>& special_cells() { return level.conforming->cells; }
  bool known(int i, int j) const {
    const int n = cells().find_node(i, j);
    return n >= 0 && std::isinf(cells().node[std::size_t(n)].stiffness);
  }
  bool known(std::size_t curve_node) const {
    return std::isinf(cells().curve_node[curve_node].stiffness);
  }
  int curve_unknowns() const {
    int count = 0;
    for (std::size_t n = 0; n < cells().curve_node.size(); ++n) count += known(n) ? 0 : 2;
    return count;
  }
  bool special(int i, int j) const { return cells().find_cell(i, j) >= 0; }
  template <class F>
  static void for_interior(F&& visit) {
    for (int j = 1; j < kNy; ++j)
      for (int i = 1; i < kNx; ++i) visit(i, j);
  }
  /// visit(reference) for every unknown of a vector in a fixed order.
  template <class F>
  void for_unknowns(const kernels::Unknowns<double>& v, F&& visit) const {
    for_interior([&](int i, int j) {
      if (known(i, j)) return;
      visit(v.x.at(i, j));
      visit(v.y.at(i, j));
    });
    for (int j = 0; j < kNy; ++j)
      for (int i = 0; i < kNx; ++i)
        if (!special(i, j)) visit(v.p.at(i, j));
    for (int k = 0; k < v.listed_count; ++k) visit(v.listed[k]);
    for (int k = 0; k < v.curve_count; ++k)
      if (!known(std::size_t(k / 2))) visit(v.curve[k]);
  }
  Eigen::VectorXd gather(const kernels::Unknowns<double>& v) const {
    std::vector<double> out;
    for_unknowns(v, [&](double value) { out.push_back(value); });
    return Eigen::Map<Eigen::VectorXd>(out.data(), Eigen::Index(out.size()));
  }
  void scatter(const Eigen::VectorXd& from, const kernels::Unknowns<double>& v) const {
    Eigen::Index n = 0;
    for_unknowns(v, [&](double& value) { value = from[n++]; });
  }
  Eigen::VectorXd state() { return gather(state_values()); }
  void set_state(const Eigen::VectorXd& values) {
    const kernels::Unknowns<double> u = state_values();
    scatter(values, u);
    for (std::size_t n = 0; n < curve.size() / 2; ++n) {
      kernels::HeldNode<double>& node = special_cells().crossing[n];
      node.off_x = curve[2 * n] - node.wanted_x;
      node.off_y = curve[2 * n + 1] - node.wanted_y;
    }
    for (int j = 1; j < kNy; ++j)
      for (int n = cells().node_begin[std::size_t(j)]; n < cells().node_begin[std::size_t(j) + 1];
           ++n) {
        kernels::HeldNode<double>& node = special_cells().held[std::size_t(n)];
        node.off_x = u.x.at(node.place, j) - node.wanted_x;
        node.off_y = u.y.at(node.place, j) - node.wanted_y;
      }
  }
  Eigen::VectorXd force() {
    kernels::force<double>(level.membrane(), level.f.view());
    return gather(level.f.view());
  }
  Eigen::MatrixXd assembled() {
    level.conforming->rows.linearise(level.membrane());
    level.d.clear();
    const Eigen::Index n = gather(level.d.view()).size();
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      scatter(Eigen::VectorXd::Unit(n, k), level.d.view());
      kernels::apply_hessian<double>(level.membrane(), level.d.view(), level.f.view());
      matrix.col(k) = gather(level.f.view());
    }
    level.d.clear();
    return matrix;
  }

 private:
  std::vector<double> curve;  ///< displacements of the curve nodes

  kernels::Unknowns<double> state_values() {
    curve.clear();
    for (const kernels::HeldNode<double>& node : special_cells().crossing)
      curve.insert(curve.end(), {node.ux(), node.uy()});
    auto& pressure = level.conforming->pressure;
    return {level.ux.view(),      level.uy.view(), level.pressure.view(), pressure.data(),
            int(pressure.size()), curve.data(),    int(curve.size())};
  }
};

}  // namespace drumhead::conforming_scene
