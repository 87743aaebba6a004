// SPDX-License-Identifier: MIT
#pragma once
// Force and energy of the special cells, cell by cell from their triangles and parts.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/special.h>

namespace drumhead::kernels {

/// Overwrites f at near nodes (0 at known ones), in the plane of special cells (0) and in the list
/// of parts by −∂E/∂(x, P) at the membrane's state. Returns the number of inverted special cells.
template <class T>
int special_force(const Membrane<T>& membrane, const Unknowns<T>& f);

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
