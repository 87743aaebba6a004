// SPDX-License-Identifier: MIT
// The rows of all parts of special cells relaxed at once: they are met, by the step of Kaczmarz's
// method weighted by the diagonal.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/parts.h>

#include "conforming_visits.h"
#include "cycle.h"
#include "part_patch.h"
#include "support/newton_level.h"
#include "support/scene_problem.h"

namespace drumhead {
namespace {

using multigrid::Level;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

/// A roundabout with random corrections and right-hand sides on two levels.
class PartPatch : public testing::TestWithParam<double> {
 protected:
  PartPatch() {
    problem_.curves[0].weight = GetParam();
    hierarchy_.conform(problem_.curves, problem_.lattice, meter_);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    auto fill = [&](std::vector<double>& values) {
      std::ranges::generate(values, [&] { return value(random); });
    };
    for (const int l : {0, 1}) {
      Level<double>& level = hierarchy_[l];
      for (int j = 1; j < level.ny; ++j)
        for (int i = 1; i < level.nx; ++i)
          if (!multigrid::is_known(level.conforming->geometry, i, j)) {
            level.d.x.view().at(i, j) = value(random);
            level.d.y.view().at(i, j) = value(random);
          }
      fill(level.d.listed);
      fill(level.f.listed);
      const kernels::SpecialCells<double>& cells = level.conforming->cells;
      for (std::size_t n = 0; n < level.d.curve.size(); ++n)
        if (!cells.crossing[n / 2].known()) level.d.curve[n] = value(random);
    }
  }

  static std::vector<double> residual(const kernels::LevelSystem<double>& system) {
    std::vector<double> r(std::size_t(system.membrane.special->cells().parts()));
    kernels::parts_residual(system, r.data());
    return r;
  }

  multigrid::WarpProblem problem_ =
      scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), 64, 1e4);
  grid::MemoryMeter meter_;
  multigrid::Hierarchy<double> hierarchy_{problem_.lattice,
                                          problem_.material,
                                          grid::cut({}, problem_.lattice, 1e6),
                                          {.stiffness = 1e4},
                                          meter_};
};

TEST_P(PartPatch, MeetsTheRowsOfAllParts) {
  multigrid::Cycle<double> cycle(hierarchy_, 0, true, 1.0);
  for (const int l : {0, 1}) {  // without and with the jump between pressures
    const kernels::LevelSystem<double> system = cycle.system(l);
    EXPECT_EQ(system.membrane.special->has_jumps(), l == 1);
    const double before = largest(residual(system));
    multigrid::PartPatch<double>(system, meter_).relax(system);
    // The shift of the block's diagonal leaves up to 6e-5.
    EXPECT_LT(largest(residual(system)), 1e-3 * before) << "level " << l;
  }
}

// From 0, K_ii d_i = −(force of the pressures)_i.
TEST_P(PartPatch, MovesNodesByThePressuresForceOverTheDiagonal) {
  multigrid::Cycle<double> cycle(hierarchy_, 0, true, 1.0);
  const kernels::LevelSystem<double> system = cycle.system(0);
  Level<double>& level = hierarchy_[0];
  level.d.clear();
  multigrid::PartPatch<double>(system, meter_).relax(system);
  grid::UnknownFields<double> pressures(level.nx, level.ny, true, meter_),
      image(level.nx, level.ny, true, meter_);
  pressures.listed = level.d.listed;
  image.listed.resize(level.d.listed.size());
  pressures.curve.assign(level.d.curve.size(), 0.0);
  image.curve = pressures.curve;
  kernels::apply_hessian<double>(system.membrane, pressures.view(), image.view());
  const kernels::SpecialRows<double>& rows = *system.membrane.special;
  double moved = 0.0;
  for (int j = 1; j < level.ny; ++j)
    for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
      const int i = rows.near_node(n).column;
      const double dx = level.d.x.view().at(i, j), dy = level.d.y.view().at(i, j),
                   inverse = rows.near(n).inverse;
      EXPECT_NEAR(dx, -inverse * image.x.view().at(i, j), 1e-9 * (1.0 + std::abs(dx)));
      EXPECT_NEAR(dy, -inverse * image.y.view().at(i, j), 1e-9 * (1.0 + std::abs(dy)));
      moved = std::max(moved, std::abs(dx));
    }
  EXPECT_GT(moved, 0.1);
}

INSTANTIATE_TEST_SUITE_P(HardAndSoft, PartPatch, testing::Values(kInfinite, 100.0));

TEST(PartPatchMemory, IsGivenBack) {
  grid::MemoryMeter meter;
  const multigrid::WarpProblem problem = scenes::problem(scenes::shift(), 32, 1e4);
  multigrid::Hierarchy<float> hierarchy(problem.lattice, problem.material,
                                        grid::cut({}, problem.lattice, 1e6), {}, meter);
  hierarchy.conform(problem.curves, problem.lattice, meter);
  multigrid::Cycle<float> cycle(hierarchy, 0, true, 1.0f);
  const std::size_t before = meter.current();
  {
    multigrid::PartPatch<float> patch(cycle.system(0), meter);
    EXPECT_GT(meter.current(), before);
    const multigrid::PartPatch<float> moved = std::move(patch);
  }
  EXPECT_EQ(meter.current(), before);
}

}  // namespace
}  // namespace drumhead
