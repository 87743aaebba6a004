// SPDX-License-Identifier: MIT
#pragma once
// Which deformed cells can lie under a rectangle of output pixels: a quadtree of bounding boxes
// over blocks of 4 × 4 cells. Bilinear patches and triangles lie in the convex hulls of their
// corners, so corner boxes suffice.
#include <cstddef>
#include <limits>
#include <vector>

#include <drumhead/kernels/resample.h>

namespace drumhead::kernels {

/// A closed rectangle in picture pixels; as initialised it is empty and `add` starts from it.
struct Box {
  double x0 = std::numeric_limits<double>::infinity(), y0 = x0;
  double x1 = -x0, y1 = -x0;

  void add(Position p);
  void add(const Box& box);
  bool holds(Position p) const { return x0 <= p.x && p.x <= x1 && y0 <= p.y && p.y <= y1; }
  bool meets(const Box& box) const {
    return x0 <= box.x1 && box.x0 <= x1 && y0 <= box.y1 && box.y0 <= y1;
  }
};

/// Warped position of node (i, j).
inline Position warped_node(const LatticeMapView& map, int i, int j) {
  const std::size_t node = std::size_t(j) * std::size_t(map.nx + 1) + std::size_t(i);
  return {map.origin_px.x + map.cell_px * i + map.u[node],
          map.origin_px.y + map.cell_px * j + map.v[node]};
}

/// Warped position of a corner of a triangle.
inline Position warped_corner(const MapTriangle& triangle, int k) {
  return {triangle.rest[k].x + triangle.displacement[k].x,
          triangle.rest[k].y + triangle.displacement[k].y};
}

class BoxTree {
 public:
  static constexpr int kBlock = 4;  ///< cells of a leaf in each direction

  explicit BoxTree(const LatticeMapView& map);

  /// Calls visit(i0, j0) for each block whose box meets `query`; its cells are (i0 … i0+3, j0 …
  /// j0+3), cut off at the lattice's end.
  template <class Visit>
  void visit(const Box& query, const Visit& visit) const {
    visit_below(levels_.size() - 1, 0, 0, query, visit);
  }

 private:
  struct Level {
    int columns = 0, rows = 0;
    std::vector<Box> boxes;
    const Box& at(int i, int j) const {
      return boxes[std::size_t(j) * std::size_t(columns) + std::size_t(i)];
    }
  };

  template <class Visit>
  void visit_below(std::size_t level, int i, int j, const Box& query, const Visit& visit) const {
    const Level& here = levels_[level];
    if (i >= here.columns || j >= here.rows || !here.at(i, j).meets(query)) return;
    if (level == 0) return visit(i * kBlock, j * kBlock);
    for (int child = 0; child < 4; ++child) {
      visit_below(level - 1, 2 * i + child % 2, 2 * j + child / 2, query, visit);
    }
  }

  std::vector<Level> levels_;  // blocks first, the single root last
};

}  // namespace drumhead::kernels
