// SPDX-License-Identifier: MIT
// Scenes that follow one another, edited at random: what CurveConformer and CurveCutter keep gives
// the cells that the curves alone give, to the last bit, and moved targets leave the cells as they
// are.
#include <algorithm>
#include <utility>

#include <drumhead/grid/conforming.h>
#include <drumhead/grid/cut_cells.h>
#include <gtest/gtest.h>

#include "support/random_curves.h"

namespace drumhead::grid {
namespace {

constexpr int kLevels = 3, kEdits = 6;
constexpr unsigned kScenes = 300;

bool same(const HeldNode& a, const HeldNode& b) {
  return a.rest == b.rest && a.wanted == b.wanted && a.stiffness == b.stiffness;
}
bool same(const HeldConflict& a, const HeldConflict& b) {
  return a.rest == b.rest && a.distance == b.distance && a.curve == b.curve &&
         a.other_curve == b.other_curve;
}
bool same(const PartTriangle& a, const PartTriangle& b) {
  return a.node == b.node && a.area == b.area && a.gradient == b.gradient;
}
template <class Value>
bool same(const std::vector<Value>& a, const std::vector<Value>& b) {
  return std::ranges::equal(a, b, [](const Value& p, const Value& q) { return same(p, q); });
}
bool same(const ConformingCells& a, const ConformingCells& b) {
  return a.node_begin == b.node_begin && a.node_column == b.node_column && same(a.node, b.node) &&
         same(a.curve_node, b.curve_node) && a.cell_begin == b.cell_begin &&
         a.cell_column == b.cell_column && a.part_begin == b.part_begin &&
         a.part_node == b.part_node && same(a.triangle, b.triangle) && a.part_area == b.part_area &&
         same(a.conflicts, b.conflicts);
}

/// A random edit; true: of a target alone.
bool edit(RandomCurves& random, std::vector<CurvePair>& curves) {
  const std::size_t k = std::size_t(random.whole(0, int(curves.size()) - 1));
  switch (random.whole(0, 5)) {
    case 0:
      curves.push_back(random.any());
      return false;
    case 1:
      if (curves.size() > 1) curves.erase(curves.begin() + std::ptrdiff_t(k));
      return false;
    case 2:
      curves[k] = random.parallel(curves[k]);
      return false;
    default: {
      std::vector<CubicBezier>& target = curves[k].target;
      CubicBezier& segment = target[std::size_t(random.whole(0, int(target.size()) - 1))];
      Point& p = segment.control[std::size_t(random.whole(0, 3))];
      p = p + Point{random.number(-2.0, 2.0), random.number(-2.0, 2.0)};
      return true;
    }
  }
}

struct EditedScene {
  explicit EditedScene(unsigned seed)
      : lattice{.nx = 9 + int(seed % 9), .ny = 9 + int(seed / 9 % 7)},
        random(seed, lattice.nx, lattice.ny),
        curves(random.scene(false)) {}
  Lattice lattice;
  RandomCurves random;
  std::vector<CurvePair> curves;
};

TEST(EditedCurves, ConformAsTheyDoAnew) {
  int kept = 0, conflicts = 0;
  for (unsigned seed = 1; seed <= kScenes; ++seed) {
    EditedScene scene(seed);
    CurveConformer conformer(scene.lattice, kLevels);
    std::vector<ConformingCells> cells = conformer.conform(scene.curves);
    for (int n = 0; n < kEdits; ++n) {
      const bool targets_alone = edit(scene.random, scene.curves);
      std::vector<ConformingCells> again = conformer.conform(scene.curves);
      EXPECT_TRUE(again.empty() || !targets_alone) << "seed " << seed;
      if (again.empty()) {
        ++kept;
        for (int l = 0; l < kLevels; ++l) conformer.retarget(l, cells[std::size_t(l)]);
      } else {
        cells = std::move(again);
      }
      const std::vector<ConformingCells> anew =
          conform_levels(scene.curves, scene.lattice, kLevels);
      for (std::size_t l = 0; l < std::size_t(kLevels); ++l) {
        ASSERT_TRUE(same(cells[l], anew[l])) << "seed " << seed << " edit " << n << " level " << l;
        conflicts += int(anew[l].conflicts.size());
      }
    }
  }
  EXPECT_GT(kept, int(kScenes));
  EXPECT_GT(conflicts, 0);
}

TEST(EditedCurves, AreCutAsTheyAreAnew) {
  for (unsigned seed = 1; seed <= kScenes; ++seed) {
    EditedScene scene(seed);
    CurveCutter cutter(scene.lattice, 1e6);
    for (int n = 0; n < kEdits; ++n) {
      const CutCells again = cutter.cut(scene.curves), anew = cut(scene.curves, scene.lattice, 1e6);
      ASSERT_EQ(again.row_begin, anew.row_begin) << "seed " << seed << " edit " << n;
      ASSERT_EQ(again.column, anew.column);
      ASSERT_EQ(again.weight, anew.weight);
      ASSERT_EQ(again.length, anew.length);
      ASSERT_EQ(again.wanted, anew.wanted);
      ASSERT_EQ(again.compliance, anew.compliance);
      ASSERT_EQ(again.link_begin, anew.link_begin);
      ASSERT_EQ(again.link, anew.link);
      edit(scene.random, scene.curves);
    }
  }
}

}  // namespace
}  // namespace drumhead::grid
