// SPDX-License-Identifier: MIT
// The isotropic membranes on conforming cells, along hard and soft curves, against the assembled
// oracle: energy, force, Hessian with and without its negative eigenvalues, relaxation, corner
// pressures; the same bits on every instruction set; and the convergence of cycles.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <drumhead/kernels/blocks.h>
#include <drumhead/kernels/isa.h>
#include <drumhead/kernels/model.h>
#include <drumhead/kernels/reduce.h>

#include "support/conforming_scene.h"
#include "support/oracle_conforming_solid.h"

namespace drumhead {
namespace {

using conforming_scene::kNx, conforming_scene::kNy, conforming_scene::Weights;
using Eigen::VectorXd;
using kernels::Model;

constexpr double kKappa = 3.0, kNoClamp = 1e30;

std::vector<Model> models() {
  std::vector<Model> all;
  for (const kernels::ModelInfo& info : kernels::kModels)
    if (kernels::isotropic(info.model)) all.push_back(info.model);
  return all;
}

/// A membrane on the lattice of conforming_scene, at a state that follows the moved circle, and up
/// to `noise` cells besides.
struct Sample {
  grid::MemoryMeter meter;
  grid::Lattice lattice{kNx, kNy, 1.0, {0.0, 0.0}, 13.0};
  multigrid::Hierarchy<double> hierarchy;
  multigrid::Level<double>& level;
  oracle::ConformingMembrane membrane;
  oracle::SolidLaw law;

