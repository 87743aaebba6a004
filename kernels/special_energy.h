// SPDX-License-Identifier: MIT
#pragma once
// Force and energy of the special cells, cell by cell from their triangles and parts.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/special.h>

#include "special_state.h"

namespace drumhead::kernels {

/// Overwrites f at near nodes (0 at known ones), in the plane of special cells (0) and in the list
/// of parts by −∂E/∂(x, P) at the membrane's state. Returns the number of inverted special cells.
template <class T>
int special_force(const Membrane<T>& membrane, const Unknowns<T>& f);

/// Adds to the forces on the vertices of special cell n = (i, j), once `store` is called; those on
/// known nodes are not kept.
template <class T>
class CellForce {
 public:
  CellForce(const Unknowns<T>& f, const SpecialRows<T>& rows, int n, int i, int j)
      : f_(f), rows_(rows), n_(n), i_(i), j_(j) {
    for (int c = 0; c < 4; ++c) corner_[c] = {x(c), y(c)};
  }
  void add(int vertex, Vector2<T> force) {
    if (vertex < kFirstCrossing) {
      corner_[vertex].x += force.x;
      corner_[vertex].y += force.y;
      return;
    }
    const std::size_t c = std::size_t(vertex - kFirstCrossing);
    if (!rows_.soft() || rows_.cells().crossing[c].known()) return;
    f_.curve[2 * c] += force.x;
    f_.curve[2 * c + 1] += force.y;
  }
  void store() const {
    for (int c = 0; c < 4; ++c) {
      if (rows_.unknown_corner(n_, c) < 0) continue;
      x(c) = corner_[c].x;
      y(c) = corner_[c].y;
    }
  }

 private:
  T& x(int corner) const { return f_.x.at(i_ + (corner & 1), j_ + (corner >> 1)); }
  T& y(int corner) const { return f_.y.at(i_ + (corner & 1), j_ + (corner >> 1)); }

  const Unknowns<T>& f_;
  const SpecialRows<T>& rows_;
  int n_, i_, j_;
  Vector2<T> corner_[4];
};
/// Forces of the springs of soft curves, before all others on curve nodes, after the regular ones
/// on lattice nodes.
template <class T>
void add_spring_force(const SpecialCells<T>& cells, const Unknowns<T>& f);
/// Adds the energies of the springs of nodes of row j.
template <class T>
void add_spring_energy(const SpecialRows<T>& rows, const Unknowns<const T>& d, T step,
                       EnergySums& sums, int j);

/// f at special cells of row j := that of a cell at rest, which does not count as inverted.
template <class T>
void clear_special_force(const Membrane<T>& membrane, const Unknowns<T>& f, int j);

/// Columns of the special cells of row j.
template <class T>
Columns special_columns(const SpecialCells<T>& cells, int j) {
  const int* column = cells.column.data();
  return {column + cells.row_begin[std::size_t(j)], column + cells.row_begin[std::size_t(j) + 1]};
}

/// Adds the energies of row j's special cells at x̂ + step·d (d.x null: at the state). A cell with a
/// part of negative area is inverted.
template <class T>
void add_special_energy(const Membrane<T>& membrane, const Unknowns<const T>& d, T step,
                        EnergySums& sums, int j);

}  // namespace drumhead::kernels
