// SPDX-License-Identifier: MIT
#pragma once
// What the loops over special cells share: the state at their vertices and the visits of their
// parts.
#include <algorithm>

#include <drumhead/kernels/special.h>

namespace drumhead::kernels {

template <class T>
struct Vector2 {
  T x, y;
};

/// Displacement of a vertex of special cell (i, j): `x`, `y` at lattice nodes.
template <class T>
Vector2<T> at_vertex(const SpecialCells<T>& cells, const Plane<const T>& x, const Plane<const T>& y,
                     int i, int j, int vertex) {
  if (vertex >= kFirstCrossing) {
    const std::size_t n = std::size_t(vertex - kFirstCrossing);
    return {cells.crossing[n].ux(), cells.crossing[n].uy()};
  }
  return {x.at(i + (vertex & 1), j + (vertex >> 1)), y.at(i + (vertex & 1), j + (vertex >> 1))};
}

/// Displacements of the vertices of special cell (i, j), for more than a few of them.
template <class T>
class CellState {
 public:
  CellState(const SpecialCells<T>& cells, const Plane<const T>& x, const Plane<const T>& y, int i,
            int j)
      : crossing_(cells.crossing.data()) {
    for (int c = 0; c < 4; ++c) corner_[c] = at_vertex(cells, x, y, i, j, c);
  }
  /// After a step along d (d.x null: none).
  CellState(const SpecialCells<T>& cells, const Plane<const T>& x, const Plane<const T>& y, int i,
            int j, const Unknowns<const T>& d, T step)
      : CellState(cells, x, y, i, j) {
    curve_ = d.curve;
    step_ = step;
    for (int c = 0; c < 4 && d.x; ++c) {
      corner_[c].x += step * d.x.at(i + (c & 1), j + (c >> 1));
      corner_[c].y += step * d.y.at(i + (c & 1), j + (c >> 1));
    }
  }
  Vector2<T> operator()(int vertex) const {
    if (vertex < kFirstCrossing) return corner_[vertex];
    const int n = vertex - kFirstCrossing;
    const Vector2<T> u{crossing_[n].ux(), crossing_[n].uy()};
    if (!curve_) return u;
    return {u.x + step_ * curve_[2 * n], u.y + step_ * curve_[2 * n + 1]};
  }

 private:
  const HeldNode<T>* crossing_;
  const T* curve_ = nullptr;
  T step_ = T(0);
  Vector2<T> corner_[4];
};

/// Displacement gradient F − 1.
template <class T>
struct Gradient {
  T xx = T(0), xy = T(0), yx = T(0), yy = T(0);
};
/// Of a triangle or point with `count` vertices and the gradients of their shape functions;
/// `displacement`: of a vertex.
template <class T, class S, class F>
Gradient<T> gradient(const S& shape, int count, F&& displacement) {
  Gradient<T> g;
  for (std::size_t a = 0; a < std::size_t(count); ++a) {
    const Vector2<T> u = displacement(shape.vertex[a]);
    g.xx += u.x * shape.gx[a];
    g.xy += u.x * shape.gy[a];
    g.yx += u.y * shape.gx[a];
    g.yy += u.y * shape.gy[a];
  }
  return g;
}

/// Place of column i in a row of a plane: data[j·stride + row_place(plane, i)].
template <class T>
int row_place(const Plane<T>& plane, int i) {
  return (i & 1 ? int(plane.odd) : 0) + (i >> 1);
}

/// visit(cell, i, j) for every special cell.
template <class T, class F>
void for_special(const SpecialCells<T>& cells, F&& visit) {
  for (int j = 0; j + 1 < int(cells.row_begin.size()); ++j)
    for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n)
      visit(n, cells.column[std::size_t(n)], j);
}
/// visit(part) for the parts of a special cell.
template <class T, class F>
void for_parts(const SpecialCells<T>& cells, int cell, F&& visit) {
  const std::size_t n = std::size_t(cell);
  for (int p = cells.part_begin[n]; p < cells.part_begin[n + 1]; ++p) visit(p);
}

/// The corner of cell q of sw, se, nw, ne that is the node itself.
constexpr int corner_towards_node(int q) { return 3 - q; }
/// The quadrant of a node in which the cell lies whose corner it is.
constexpr int quadrant(int corner) { return 3 - corner; }

template <class T>
T mu_at(const Membrane<T>& m, int i, int j) {
  return m.mu.cells ? m.mu.cells.at(i, j) : m.mu.value;
}
template <class T>
T compliance_at(const Membrane<T>& m, int i, int j) {
  return m.compliance.cells ? m.compliance.cells.at(i, j) : m.compliance.value;
}

/// P_H: what of a pressure the Hessian sees.
template <class T>
T clamped(const Membrane<T>& m, T pressure, int i, int j) {
  const T bound = m.clamp_width * mu_at(m, i, j);
  return std::clamp(pressure - m.clamp_centre, -bound, bound);
}

}  // namespace drumhead::kernels
