// SPDX-License-Identifier: MIT
#include "curve_nodes.h"

#include <algorithm>
#include <cmath>

namespace drumhead::grid {
namespace {

// A tip or corner moves an inner node by at most this along each axis.
constexpr double kFarthestTip = 0.75;
// A crossing moves it by at most this; beyond, a simplified cell holds the node in its place.
constexpr double kFarthestCrossing = 0.5;
// A node that would move by less than this stays at rest.
constexpr double kStill = 1e-6;
// Nodes of the outer boundary take over crossings nearer than this.
constexpr double kBoundaryReach = 0.05;

/// One event of one curve and the node it ends at.
struct Placed {
  const CurveEvent* event;
  int curve;
  Vertex vertex = -1;  // −1: lost
};

/// An event that wants to move a lattice node; the least one wins.
struct Claim {
  Vertex node;
  int rank;  // hard before soft, tips before crossings
  double distance;
  int event;
  friend auto operator<=>(const Claim&, const Claim&) = default;
};

class Placer {
 public:
  Placer(const CurveWalks& walks, const std::vector<double>& weights, const Lattice& lattice,
         double snap, const SimplifiedCells& simplified)
      : walks_(walks),
        weights_(weights),
        nx_(lattice.nx),
        ny_(lattice.ny),
        snap_(snap),
        simplified_(simplified) {
    std::size_t count = 0;
    for (const CurveWalk* walk : walks) count += walk->events.size();
    events_.reserve(count);
    nodes_.visits.reserve(count);
    nodes_.chords.reserve(count);
    for (std::size_t c = 0; c < walks.size(); ++c)
      for (const CurveEvent& event : walks[c]->events) events_.push_back({&event, int(c)});
  }

  CurveNodes run() {
    for (std::size_t n = 0; n < events_.size(); ++n)
      if (events_[n].event->edge == kNoEdge)
        claim_by_tip(int(n));
      else
        claim_by_crossing(int(n));
    move_nodes();
    place_crossings();
    std::size_t first = 0;
    for (std::size_t c = 0; c < walks_.size(); ++c) {
      follow(int(c), first);
      first += walks_[c]->events.size();
    }
    return std::move(nodes_);
  }

 private:
  Vertex lattice_node(int i, int j) const { return Vertex(j) * (nx_ + 1) + i; }
  int column(Vertex node) const { return int(node % (nx_ + 1)); }
  int row(Vertex node) const { return int(node / (nx_ + 1)); }
  bool inner(Vertex node) const {
    const int i = column(node), j = row(node);
    return i > 0 && i < nx_ && j > 0 && j < ny_;
  }
  Point rest_of_lattice(Vertex node) const { return {double(column(node)), double(row(node))}; }
  bool hard(int event) const {
    return std::isinf(weights_[std::size_t(events_[std::size_t(event)].curve)]);
  }
  Simplified simplified(int i, int j) const {
    if (simplified_.empty()) return Simplified::no;
    const auto found = simplified_.find(std::int64_t(j) * nx_ + i);
    return found == simplified_.end() ? Simplified::no : found->second;
  }
  /// The most simplified cell around an inner node.
  Simplified around(Vertex node) const {
    const int i = column(node), j = row(node);
    return std::max(
        {simplified(i - 1, j - 1), simplified(i, j - 1), simplified(i - 1, j), simplified(i, j)});
  }
  /// The more simplified of the cells on both sides of an edge.
  Simplified beside(EdgeIndex edge) const {
    if (simplified_.empty()) return Simplified::no;
    const Vertex node = edge / 2;
    const int i = column(node), j = row(node), di = edge % 2 ? 1 : 0, dj = 1 - di;
    Simplified most = Simplified::no;
    if (i < nx_ && j < ny_) most = simplified(i, j);
    if (i >= di && j >= dj) most = std::max(most, simplified(i - di, j - dj));
    return most;
  }
  Vertex other_end(EdgeIndex edge) const { return edge / 2 + (edge % 2 ? nx_ + 1 : 1); }

  void claim_by_tip(int n);
  void claim_by_crossing(int n);
  void move_nodes();
  void place_crossings();
  Vertex taken_over(const CurveEvent& event) const;
  void place_curve_nodes(std::vector<int>& free);
  void follow(int curve, std::size_t first);
  Point rest(Vertex vertex) const;

