// SPDX-License-Identifier: MIT
#include "held_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace drumhead::grid {
namespace {

// Displacements that differ by more than this many times the distance of their points contradict
// one another: no lattice of this spacing can carry such a strain.
constexpr double kStrain = 3.0;
constexpr double kLeastConflict = 1e-6;  // cells

class Holder {
 public:
  Holder(const std::vector<Visit>& visits, const std::vector<double>& weights,
         const Lattice& lattice, std::vector<HeldConflict>& conflicts)
      : visits_(visits), weights_(weights), lattice_(lattice), conflicts_(conflicts) {}

  /// The node at `rest` that a group of visits asks for; `fixed`: it lies on the outer boundary.
  HeldNode held(Point rest, const std::vector<int>& visits, bool fixed);

 private:
  const std::vector<Visit>& visits_;
  const std::vector<double>& weights_;
  const Lattice& lattice_;
  std::vector<HeldConflict>& conflicts_;
};

HeldNode Holder::held(Point rest, const std::vector<int>& visits, bool fixed) {
  auto visit = [&](int n) -> const Visit& { return visits_[std::size_t(n)]; };
  auto stiffness = [&](int n) {
    const double d = weights_[std::size_t(visit(n).curve)];
    return d * (lattice_.cell_px / lattice_.side_px) * visit(n).arc;
  };
  auto hard = [&](int n) { return std::isinf(weights_[std::size_t(visit(n).curve)]); };
  const bool any_hard = fixed || std::ranges::any_of(visits, hard);
  int nearest = -1;
  for (const int n : visits)
    if ((hard(n) || !any_hard || fixed) &&
        (nearest < 0 || length(visit(n).source - rest) < length(visit(nearest).source - rest)))
      nearest = n;
  const Visit& first = visit(nearest);
  const Point base = fixed ? Point{} : first.displacement;
  const Visit* worst = nullptr;
  double largest = 0.0, total = 0.0, weight = 0.0;
  Point mean;
  for (const int n : visits) {
    const double distance = length(visit(n).displacement - base);
    const double apart = length(visit(n).source - (fixed ? rest : first.source));
    const bool against = distance > kStrain * apart + kLeastConflict;
    if (against && distance > largest) {
      largest = distance;
      worst = &visit(n);
    }
    if (any_hard && !hard(n)) continue;
    const double w = any_hard ? 1.0 : stiffness(n);
    total += w;
    weight += w;
    // A branch that agrees says the same as the nearest one, which lies on the node.
    mean = mean + w * (against ? visit(n).displacement : base);
  }
  if (worst != nullptr) conflicts_.push_back({rest, largest, first.curve, worst->curve});
  HeldNode node{rest, base, any_hard ? std::numeric_limits<double>::infinity() : total};
  if (!fixed && weight > 0.0) node.wanted = (1.0 / weight) * mean;
  return node;
}

}  // namespace

NodeVisits::NodeVisits(std::vector<Visit> of_all)
    : visits(std::move(of_all)), order(visits.size()) {
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int n) { return visits[std::size_t(n)].vertex; });
}

void NodeVisits::retarget(const CurveWalks& walks) {
  for (Visit& visit : visits) {  // those on a chord come after its ends
    if (visit.event >= 0) {
      const CurveEvent& event = walks[std::size_t(visit.curve)]->events[std::size_t(visit.event)];
      visit.displacement = event.target - event.source;
    } else {
      visit.displacement = (1.0 - visit.share) * visits[std::size_t(visit.from)].displacement +
                           visit.share * visits[std::size_t(visit.to)].displacement;
    }
  }
}

void hold_nodes(const NodeVisits& of_all, const std::vector<double>& weights,
                const Lattice& lattice, ConformingCells& cells) {
  const std::vector<Visit>& visits = of_all.visits;
  const Vertex columns = lattice.nx + 1, first_curve_node = columns * (lattice.ny + 1);
  cells.conflicts.clear();
  Holder holder(visits, weights, lattice, cells.conflicts);
  std::vector<int> group;
  for (std::size_t n = 0; n < of_all.order.size();) {
    const Vertex at = visits[std::size_t(of_all.order[n])].vertex;
    for (group.clear(); n < of_all.order.size(); ++n) {
      if (visits[std::size_t(of_all.order[n])].vertex != at) break;
      group.push_back(of_all.order[n]);
    }
    if (at >= first_curve_node) {
      HeldNode& node = cells.curve_node[std::size_t(at - first_curve_node)];
      const Point rest = node.rest;
      const bool fixed =
          rest.x == 0.0 || rest.y == 0.0 || rest.x == lattice.nx || rest.y == lattice.ny;
      node = holder.held(rest, group, fixed);
      continue;
    }
    const int i = int(at % columns), j = int(at / columns), k = cells.find_node(i, j);
    if (k < 0)  // a boundary node, which is fixed anyway
      holder.held({double(i), double(j)}, group, true);
    else
      cells.node[std::size_t(k)] = holder.held(cells.node[std::size_t(k)].rest, group, false);
  }
}

}  // namespace drumhead::grid
