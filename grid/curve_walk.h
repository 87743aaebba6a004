// SPDX-License-Identifier: MIT
#pragma once
// A curve as the sequence of its events on a lattice: crossings of lattice edges, tips and sharp
// corners (rule 1 of conforming.h). Everything is in cells of the lattice.
#include <cstdint>
#include <vector>

#include <drumhead/grid/curve.h>
#include <drumhead/grid/lattice.h>

namespace drumhead::grid {

struct CellIndex {
  int i = 0, j = 0;
  friend bool operator==(const CellIndex&, const CellIndex&) = default;
};

/// Lattice edges by number: 2·node for the edge from node (i, j) to (i+1, j), 2·node + 1 for the
/// one to (i, j+1), node = j·(nx+1) + i.
using EdgeIndex = std::int64_t;
constexpr EdgeIndex kNoEdge = -1;

struct CurveEvent {
  EdgeIndex edge = kNoEdge;  ///< kNoEdge: a tip or a corner, which lies in cell `after`
  double along = 0.0;        ///< 0…1 from the edge's first node to its second
  CellIndex after;           ///< the cell that the curve is in after the event
  Point source, target;      ///< of the curve, at equal parameter
  double arc = 0.0;          ///< arc length from the curve's start
};

struct CurveWalk {
  std::vector<CurveEvent> events;  ///< at least one
  bool closed = false;
  double length = 0.0;
  // What a coarser lattice needs besides.
  std::vector<CurveEvent> all;  ///< double crossings too, tips where they are
  CurveEvent middle;            ///< the event of a curve without any
};

/// Whether two walks have the same events, whatever their targets.
bool same_source(const CurveWalk& a, const CurveWalk& b);

/// Events of one curve, in order, double crossings cancelled. Throws std::invalid_argument when the
/// source leaves the lattice.
CurveWalk walk(const CurvePair& curve, const Lattice& lattice);

/// The walk on the next coarser lattice, every other line of the fine one, without the curve: the
/// time it takes goes with the crossings, not with the segments.
CurveWalk coarsened(const CurveWalk& fine, const Lattice& fine_lattice);

}  // namespace drumhead::grid