  const CurveWalks& walks_;
  const std::vector<double>& weights_;
  int nx_, ny_;
  double snap_;
  const SimplifiedCells& simplified_;
  std::vector<Placed> events_;
  std::vector<Claim> claims_;
  std::vector<int> claiming_;     // event that moved each held node
  std::map<Vertex, Point> tips_;  // nodes promised to a tip or corner
  CurveNodes nodes_;
};

void Placer::claim_by_tip(int n) {
  const CurveEvent& event = *events_[std::size_t(n)].event;
  Claim best{-1, hard(n) ? 0 : 2, INFINITY, n};
  for (int corner = 0; corner < 4; ++corner) {
    const Vertex node = lattice_node(event.after.i + (corner & 1), event.after.j + (corner >> 1));
    if (!inner(node) || around(node) >= Simplified::without_tips) continue;
    const auto promised = tips_.find(node);
    if (promised != tips_.end() && length(promised->second - event.source) > snap_) continue;
    const Point offset = event.source - rest_of_lattice(node);
    if (std::max(std::abs(offset.x), std::abs(offset.y)) > kFarthestTip) continue;
    const double distance = length(offset);
    if (distance < best.distance) {
      best.distance = distance;
      best.node = node;
    }
  }
  if (best.node < 0) {
    nodes_.lost_tips.push_back(event.source);
    return;
  }
  tips_.emplace(best.node, event.source);
  events_[std::size_t(n)].vertex = best.node;
  claims_.push_back(best);
}

void Placer::claim_by_crossing(int n) {
  const CurveEvent& event = *events_[std::size_t(n)].event;
  const bool first = event.along <= 0.5;
  const double distance = first ? event.along : 1.0 - event.along;
  const bool must = beside(event.edge) >= Simplified::without_curve_nodes;
  if (distance > snap_ && !must) return;
  const Vertex a = event.edge / 2, b = other_end(event.edge);
  Vertex node = first ? a : b;
  // A simplified cell prefers an inner node at the far end to a boundary node that cannot move.
  if (must && !inner(node) && distance > kBoundaryReach) node = first ? b : a;
  if (inner(node))
    claims_.push_back({node, hard(n) ? 1 : 3, length(event.source - rest_of_lattice(node)), n});
}

void Placer::move_nodes() {
  std::ranges::sort(claims_);
  for (const Claim& claim : claims_) {
    if (!nodes_.held.empty() && nodes_.held.back() == claim.node) continue;
    Placed& placed = events_[std::size_t(claim.event)];
    // A crossing in the middle of an edge may have claimed one end while its own wins the other.
    placed.vertex = claim.node;
    Point to = placed.event->source;
    const Point from = rest_of_lattice(claim.node);
    const double far = placed.event->edge == kNoEdge ? kFarthestTip * 2.0 : kFarthestCrossing;
    if (claim.distance < kStill || claim.distance > far ||
        around(claim.node) == Simplified::at_rest)
      to = from;
    nodes_.held.push_back(claim.node);
    nodes_.held_rest.push_back(to);
  }
}

/// The lattice node that takes over a crossing, −1 if none does.
Vertex Placer::taken_over(const CurveEvent& event) const {
  const bool must = beside(event.edge) >= Simplified::without_curve_nodes;
  Vertex best = -1;
  double nearest = INFINITY;
  for (const bool second : {false, true}) {
    const Vertex node = second ? other_end(event.edge) : event.edge / 2;
    const double distance = second ? 1.0 - event.along : event.along;
    const int held = nodes_.find_held(node);
    double reached = 0.0, reach = kBoundaryReach;
    if (held >= 0) {
      const Point moved = nodes_.held_rest[std::size_t(held)] - rest_of_lattice(node);
      reached = (second ? -1.0 : 1.0) * (event.edge % 2 ? moved.y : moved.x);
      reach = std::max(snap_, reached + snap_);
    } else if (inner(node)) {
      continue;
    }
    // Where a curve node is not wanted, a boundary node is the last resort.
    const double gap = distance - reached + (held < 0 && distance > reach ? 2.0 : 0.0);
    if ((distance <= reach || must) && gap < nearest) {
      nearest = gap;
      best = node;
    }
  }
  return best;
}

void Placer::place_crossings() {
  std::vector<int> free;
  for (std::size_t n = 0; n < events_.size(); ++n) {
    Placed& placed = events_[n];
    if (placed.event->edge == kNoEdge || placed.vertex >= 0) continue;
    placed.vertex = taken_over(*placed.event);
    if (placed.vertex < 0) free.push_back(int(n));
  }
  place_curve_nodes(free);
}

/// Crossings of one edge nearer than snap to the first of them become one node, where the middle
/// one lies (of the hard ones, if any is).
void Placer::place_curve_nodes(std::vector<int>& free) {
  auto event = [&](int n) -> const CurveEvent& { return *events_[std::size_t(n)].event; };
  std::ranges::sort(free, [&](int a, int b) {
    return std::pair(event(a).edge, event(a).along) < std::pair(event(b).edge, event(b).along);
  });
  const Vertex first_curve_node = lattice_node(0, ny_ + 1);
  std::vector<int> kinds[2];  // soft, hard
  for (std::size_t n = 0; n < free.size();) {
    const CurveEvent& first = event(free[n]);
    kinds[0].clear();
    kinds[1].clear();
    for (; n < free.size() && event(free[n]).edge == first.edge &&
           event(free[n]).along - first.along < snap_;
         ++n) {
      kinds[hard(free[n])].push_back(free[n]);
      events_[std::size_t(free[n])].vertex = first_curve_node + Vertex(nodes_.edge.size());
    }
    const std::vector<int>& ruling = kinds[1].empty() ? kinds[0] : kinds[1];
    nodes_.edge.push_back(first.edge);
    nodes_.cell.push_back({column(first.edge / 2), row(first.edge / 2)});
    nodes_.curve_rest.push_back(event(ruling[ruling.size() / 2]).source);
  }
}

Point Placer::rest(Vertex vertex) const {
  const Vertex first_curve_node = lattice_node(0, ny_ + 1);
  if (vertex >= first_curve_node) return nodes_.curve_rest[std::size_t(vertex - first_curve_node)];
  const int held = nodes_.find_held(vertex);
  return held >= 0 ? nodes_.held_rest[std::size_t(held)] : rest_of_lattice(vertex);
}

/// The visits and chords of a curve whose events start at `first`.
void Placer::follow(int curve, std::size_t first) {
  const CurveWalk& walk = *walks_[std::size_t(curve)];
  struct Stay {
    Visit visit;
    double from, to;  // arc lengths of its first and last event
    CellIndex after;
  };
  std::vector<Stay> stays;
  stays.reserve(walk.events.size());
  auto nearer = [&](const Visit& visit, Point at) {
    const Point place = rest(visit.vertex);
    return length(at - place) < length(visit.source - place);
  };
  for (std::size_t n = 0; n < walk.events.size(); ++n) {
    const CurveEvent& event = walk.events[n];
    const Vertex vertex = events_[first + n].vertex;
    if (vertex < 0) continue;
    const Visit visit{vertex, curve, event.source, event.target - event.source, 0.0, int(n)};
    if (stays.empty() || stays.back().visit.vertex != vertex)
      stays.push_back({visit, event.arc, event.arc, event.after});
    else if (nearer(stays.back().visit, event.source))
      stays.back().visit = visit;
    stays.back().to = event.arc;
    stays.back().after = event.after;
  }
  if (stays.empty()) return;
  if (walk.closed && stays.size() > 1 && stays.front().visit.vertex == stays.back().visit.vertex) {
    if (nearer(stays.front().visit, stays.back().visit.source))
      stays.front().visit = stays.back().visit;
    stays.front().from = stays.back().from - walk.length;
    stays.pop_back();
  }
  const int base = int(nodes_.visits.size()), count = int(stays.size());
  for (int n = 0; n < count; ++n) {
    Stay& stay = stays[std::size_t(n)];
    auto half = [&](const Stay& a, const Stay& b, double lap) {
      return 0.5 * (a.to + b.from + lap);
    };
    double from = 0.0, to = walk.length;
    if (n > 0) from = half(stays[std::size_t(n - 1)], stay, 0.0);
    if (n + 1 < count) to = half(stay, stays[std::size_t(n + 1)], 0.0);
    if (walk.closed && n == 0) from = half(stays.back(), stay, -walk.length);
    if (walk.closed && n + 1 == count) to = half(stay, stays.front(), walk.length);
    stay.visit.arc = to - from;
    nodes_.visits.push_back(stay.visit);
    if (n + 1 < count || (walk.closed && count > 1))
      nodes_.chords.push_back({stay.after, base + n, base + (n + 1) % count});
  }
}

}  // namespace

int CurveNodes::find_held(Vertex vertex) const {
  const auto at = std::ranges::lower_bound(held, vertex);
  return at != held.end() && *at == vertex ? int(at - held.begin()) : -1;
}

CurveNodes place_nodes(const CurveWalks& walks, const std::vector<double>& weights,
                       const Lattice& lattice, double snap, const SimplifiedCells& simplified) {
  return Placer(walks, weights, lattice, snap, simplified).run();
}

}  // namespace drumhead::grid