  Sample(Model model, double noise, double kappa = kKappa, Weights weights = {})
      : hierarchy(lattice, {.mu = 1.0, .kappa = kappa, .model = model}, grid::cut({}, lattice, 1e6),
                  {.pressure = false, .model = model}, meter),
        level(hierarchy[0]),
        membrane(oracle::conforming_membrane(conforming_scene::curves(weights), lattice,
                                             std::vector<double>(kNx * kNy, kappa))),
        law{std::string(name(model)), kappa, 0.2} {
    hierarchy.conform(conforming_scene::curves(weights), lattice, meter);
    std::mt19937 bits(7);
    std::uniform_real_distribution<double> number(-noise, noise);
    for_interior([&](int i, int j) {
      const double x = i - 5.3, y = j - 5.1;
      const double share = std::clamp((5.0 - std::hypot(x, y)) / 2.4, 0.0, 1.0);
      level.ux.view().at(i, j) = share * (0.6 + x * 0.4 / 2.6) + number(bits);
      level.uy.view().at(i, j) = share * (0.2 - y * 0.4 / 2.6) + number(bits);
    });
    for (auto* nodes : {&level.conforming->cells.held, &level.conforming->cells.crossing})
      for (kernels::HeldNode<double>& node : *nodes)
        if (!node.known()) node.off_x = number(bits), node.off_y = number(bits);
    multigrid::set_held<double>(*level.conforming, level.ux.view(), level.uy.view());
    level.clamp_width = kNoClamp;
    if (model == Model::neohookean) level.solid.law.eps = 1e-3;
    if (model == Model::fold_free && kappa == kKappa) {  // without corner pressures
      level.solid.law.corner = law.corner = 1.25;
      level.solid.law.relief = 0.0;
    }
  }
  template <class F>
  static void for_interior(F&& visit) {
    for (int j = 1; j < kNy; ++j)
      for (int i = 1; i < kNx; ++i) visit(i, j);
  }
  /// visit(number, node) for every unknown node.
  template <class F>
  void for_unknown(F&& visit) const {
    for_interior([&](int i, int j) {
      const int n = membrane.unknown[std::size_t(j * (kNx + 1) + i)];
      if (n >= 0) visit(n, i, j);
    });
  }
  /// visit(number, node) for every curve node of a soft curve.
  template <class F>
  void for_soft(F&& visit) const {
    const std::size_t lattice_nodes = (kNx + 1) * (kNy + 1);
    for (std::size_t n = lattice_nodes; n < membrane.unknown.size(); ++n)
      if (membrane.unknown[n] >= 0) visit(membrane.unknown[n], int(n - lattice_nodes));
  }
  oracle::Positions positions() const {
    oracle::Positions x = membrane.rest;
    for (Eigen::Index n = 0; n < x.rows(); ++n)
      if (membrane.known[std::size_t(n)]) x.row(n) = membrane.target.row(n);
    for_soft([&](int, int c) {
      const kernels::HeldNode<double>& node = level.conforming->cells.crossing[std::size_t(c)];
      x.row((kNx + 1) * (kNy + 1) + c) += Eigen::RowVector2d(node.ux(), node.uy());
    });
    for_unknown([&](int, int i, int j) {
      x(j * (kNx + 1) + i, 0) += level.ux.view().at(i, j);
      x(j * (kNx + 1) + i, 1) += level.uy.view().at(i, j);
    });
    return x;
  }
  VectorXd gather(const kernels::Unknowns<double>& v) const {
    VectorXd out(2 * membrane.unknowns);
    for_unknown([&](int n, int i, int j) {
      out[n] = v.x.at(i, j);
      out[membrane.unknowns + n] = v.y.at(i, j);
    });
    for_soft([&](int n, int c) {
      out[n] = v.curve[2 * c];
      out[membrane.unknowns + n] = v.curve[2 * c + 1];
    });
    return out;
  }
  void scatter(const VectorXd& from, const kernels::Unknowns<double>& v) const {
    for_unknown([&](int n, int i, int j) {
      v.x.at(i, j) = from[n];
      v.y.at(i, j) = from[membrane.unknowns + n];
    });
    for_soft([&](int n, int c) {
      v.curve[2 * c] = from[n];
      v.curve[2 * c + 1] = from[membrane.unknowns + n];
    });
  }
  /// x̂ + d
  void move() {
    for_interior([&](int i, int j) {
      level.ux.view().at(i, j) += level.d.view().x.at(i, j);
      level.uy.view().at(i, j) += level.d.view().y.at(i, j);
    });
    multigrid::move_held<double>(*level.conforming, level.d.view(), 1.0, level.ux.view(),
                                 level.uy.view());
  }
  double energy(double step) const {
    const kernels::EnergySums sums =
        kernels::energy<double>(level.membrane(), level.d.view(), step);
    return sums.elastic + sums.volume + sums.constraint;
  }
  VectorXd force() {
    kernels::force<double>(level.membrane(), level.f.view());
    return gather(level.f.view());
  }
  VectorXd product(const VectorXd& d) {
    level.d.clear();
    scatter(d, level.d.view());
    kernels::apply_hessian<double>(level.membrane(), level.d.view(), level.f.view());
    return gather(level.f.view());
  }
};

/// body(sample) for every model and hard and soft curves, at a state close to rest and at one with
/// folds.
template <class F>
void for_samples(F&& body) {
  for (const Model model : models())
    for (const double noise : {0.02, 0.4})
      for (const Weights& weights : conforming_scene::kWeights) {
        if (model == Model::neohookean && noise > 0.1) continue;  // J > 0 everywhere
        SCOPED_TRACE(std::string(name(model)) + ", noise " + std::to_string(noise) +
                     ", weight of the circle " + std::to_string(weights.circle));
        Sample sample(model, noise, kKappa, weights);
        body(sample);
      }
}

TEST(ConformingMembranes, EnergyAndForceAreTheOracles) {
  for_samples([](Sample& sample) {
    const oracle::MembraneSystem system =
        oracle::assemble(sample.membrane, sample.law, sample.positions(), false);
    // Of what held nodes alone decide, the oracle counts the energy too.
    const double before = sample.energy(0.0);
    const VectorXd force = sample.force();
    EXPECT_LT((force + system.gradient).lpNorm<Eigen::Infinity>(), 1e-10);
    // Known nodes have no equation.
    for (int j = 0; j <= kNy; ++j)
      for (const int i : sample.level.conforming->rows.known(j))
        EXPECT_EQ(sample.level.f.view().x.at(i, j), 0.0);
    sample.scatter(0.01 * VectorXd::Random(force.size()), sample.level.d.view());
    const double after = sample.energy(1.0);
    sample.move();
    const double wanted =
        oracle::assemble(sample.membrane, sample.law, sample.positions(), false).energy;
    EXPECT_NEAR(after - before, wanted - system.energy, 1e-10 * system.energy);
    EXPECT_NE(after, before);
  });
}

TEST(ConformingMembranes, ForceAndHessianAreDerivativesOfTheEnergy) {
  for_samples([](Sample& sample) {
    if ((sample.law.model == "arap" || sample.law.model == "fold-free") &&
        kernels::energy<double>(sample.level.membrane(), {}, 0.0).least_J < sample.law.eps + 0.01)
      return;  // the slope of its one-sided square has a corner
    sample.level.conforming->rows.linearise(sample.level.membrane());
    const VectorXd d = VectorXd::Random(2 * sample.membrane.unknowns);
    const double bend = d.dot(sample.product(d)), slope = -d.dot(sample.force()), h = 1e-4;
    EXPECT_NEAR((sample.energy(h) - sample.energy(-h)) / (2.0 * h), slope, 1e-4 * std::abs(bend));
    EXPECT_NEAR((sample.energy(h) - 2.0 * sample.energy(0.0) + sample.energy(-h)) / (h * h), bend,
                1e-3 * std::abs(bend));
  });
}

TEST(ConformingMembranes, TheHessianIsTheOracles) {
  for_samples([](Sample& sample) {
    for (const bool projected : {false, true}) {
      sample.level.clamp_width = projected ? 1.0 : kNoClamp;
      sample.level.conforming->rows.linearise(sample.level.membrane());
      const Eigen::MatrixXd wanted(
          oracle::assemble(sample.membrane, sample.law, sample.positions(), projected).hessian);
      Eigen::MatrixXd found(wanted.rows(), wanted.cols());
      for (Eigen::Index k = 0; k < found.cols(); ++k)
        found.col(k) = sample.product(VectorXd::Unit(found.cols(), k));
      EXPECT_LT((found - wanted).cwiseAbs().maxCoeff(), 1e-9 * wanted.cwiseAbs().maxCoeff());
      if (!projected) continue;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (found + found.transpose()));
      EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-10);
    }
  });
}

