// SPDX-License-Identifier: MIT
#pragma once
// One special cell: its polygon is split by chords into parts, and the parts into triangles (rules
// 4 and 7 of conforming.h).
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
  /// The outline, counter-clockwise. New visits and curve nodes are added to `nodes`.
  CellSplit(CellIndex cell, std::vector<CellVertex> outline, Vertex first_curve_node,
            CurveNodes& nodes);

  /// Splits along a chord. False: too complicated.
  bool add(const Chord& chord);

  const std::vector<CellVertex>& vertices() const { return vertices_; }
  /// Each part's vertices, counter-clockwise.
  const std::vector<std::vector<int>>& parts() const { return parts_; }
  /// The triangles of a part (indices into its vertices) with the best least quality; false if
  /// there is no triangulation of fit triangles or the part has too many nodes.
  bool triangulate(const std::vector<int>& part, std::vector<PartTriangle>& out) const;

 private:
  struct Piece {  // of a chord
    int a, b, from, to;
  };
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
  std::vector<std::vector<int>> parts_;
  std::vector<Piece> pieces_;
};

}  // namespace drumhead::grid
