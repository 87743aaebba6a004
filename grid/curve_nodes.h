// SPDX-License-Identifier: MIT
#pragma once
// Which nodes the curves go through (rules 1–3, 5 and 7 of conforming.h): lattice nodes that move
// onto a curve, curve nodes on lattice edges, and the chords between them.
#include <map>
#include <vector>

#include <drumhead/grid/conforming.h>

#include "curve_walk.h"

namespace drumhead::grid {

/// A lattice node (j·(nx+1) + i) or, from (nx+1)(ny+1) on, a curve node.
using Vertex = std::int64_t;

/// The walks of all curves on one lattice.
using CurveWalks = std::vector<const CurveWalk*>;

/// A curve's stay at one node.
struct Visit {
  Vertex vertex = -1;
  int curve = 0;
  Point source, displacement;  ///< of the curve's event nearest to the node
  double arc = 0.0;            ///< half the arcs to the visits before and after
  int event = -1;  ///< that one, of its curve's; −1: on the chord between visits `from` and `to`
  int from = -1, to = -1;
  double share = 0.0;  ///< of that chord: where on it
};

/// Two visits that follow one another along a curve, and the cell between them.
struct Chord {
  CellIndex cell;
  int from = 0, to = 0;  ///< visits
};

/// How far the cells that would not triangulate have been simplified (rule 7), by j·nx + i.
enum class Simplified { no, without_tips, without_curve_nodes, at_rest };
using SimplifiedCells = std::map<std::int64_t, Simplified>;

struct CurveNodes {
  std::vector<Vertex> held;  ///< lattice nodes, ascending
  std::vector<Point> held_rest;
  std::vector<EdgeIndex>
      edge;  ///< of curve nodes, ascending, then along the edge; kNoEdge: in_cell
  std::vector<CellIndex> cell;  ///< of curve nodes in a cell, else the edge's first node
  std::vector<Point> curve_rest;
  std::vector<Visit> visits;
  std::vector<Chord> chords;
  std::vector<Point> lost_tips;  ///< in cells

  /// Index into `held`, −1 if a lattice node is not held.
  int find_held(Vertex vertex) const;
};

/// `weights`: d of each curve.
CurveNodes place_nodes(const CurveWalks& walks, const std::vector<double>& weights,
                       const Lattice& lattice, double snap, const SimplifiedCells& simplified);

}  // namespace drumhead::grid