/// Least J of the triangles that have an unknown node.
double least_triangle_J(const Sample& sample) {
  const kernels::SpecialCells<double>& cells = sample.level.conforming->cells;
  const oracle::Positions u = sample.positions() - sample.membrane.rest;
  double least = 1e30;
  for (int j = 0; j < kNy; ++j)
    for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n)
      for (int t = cells.triangle_begin[std::size_t(n)];
           t < cells.triangle_begin[std::size_t(n) + 1]; ++t) {
        const kernels::Triangle<double>& triangle = cells.triangle[std::size_t(t)];
        Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
        bool held = true;
        for (int a = 0; a < 3; ++a) {
          const int v = triangle.vertex[a];
          const int node = v < 4 ? (j + v / 2) * (kNx + 1) + cells.column[std::size_t(n)] + v % 2
                                 : (kNx + 1) * (kNy + 1) + v - 4;
          F += u.row(node).transpose() * Eigen::RowVector2d(triangle.gx[a], triangle.gy[a]);
          held = held && sample.membrane.known[std::size_t(node)];
        }
        if (!held) least = std::min(least, F.determinant());
      }
  return least;
}

TEST(ConformingMembranes, FoldsOfSpecialCellsAreSeen) {
  Sample sample(Model::corotated, 0.0);
  const kernels::SpecialRows<double>& rows = sample.level.conforming->rows;
  auto sums = [&] { return kernels::energy<double>(sample.level.membrane(), {}, 0.0); };
  EXPECT_EQ(sums().inverted_cells, 0.0);
  EXPECT_GT(sums().least_J, 0.0);
  int of_triangles = 0;
  for (int j = 1; j < kNy; ++j)
    for (int k = rows.near_begin(j); k < rows.near_begin(j + 1); ++k)
      for (const double step : {-2.0, 2.0}) {
        double& u = sample.level.ux.view().at(rows.near_node(k).column, j);
        u += step;
        const double least = least_triangle_J(sample), found = sums().least_J;
        EXPECT_LT(found, least + 1e-12);
        of_triangles += std::abs(found - least) < 1e-12;
        u -= step;
      }
  EXPECT_GT(of_triangles, 10);
}

/// Two steps of Chebyshev iteration with the diagonal's blocks on lattice nodes, then Gauss–Seidel
/// on near nodes and curve nodes.
VectorXd relaxed(const Sample& sample, const Eigen::MatrixXd& matrix, const VectorXd& f,
                 double largest) {
  const Eigen::Index half = sample.membrane.unknowns;
  VectorXd d = VectorXd::Zero(2 * half);
  auto solve = [&](Eigen::Index n, const VectorXd& r) -> Eigen::Vector2d {
    Eigen::Matrix2d block;
    block << matrix(n, n), matrix(n, half + n), matrix(half + n, n), matrix(half + n, half + n);
    return (block + 1e-4 * Eigen::Matrix2d::Identity()).inverse() *
           Eigen::Vector2d(r[n], r[half + n]);
  };
  for (const double side : {1.0, -1.0}) {
    const double omega = 1.0 / (largest * (0.625 + side * 0.375 * std::sqrt(0.5)));
    const VectorXd r = f - matrix * d;
    sample.for_unknown([&](int n, int, int) {
      const Eigen::Vector2d step = omega * solve(n, r);
      d[n] += step[0];
      d[half + n] += step[1];
    });
  }
  const kernels::SpecialRows<double>& rows = sample.level.conforming->rows;
  auto relax = [&](Eigen::Index n) {
    const Eigen::Vector2d step = solve(n, f - matrix * d);
    d[n] += step[0];
    d[half + n] += step[1];
  };
  for (const int first : {1, 0})
    for (int j = first; j < kNy; j += 2) {
      for (int k = rows.near_begin(j); k < rows.near_begin(j + 1); ++k)
        relax(sample.membrane.unknown[std::size_t(j * (kNx + 1) + rows.near_node(k).column)]);
      sample.for_soft([&](int n, int c) {
        if (sample.level.conforming->cells.crossing[std::size_t(c)].place == j) relax(n);
      });
    }
  return d;
}

