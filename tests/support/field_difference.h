// SPDX-License-Identifier: MIT
#pragma once
// How far the solver's lattice is from another one, node by node, in cells.
#include <algorithm>
#include <cmath>

#include <drumhead/multigrid/warp.h>

#include "oracle_system.h"

namespace drumhead::oracle {

struct FieldDifference {
  double rms = 0.0, max = 0.0;  ///< over all nodes, |x − x'| in cells
};

/// Solution on the unit square against an oracle state of the same lattice.
inline FieldDifference difference(const multigrid::Solution& solution, const State& state) {
  const int n = solution.lattice.nx;
  const double h = solution.lattice.cell_px;
  FieldDifference result;
  double sum = 0.0;
  for (int node = 0; node < state.x.size(); ++node) {
    const double dx = node % (n + 1) + solution.u_px[std::size_t(node)] / h - state.x[node];
    const double dy = node / (n + 1) + solution.v_px[std::size_t(node)] / h - state.y[node];
    sum += dx * dx + dy * dy;
    result.max = std::max(result.max, std::hypot(dx, dy));
  }
  result.rms = std::sqrt(sum / double(state.x.size()));
  return result;
}

/// The solution as a state of the oracle, with q = 0: Newton's step does not depend on the q it
/// starts from.
inline State state_of(const OracleScene& scene, const multigrid::Solution& solution) {
  State state = rest(scene);
  for (Eigen::Index node = 0; node < state.x.size(); ++node) {
    state.x[node] += solution.u_px[std::size_t(node)] / solution.lattice.cell_px;
    state.y[node] += solution.v_px[std::size_t(node)] / solution.lattice.cell_px;
  }
  for (std::size_t cell = 0; cell < solution.pressure.size(); ++cell) {
    state.P[Eigen::Index(cell)] = solution.pressure[cell];
  }
  return state;
}

/// Two solutions of the solver on the unit square, the second on a lattice `ratio` times finer,
/// compared at the nodes of the first and in its cells.
inline FieldDifference difference(const multigrid::Solution& coarse,
                                  const multigrid::Solution& fine, int ratio) {
  const int n = coarse.lattice.nx;
  const double h = coarse.lattice.cell_px;
  FieldDifference result;
  double sum = 0.0;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const auto at = std::size_t(j * (n + 1) + i);
      const auto there = std::size_t(j * ratio * (n * ratio + 1) + i * ratio);
      const double distance =
          std::hypot(coarse.u_px[at] - fine.u_px[there], coarse.v_px[at] - fine.v_px[there]) / h;
      sum += distance * distance;
      result.max = std::max(result.max, distance);
    }
  }
  result.rms = std::sqrt(sum / double((n + 1) * (n + 1)));
  return result;
}

}  // namespace drumhead::oracle
