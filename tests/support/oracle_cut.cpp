// SPDX-License-Identifier: MIT
#include "oracle_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace drumhead::oracle {
namespace {

using Eigen::Vector2d;
using CellIndex = std::pair<int, int>;  // (j, i)

double snapped(double value) {
  const double line = std::round(value);
  return std::abs(value - line) < kSnapCells ? line : value;
}

// Integrals along an arc that stays in one cell.
struct Arc {
  CellIndex cell{};
  double length = 0.0;
  std::array<double, 4> weight{};  // times length
  Vector2d target{0.0, 0.0};       // times length

  void add(const Arc& other) {
    length += other.length;
    for (int k = 0; k < 4; ++k) weight[std::size_t(k)] += other.weight[std::size_t(k)];
    target += other.target;
  }
};

// The chord piece a → b, which does not cross a lattice line. The cell is that of its midpoint; a
// piece on a lattice line goes to the cell of the larger index, which makes no difference to its
// weights.
Arc integrate(Vector2d a, Vector2d b, Vector2d target_a, Vector2d target_b, int n) {
  const Vector2d middle = 0.5 * (a + b);
  const int i = std::clamp(int(std::floor(middle.x())), 0, n - 1);
  const int j = std::clamp(int(std::floor(middle.y())), 0, n - 1);
  Arc arc;
  arc.cell = {j, i};
  arc.length = (b - a).norm();
  const auto add_weights = [&](Vector2d point, double share) {
    const double s = point.x() - i, t = point.y() - j;
    arc.weight[0] += share * arc.length * (1.0 - s) * (1.0 - t);
    arc.weight[1] += share * arc.length * s * (1.0 - t);
    arc.weight[2] += share * arc.length * (1.0 - s) * t;
    arc.weight[3] += share * arc.length * s * t;
  };
  add_weights(a, 1.0 / 6.0);
  add_weights(middle, 4.0 / 6.0);
  add_weights(b, 1.0 / 6.0);
  arc.target = 0.5 * arc.length * (target_a + target_b);
  return arc;
}

// Parameters in (0, 1) at which a + t (b − a) lies on a line of integer coordinate.
void add_crossings(double a, double b, std::vector<double>& at) {
  const auto [low, high] = std::minmax(a, b);
  for (double line = std::floor(low) + 1.0; line < high; line += 1.0) {
    at.push_back((line - a) / (b - a));
  }
}

// The curve as its arcs, one for every stay in a cell, in order.
std::vector<Arc> arcs_of(const scenes::Polyline& curve, int n) {
  std::vector<Arc> arcs;
  for (std::size_t k = 1; k < curve.source.size(); ++k) {
    const auto corner = [&](std::size_t m) {
      return Vector2d(snapped(n * curve.source[m].x()), snapped(n * curve.source[m].y()));
    };
    const Vector2d a = corner(k - 1), b = corner(k);
    const Vector2d target_a = n * curve.target[k - 1], target_b = n * curve.target[k];
    std::vector<double> at{0.0, 1.0};
    add_crossings(a.x(), b.x(), at);
    add_crossings(a.y(), b.y(), at);
    std::sort(at.begin(), at.end());
    const auto along = [](Vector2d from, Vector2d to, double t) {
      return Vector2d((1.0 - t) * from + t * to);
    };
    for (std::size_t m = 1; m < at.size(); ++m) {
      const Arc arc =
          integrate(along(a, b, at[m - 1]), along(a, b, at[m]),
                    along(target_a, target_b, at[m - 1]), along(target_a, target_b, at[m]), n);
      if (arc.length == 0.0) continue;
      if (arcs.empty() || arcs.back().cell != arc.cell) {
        arcs.push_back(arc);
      } else {
        arcs.back().add(arc);
      }
    }
  }
  return arcs;
}

bool closed(const scenes::Polyline& curve) { return curve.source.front() == curve.source.back(); }

// A closed curve that starts inside a cell: its first and last arc are one.
void join_ends(std::vector<Arc>& arcs) {
  if (arcs.size() > 1 && arcs.front().cell == arcs.back().cell) {
    arcs.front().add(arcs.back());
    arcs.pop_back();
  }
}

double interior_weight(const Arc& total, int n) {
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int i = total.cell.second + k % 2, j = total.cell.first + k / 2;
    if (i > 0 && i < n && j > 0 && j < n) sum += total.weight[std::size_t(k)] / total.length;
  }
  return sum;
}

}  // namespace

Cuts cut(const scenes::Scene& scene, int n) {
  std::map<CellIndex, Arc> totals;
  std::vector<CellIndex> order;                        // cells as first entered
  std::vector<std::pair<CellIndex, CellIndex>> steps;  // from cell to cell along a curve
  for (const scenes::Polyline& curve : scene.curves) {
    std::vector<Arc> arcs = arcs_of(curve, n);
    if (closed(curve)) join_ends(arcs);
    std::erase_if(arcs, [](const Arc& arc) { return arc.length < kShortestArc; });
    for (std::size_t k = 0; k < arcs.size(); ++k) {
      const auto [place, is_new] = totals.try_emplace(arcs[k].cell, arcs[k]);
      if (is_new) {
        order.push_back(arcs[k].cell);
      } else {
        place->second.add(arcs[k]);
      }
      if (k > 0) steps.emplace_back(arcs[k - 1].cell, arcs[k].cell);
    }
    if (closed(curve) && arcs.size() > 1) steps.emplace_back(arcs.back().cell, arcs.front().cell);
  }
  Cuts cuts;
  std::map<CellIndex, int> row_of;
  for (const CellIndex& cell : order) {
    const Arc& total = totals.at(cell);
    if (interior_weight(total, n) < kLeastInteriorWeight) continue;
    CutRow row{cell.second, cell.first, total.weight, total.target / total.length, total.length};
    for (double& weight : row.weight) weight /= total.length;
    row_of[cell] = int(cuts.rows.size());
    cuts.rows.push_back(row);
  }
  std::set<std::pair<int, int>> pairs;
  for (const auto& [from, to] : steps) {
    if (from == to || !row_of.count(from) || !row_of.count(to)) continue;
    pairs.insert(std::minmax(row_of[from], row_of[to]));
  }
  cuts.neighbours.assign(pairs.begin(), pairs.end());
  return cuts;
}

}  // namespace drumhead::oracle