TEST(ConformingMembranes, RelaxationIsThatOfTheAssembledMatrix) {
  for_samples([](Sample& sample) {
    multigrid::Level<double>& level = sample.level;
    level.clamp_width = 1.0;
    level.conforming->rows.linearise(level.membrane());
    multigrid::Solid<double>& solid = level.solid;
    kernels::inverse_blocks<double>(
        level.membrane(), {solid.block[0].view(), solid.block[1].view(), solid.block[2].view()});
    const Eigen::MatrixXd matrix(
        oracle::assemble(sample.membrane, sample.law, sample.positions(), true).hessian);
    const VectorXd f = VectorXd::Random(matrix.rows());
    level.d.clear();
    level.f.clear();
    sample.scatter(f, level.f.view());
    const kernels::LevelSystem<double> system{.membrane = level.membrane(),
                                              .d = level.d.view(),
                                              .f = level.f.view(),
                                              .product = solid.product.view(),
                                              .largest = 2.5};
    kernels::relax<double>(system, {.from_zero = true}, nullptr, nullptr,
                           sample.hierarchy.scratch());
    const VectorXd wanted = relaxed(sample, matrix, f, 2.5);
    EXPECT_LT((sample.gather(level.d.view()) - wanted).lpNorm<Eigen::Infinity>(),
              1e-8 * wanted.lpNorm<Eigen::Infinity>());
  });
}

TEST(ConformingMembranes, CyclesConverge) {
  for (const Model model : models())
    for (const Weights& weights : conforming_scene::kWeights) {
      Sample sample(model, 0.02, kKappa, weights);
      multigrid::Level<double>& level = sample.level;
      const double before = sample.force().norm();
      level.clamp_width = 1.0;
      multigrid::Cycle<double> cycle(sample.hierarchy, 0, true, 1.0);
      for (int n = 0; n < 6; ++n) cycle.run(multigrid::CycleKind::v, n == 0);
      const double left =
          std::sqrt(kernels::residual_norm2<double>(cycle.system(0), sample.hierarchy.scratch()));
      EXPECT_LT(left, std::pow(0.35, 6) * before)
          << name(model) << ", circle " << weights.circle << ": " << left / before;
    }
}

TEST(ConformingMembranes, EveryInstructionSetHasTheSameBits) {
  const kernels::Isa chosen = kernels::current_isa();
  for (const Model model : models()) {
    VectorXd first;
    for (const kernels::Isa isa : kernels::available_isas()) {
      kernels::use_isa(isa);
      // arap: with corner pressures
      Sample sample(model, 0.1, 100.0, conforming_scene::kWeights[1]);
      multigrid::Level<double>& level = sample.level;
      std::ranges::fill(level.conforming->shift, -0.05);
      level.solid.law.onset = 0.1;
      const VectorXd force = sample.force();
      multigrid::Cycle<double> cycle(sample.hierarchy, 0, true, 1.0);
      cycle.run(multigrid::CycleKind::v, true);
      VectorXd all(2 * force.size() + 1);
      all << force, sample.gather(level.d.view()), sample.energy(0.25);
      if (first.size() == 0) first = all;
      EXPECT_TRUE(all == first) << name(model) << ", " << kernels::name(isa);
    }
  }
  kernels::use_isa(chosen);
}

TEST(ConformingMembranes, PressuresOfTrianglesReachTheFixedPointOfThePenaltyAskedFor) {
  Sample sample(Model::arap, 0.4, 50.0);
  multigrid::Level<double>& level = sample.level;
  std::vector<double>& shift = level.conforming->shift;
  auto& planes = level.solid.shift;
  ASSERT_EQ(shift.size(), level.conforming->cells.triangle.size());
  level.solid.law.relief = 25.0;
  for (int n = 0; n < 100; ++n)
    kernels::update_corner_pressure<double>(
        level.membrane(), {planes[0].view(), planes[1].view(), planes[2].view(), planes[3].view()},
        shift.data());
  // The stress of the softened term with its pressures is then that of Eq. 8 itself.
  level.solid.law.onset = 0.0;
  const VectorXd force = sample.force();
  const oracle::MembraneSystem system =
      oracle::assemble(sample.membrane, sample.law, sample.positions(), false);
  EXPECT_LT((force + system.gradient).lpNorm<Eigen::Infinity>(),
            1e-8 * system.gradient.lpNorm<Eigen::Infinity>());
  EXPECT_LT(*std::ranges::min_element(shift), -0.5);
}

}  // namespace
}  // namespace drumhead
