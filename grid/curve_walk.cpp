// SPDX-License-Identifier: MIT
#include "curve_walk.h"

#include <algorithm>

#include <drumhead/grid/conforming.h>

#include "crossings.h"
#include "quadrature.h"

namespace drumhead::grid {
namespace {

// Curves are closed, and their pieces joined, within this many cells.
constexpr double kJoined = 1e-6;
// A tip nearer to the outer boundary than this ends on it.
constexpr double kBoundaryTip = 0.25;
// Tangents that turn by more than this at a joint of segments make a corner: cos 30°.
constexpr double kCornerCosine = 0.866;

/// Of the tangent: to the first control point that differs from the end.
Point direction(const CubicBezier& curve, bool at_end) {
  for (std::size_t n = 1; n < 4; ++n) {
    const Point d =
        at_end ? curve.control[3] - curve.control[3 - n] : curve.control[n] - curve.control[0];
    if (dot(d, d) > 1e-24) return d;
  }
  return {};
}

bool is_corner(Point before, Point after) {
  const double product = dot(before, after);
  return product <= 0.0 || product * product < kCornerCosine * kCornerCosine * dot(before, before) *
                                                   dot(after, after);
}

double arc_between(const CubicBezier& curve, double t0, double t1) {
  if (curve.constant_speed()) return (t1 - t0) * length(curve.control[3] - curve.control[0]);
  double sum = 0.0;
  for_gauss_points(t0, t1,
                   [&](double t, double weight) { sum += weight * length(curve.derivative(t)); });
  return sum;
}

/// A tip near the outer boundary ends on it.
void end_on_boundary(CurveEvent& event, const Lattice& lattice) {
  const CellIndex cell = event.after;
  const double x = event.source.x - cell.i, y = event.source.y - cell.j;
  auto node = [&](int i, int j) { return EdgeIndex(j) * (lattice.nx + 1) + i; };
  auto end_on = [&](EdgeIndex edge, double along, Point at) {
    event.edge = edge;
    event.along = std::clamp(along, 0.0, 1.0);
    event.source = at;
  };
  if (cell.i == 0 && x < kBoundaryTip)
    end_on(2 * node(0, cell.j) + 1, y, {0.0, event.source.y});
  else if (cell.i == lattice.nx - 1 && x > 1.0 - kBoundaryTip)
    end_on(2 * node(lattice.nx, cell.j) + 1, y, {double(lattice.nx), event.source.y});
  else if (cell.j == 0 && y < kBoundaryTip)
    end_on(2 * node(cell.i, 0), x, {event.source.x, 0.0});
  else if (cell.j == lattice.ny - 1 && y > 1.0 - kBoundaryTip)
    end_on(2 * node(cell.i, lattice.ny), x, {event.source.x, double(lattice.ny)});
}

/// Two crossings of one edge with nothing between them: the curve only peeps into the next cell.
void cancel(std::vector<CurveEvent>& events, bool closed) {
  auto same = [](const CurveEvent& a, const CurveEvent& b) {
    return a.edge != kNoEdge && a.edge == b.edge;
  };
  std::size_t kept = 0;
  for (std::size_t n = 0; n < events.size(); ++n) {
    if (kept > 0 && same(events[kept - 1], events[n]))
      --kept;
    else
      events[kept++] = events[n];
  }
  events.resize(kept);
  if (!closed) return;
  std::size_t first = 0;
  while (events.size() - first > 1 && same(events[first], events.back())) {
    ++first;
    events.pop_back();
  }
  events.erase(events.begin(), events.begin() + std::ptrdiff_t(first));
}

/// The events from all that was met.
void set_events(CurveWalk& walk, const Lattice& lattice) {
  walk.events = walk.all;
  if (!walk.closed) {
    end_on_boundary(walk.events.front(), lattice);
    end_on_boundary(walk.events.back(), lattice);
  }
  cancel(walk.events, walk.closed);
  if (walk.events.empty()) walk.events.push_back(walk.middle);
}

class Walker {
 public:
  Walker(const CurvePair& curve, const Lattice& lattice) : curve_(curve), lattice_(lattice) {
    check(curve);
    if (!one_to_one(curve)) matched_ = matched(curve);
  }

  CurveWalk run() {
    const std::size_t count = matched_.empty() ? curve_.source.size() : matched_.size();
    const CubicBezier first = source(0);
    CubicBezier before = source(count - 1);
    walk_.closed = length(first.at(0.0) - before.at(1.0)) < kJoined;
    for (std::size_t n = 0; n < count; ++n) {
      const CubicBezier curve = source(n);
      if (n > 0) joint(before, curve, n);
      segment(curve, n);
      before = curve;
    }
    if (walk_.closed) {
      joint(before, first, 0);
      move_to(start_, before.at(1.0), count - 1, 1.0);
    } else {
      tip(before.at(1.0), count - 1, 1.0);
    }
    walk_.length = arc_;
    walk_.middle = middle(count / 2);
    set_events(walk_, lattice_);
    return std::move(walk_);
  }

 private:
  EdgeIndex node(int i, int j) const { return EdgeIndex(j) * (lattice_.nx + 1) + i; }

  // Segment n in cells.
  CubicBezier source(std::size_t n) const {
    return in_cells(matched_.empty() ? curve_.source[n] : matched_[n].source);
  }
  CubicBezier target(std::size_t n) const {
    return in_cells(matched_.empty() ? curve_.target[n] : matched_[n].target);
  }
  CubicBezier in_cells(CubicBezier curve) const {
    for (Point& p : curve.control) p = lattice_.to_cells(p);
    return curve;
  }

