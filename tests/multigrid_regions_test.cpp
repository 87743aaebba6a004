// SPDX-License-Identifier: MIT
// Regions between known nodes: how many there are, that a constant pressure in one is a force on
// nothing, and the means that this prescribes.
#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>

#include "hierarchy.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

using multigrid::Level;
using multigrid::Regions;

struct Scene {
  grid::MemoryMeter meter;
  multigrid::Hierarchy<double> hierarchy;
  Level<double>& level;

  explicit Scene(const multigrid::WarpProblem& problem)
      : hierarchy(problem.lattice, problem.material, grid::cut({}, problem.lattice, 1e6), {},
                  meter),
        level(hierarchy[0]) {
    hierarchy.conform(problem.curves, problem.lattice, meter);
  }
  Scene(const scenes::Scene& scene, int n, double kappa)
      : Scene(scenes::problem(scene, n, kappa)) {}
  Regions& regions() { return level.conforming->regions; }
  /// Σ of the volume rows of a vector.
  double sum(const kernels::Unknowns<double>& v) const {
    double total = 0.0;
    for (int j = 0; j < v.p.rows; ++j)
      for (int i = 0; i < v.p.columns; ++i)
        if (level.conforming->geometry.find_cell(i, j) < 0) total += v.p.at(i, j);
    for (int p = 0; p < v.listed_count; ++p) total += v.listed[p];
    return total;
  }
  /// Volume rows that differ from cell to cell.
  void fill_right_hand_side() const {
    const auto f = level.f.view();
    for (int j = 0; j < f.p.rows; ++j)
      for (int i = 0; i < f.p.columns; ++i) f.p.at(i, j) = (i * 7 + j * 13) % 11 - 3.0;
    for (int p = 0; p < f.listed_count; ++p) f.listed[p] = p % 5 - 1.0;
  }
};

/// A square along lattice lines: no cell is cut, no node moves.
multigrid::WarpProblem square_on_lattice_lines() {
  multigrid::WarpProblem problem = scenes::problem(scenes::shift(), 16, 10.0);
  grid::CurvePair square{.name = "square"};
  const grid::Point corner[] = {{.25, .25}, {.75, .25}, {.75, .625}, {.25, .625}, {.25, .25}};
  for (int k = 0; k < 4; ++k) square.source.push_back(grid::straight(corner[k], corner[k + 1]));
  square.target = square.source;
  problem.curves = {square};
  return problem;
}

TEST(Regions, AreCountedOnEveryLevel) {
  const double offset = scenes::kStudyOffset;
  for (const auto& [scene, count] : {std::pair{scenes::sponge(offset), 1},
                                     {scenes::roundabout(90.0, offset), 3},
                                     {scenes::shift(offset), 2}}) {
    Scene levels(scene, 64, 10.0);
    for (int l = 0; l < 3; ++l)
      EXPECT_EQ(levels.hierarchy[l].conforming->regions.count(), count) << scene.name << l;
  }
}

TEST(Regions, EndAtCurvesAlongLatticeLines) {
  Scene scene(square_on_lattice_lines());
  EXPECT_EQ(scene.level.conforming->geometry.cells(), 0);
  EXPECT_EQ(scene.regions().count(), 2);
}

TEST(Regions, AreSetToTheMeansThatVolumeRowsAskFor) {
  for (const double variation : {0.0, 0.5}) {
    multigrid::WarpProblem problem =
        scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), 32, 10.0);
    for (int c = 0; c < 32 * 32 && variation > 0.0; ++c)
      problem.material.kappa_cells.push_back(float(10.0 + variation * (c % 17)));
    Scene scene(problem);
    const kernels::Membrane<double> membrane = scene.level.membrane();
    scene.level.conforming->rows.linearise(membrane);
    scene.regions().prepare(membrane);
    scene.fill_right_hand_side();
    const auto f = scene.level.f.view(), d = scene.level.d.view();
    scene.regions().keep_sums(f);
    const double wanted = scene.sum(f);
    scene.level.d.clear();
    scene.regions().set_means(membrane, d);
    kernels::apply_hessian<double>(membrane, d, f);
    EXPECT_GT(std::abs(d.p.at(16, 16) - d.p.at(0, 0)), 1.0);
    EXPECT_NEAR(scene.sum(f), wanted, 1e-9 * std::abs(wanted));
    EXPECT_LT(std::sqrt(kernels::dot<double>(f.x, f.x)), 1e-9);
    EXPECT_LT(std::sqrt(kernels::dot<double>(f.y, f.y)), 1e-9);

    // Sums that were removed ask for means of 0.
    scene.fill_right_hand_side();
    scene.regions().remove_sums(membrane, f);
    EXPECT_NEAR(scene.sum(f), 0.0, 1e-9);
    scene.regions().set_means(membrane, d);
    EXPECT_LT(std::sqrt(kernels::dot<double>(d.p, d.p)), 1e-9);
  }
}

}  // namespace
}  // namespace drumhead
