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

Point direction(const CubicBezier& curve, bool at_end) {
  // The first control point that differs from the end gives the tangent.
  for (std::size_t n = 1; n < 4; ++n) {
    const Point d =
        at_end ? curve.control[3] - curve.control[3 - n] : curve.control[n] - curve.control[0];
    const double size = length(d);
    if (size > 1e-12) return (1.0 / size) * d;
  }
  return {};
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
    segments_ = matched(curve);
    for (SegmentPair& pair : segments_)
      for (std::size_t n = 0; n < 4; ++n) {
        pair.source.control[n] = lattice.to_cells(pair.source.control[n]);
        pair.target.control[n] = lattice.to_cells(pair.target.control[n]);
      }
  }

  CurveWalk run() {
    const Point gap = segments_.front().source.at(0.0) - segments_.back().source.at(1.0);
    walk_.closed = length(gap) < kJoined;
    for (std::size_t n = 0; n < segments_.size(); ++n) {
      if (n > 0) joint(segments_[n - 1], segments_[n]);
      segment(segments_[n]);
    }
    const SegmentPair& last = segments_.back();
    if (walk_.closed) {
      joint(last, segments_.front());
      move_to(start_, last.source.at(1.0), last.target.at(1.0));
    } else {
      tip(last.source.at(1.0), last.target.at(1.0));
    }
    walk_.length = arc_;
    walk_.middle = middle();
    set_events(walk_, lattice_);
    return std::move(walk_);
  }

 private:
  EdgeIndex node(int i, int j) const { return EdgeIndex(j) * (lattice_.nx + 1) + i; }

  void segment(const SegmentPair& pair) {
    find_crossings(pair.source, crossings_);
    crossings_.push_back(1.0);
    double t0 = 0.0;
    for (const double t1 : crossings_) {
      if (t1 <= t0) continue;
      const CellIndex cell = cell_of(pair.source.at(0.5 * (t0 + t1)));
      if (!started_) {
        started_ = true;
        start_ = cell_ = cell;
        if (!walk_.closed) tip(pair.source.at(0.0), pair.target.at(0.0));
      }
      move_to(cell, pair.source.at(t0), pair.target.at(t0));
      arc_ += arc_between(pair.source, t0, t1);
      t0 = t1;
    }
  }

  CellIndex cell_of(Point at) const {
    if (at.x < -kSnap || at.y < -kSnap || at.x > lattice_.nx + kSnap || at.y > lattice_.ny + kSnap)
      refuse_outside(curve_, at, lattice_);
    return {cell_index(at.x, lattice_.nx), cell_index(at.y, lattice_.ny)};
  }

  /// Crosses the edges between the current cell and the next one at a point: one edge, or two that
  /// meet in a node where the curve goes through it.
  void move_to(CellIndex next, Point source, Point target) {
    while (cell_.i != next.i) {
      const int step = next.i > cell_.i ? 1 : -1, line = std::max(cell_.i, cell_.i + step);
      cell_.i += step;
      const double along = std::clamp(source.y - cell_.j, 0.0, 1.0);
      walk_.all.push_back({2 * node(line, cell_.j) + 1,
                           along,
                           cell_,
                           {double(line), cell_.j + along},
                           target,
                           arc_});
    }
    while (cell_.j != next.j) {
      const int step = next.j > cell_.j ? 1 : -1, line = std::max(cell_.j, cell_.j + step);
      cell_.j += step;
      const double along = std::clamp(source.x - cell_.i, 0.0, 1.0);
      walk_.all.push_back(
          {2 * node(cell_.i, line), along, cell_, {cell_.i + along, double(line)}, target, arc_});
    }
  }

  void tip(Point source, Point target) {
    walk_.all.push_back({kNoEdge, 0.0, cell_, source, target, arc_});
  }

  void joint(const SegmentPair& before, const SegmentPair& after) {
    if (dot(direction(before.source, true), direction(after.source, false)) < kCornerCosine)
      walk_.all.push_back({kNoEdge, 0.0, cell_, after.source.at(0.0), after.target.at(0.0), arc_});
  }

  CurveEvent middle() const {
    const SegmentPair& pair = segments_[segments_.size() / 2];
    const Point source = pair.source.at(0.5);
    return {kNoEdge, 0.0, cell_of(source), source, pair.target.at(0.5), 0.5 * arc_};
  }

  const CurvePair& curve_;
  const Lattice& lattice_;
  std::vector<SegmentPair> segments_;
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