  void segment(const CubicBezier& curve, std::size_t n) {
    if (started_ && stays(curve)) {
      arc_ += arc_between(curve, 0.0, 1.0);
      return;
    }
    find_crossings(curve, crossings_);
    crossings_.push_back(1.0);
    double t0 = 0.0;
    for (const double t1 : crossings_) {
      if (t1 <= t0) continue;
      const CellIndex cell = cell_of(curve.at(0.5 * (t0 + t1)));
      if (!started_) {
        started_ = true;
        start_ = cell_ = cell;
        if (!walk_.closed) tip(curve.at(0.0), n, 0.0);
      }
      if (cell != cell_) move_to(cell, curve.at(t0), n, t0);
      arc_ += arc_between(curve, t0, t1);
      t0 = t1;
    }
  }

  /// Whether a segment has no crossings and lies in the current cell, as most of a polyline do.
  bool stays(const CubicBezier& curve) const {
    return std::ranges::all_of(curve.control, [this](Point p) {
      return p.x - kSnap >= cell_.i && p.x + kSnap < cell_.i + 1 && p.y - kSnap >= cell_.j &&
             p.y + kSnap < cell_.j + 1;
    });
  }

  CellIndex cell_of(Point at) const {
    if (at.x < -kSnap || at.y < -kSnap || at.x > lattice_.nx + kSnap || at.y > lattice_.ny + kSnap)
      refuse_outside(curve_, at, lattice_);
    return {cell_index(at.x, lattice_.nx), cell_index(at.y, lattice_.ny)};
  }

  /// Crosses the edges between the current cell and the next one at a point: one edge, or two that
  /// meet in a node where the curve goes through it. The point lies at t of segment n.
  void move_to(CellIndex next, Point source, std::size_t n, double t) {
    const Point to = target(n).at(t);
    while (cell_.i != next.i) {
      const int step = next.i > cell_.i ? 1 : -1, line = std::max(cell_.i, cell_.i + step);
      cell_.i += step;
      const double along = std::clamp(source.y - cell_.j, 0.0, 1.0);
      walk_.all.push_back(
          {2 * node(line, cell_.j) + 1, along, cell_, {double(line), cell_.j + along}, to, arc_});
    }
    while (cell_.j != next.j) {
      const int step = next.j > cell_.j ? 1 : -1, line = std::max(cell_.j, cell_.j + step);
      cell_.j += step;
      const double along = std::clamp(source.x - cell_.i, 0.0, 1.0);
      walk_.all.push_back(
          {2 * node(cell_.i, line), along, cell_, {cell_.i + along, double(line)}, to, arc_});
    }
  }

  void tip(Point source, std::size_t n, double t) {
    walk_.all.push_back({kNoEdge, 0.0, cell_, source, target(n).at(t), arc_});
  }

  void joint(const CubicBezier& before, const CubicBezier& after, std::size_t n) {
    if (is_corner(direction(before, true), direction(after, false))) tip(after.at(0.0), n, 0.0);
  }

  CurveEvent middle(std::size_t n) const {
    const Point at = source(n).at(0.5);
    return {kNoEdge, 0.0, cell_of(at), at, target(n).at(0.5), 0.5 * arc_};
  }

  const CurvePair& curve_;
  const Lattice& lattice_;
  std::vector<SegmentPair> matched_;  // empty: the curve's own are one to one
  std::vector<double> crossings_;
  CurveWalk walk_;
  CellIndex cell_, start_;
  bool started_ = false;
  double arc_ = 0.0;
};

}  // namespace

bool same_source(const CurveWalk& a, const CurveWalk& b) {
  const auto same = [](const CurveEvent& p, const CurveEvent& q) {
    return p.edge == q.edge && p.along == q.along && p.after == q.after && p.source == q.source &&
           p.arc == q.arc;
  };
  return a.closed == b.closed && a.length == b.length &&
         std::ranges::equal(a.events, b.events, same);
}

CurveWalk walk(const CurvePair& curve, const Lattice& lattice) {
  return Walker(curve, lattice).run();
}

CurveWalk coarsened(const CurveWalk& fine, const Lattice& fine_lattice) {
  const Lattice lattice = coarsened(fine_lattice);
  auto halved = [](CurveEvent event) {
    event.after = {event.after.i / 2, event.after.j / 2};
    event.source = 0.5 * event.source;
    event.target = 0.5 * event.target;
    event.arc *= 0.5;
    return event;
  };
  CurveWalk coarse{
      .closed = fine.closed, .length = 0.5 * fine.length, .middle = halved(fine.middle)};
  for (const CurveEvent& event : fine.all) {
    if (event.edge == kNoEdge) {
      coarse.all.push_back(halved(event));
      continue;
    }
    const bool upwards = event.edge % 2 == 1;  // an edge on a line x = i
    const EdgeIndex node = event.edge / 2;
    const int i = int(node % (fine_lattice.nx + 1)), j = int(node / (fine_lattice.nx + 1));
    if ((upwards ? i : j) % 2 == 1) continue;
    CurveEvent& out = coarse.all.emplace_back(halved(event));
    out.edge = 2 * (EdgeIndex(j / 2) * (lattice.nx + 1) + i / 2) + int(upwards);
    out.along = 0.5 * (event.along + (upwards ? j : i) % 2);
  }
  set_events(coarse, lattice);
  return coarse;
}

}  // namespace drumhead::grid
