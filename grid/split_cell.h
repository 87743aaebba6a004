// SPDX-License-Identifier: MIT
#pragma once
// Special cells, one after another: a cell's polygon is split by chords into parts, and the parts
// into triangles (rules 4 and 7 of conforming.h).
#include <span>
#include <vector>

#include "curve_nodes.h"

namespace drumhead::grid {

/// A vertex of the cell's outline or, with no side, inside it.
struct CellVertex {
  Vertex vertex = -1;
  int code = 0;  ///< as in ConformingCells::part_node
  Point rest;
  unsigned sides = 0;  ///< bits of the sides of the cell that it lies on
  bool held = false;
};

class CellSplit {
 public:
  /// New visits and curve nodes are added to `nodes`.
  CellSplit(Vertex first_curve_node, CurveNodes& nodes)
      : first_curve_node_(first_curve_node), nodes_(nodes) {}

  /// A whole cell; its outline counter-clockwise.
  void begin(CellIndex cell, const std::vector<CellVertex>& outline);
  /// Splits along a chord. False: too complicated.
  bool add(const Chord& chord);

  const std::vector<CellVertex>& vertices() const { return vertices_; }
  int parts() const { return int(parts_.size()); }
  /// A part's vertices, counter-clockwise.
  std::span<const int> part(int p) const { return loop(parts_[std::size_t(p)]); }
  /// The triangles of a part (indices into its vertices) with the best least quality; false if
  /// there is no triangulation of fit triangles or the part has too many nodes.
  bool triangulate(std::span<const int> part, std::vector<PartTriangle>& out) const;

 private:
  struct Piece {  // of a chord
    int a, b, from, to;
  };
  struct Part {  // [begin, end) of loops_
    std::size_t begin, end;
  };
  std::span<const int> loop(const Part& part) const {
    return {loops_.data() + part.begin, part.end - part.begin};
  }
  int find(Vertex vertex) const;
  bool join(int a, int b, int from, int to, int depth);
  int vertex_near(int a, int b, double& lambda) const;
  bool split_common_part(int a, int b, int from, int to);
  bool cross(int a, int b, int from, int to, int depth);
  int visit_between(int from, int to, double lambda, const CellVertex& at);

  CellIndex cell_;
  Vertex first_curve_node_;
  CurveNodes& nodes_;
  std::vector<CellVertex> vertices_;
  std::vector<Part> parts_;
  std::vector<int> loops_;  // of the parts, and what has become of parts that were split
  std::vector<Piece> pieces_;
};

}  // namespace drumhead::grid
