// SPDX-License-Identifier: MIT
#pragma once
// What the curves that go through a node ask of it together (rule 6 of conforming.h).
#include <vector>

#include <drumhead/grid/conforming.h>

#include "curve_nodes.h"

namespace drumhead::grid {

/// The visits of the curves and the order of their nodes, ascending.
struct NodeVisits {
  std::vector<Visit> visits;
  std::vector<int> order;

  NodeVisits() = default;
  explicit NodeVisits(std::vector<Visit> of_all);
  /// Takes displacements from the events of the same curves with other targets.
  void retarget(const CurveWalks& walks);
};

/// Sets wanted displacement and stiffness of all held nodes, which are in their places, and the
/// conflicts between them. `weights`: d of each curve.
void hold_nodes(const NodeVisits& visits, const std::vector<double>& weights,
                const Lattice& lattice, ConformingCells& cells);

}  // namespace drumhead::grid
