// SPDX-License-Identifier: MIT
#pragma once
// Residuals row by row, and their restriction to the coarser level while they are still in cache.
#include <algorithm>

#include <drumhead/kernels/relax.h>

#include "kernel_table.h"
#include "linear_rows.h"
#include "special_sweeps.h"

namespace drumhead::kernels {

/// Residual rows of a level into buffers that served other levels: nodes and, with pressures, cells
/// of row j. Rows that do not follow one another cost one row more.
template <class T>
void residual_row(LinearRows<T>& linear, int& next, const Membrane<T>& membrane,
                  const Unknowns<const T>& f, const Unknowns<const T>& d, const SplitRow<T>& x,
                  const SplitRow<T>& y, const SplitRow<T>& p, int j) {
  if (d.p) {
    if (next != j) linear.begin(membrane, d, j);
    linear.row(membrane, &f, d, x, y, p, j);
    next = j + 1;
  } else if (j > 0) {
    table<T>().residual_nodes(membrane, &f, d, x, y, j);
  }
  if (j == 0) return;
  // Nodes on the fixed boundary get 0.
  const int last = d.x.columns - 1;
  for (const SplitRow<T>& row : {x, y}) row.half[0][0] = row.half[last & 1][last >> 1] = T(0);
  if (membrane.special) overwrite_near_row(*membrane.special, &f, d, x, y, j);
}

/// Room for the residuals of all parts of a level's special cells.
template <class T>
T* part_residuals(const Membrane<T>& membrane, RowScratch<T>& scratch) {
  return membrane.special ? scratch.parts(membrane.special->cells().parts()) : nullptr;
}

/// Fills coarse rows from the residual of a level, called with ascending rows of each thread's
/// chunk.
template <class T>
class Restriction {
 public:
  Restriction(const LevelSystem<T>& level, const Unknowns<T>& coarse, RowScratch<T>& scratch)
      : level_(level),
        coarse_(coarse),
        scratch_(scratch),
        parts_(part_residuals(level.membrane, scratch)),
        for_curve_(level.transfer ? scratch.curves(2 * int(level.transfer->of_node.size()))
                                  : nullptr),
        kernels_(table<T>()) {
    scratch.forget();
  }

  /// After all rows.
  void finish() const {
    if (level_.coarse_special && level_.membrane.special->soft())
      restrict_curves(*level_.membrane.special, *level_.transfer, f_, d_, for_curve_, coarse_);
  }

  /// After cell row j (and node rows up to j) are final: restricts what they complete.
  void operator()(int j, int thread) {
    const int ny = level_.d.x.rows - 1, coarse_row = j / 2;
    if (j % 2 == 0 && j + 1 < ny) return;
    typename RowScratch<T>::Rows& rows = scratch_.rows(thread);
    LinearRows<T> linear(level_.d.x.columns);
    if (coarse_row >= 1 && coarse_row < coarse_.x.rows - 1) {
      const int middle = 2 * coarse_row;
      const int below = hold(linear, rows, middle - 1), centre = hold(linear, rows, middle);
      const bool has_above = middle + 1 < ny;
      const int above = has_above ? hold(linear, rows, middle + 1) : 0;
      restrict_component(rows.x, below, centre, above, has_above, coarse_.x, coarse_row);
      restrict_component(rows.y, below, centre, above, has_above, coarse_.y, coarse_row);
      if (level_.coarse_special) {
        keep(rows, below, middle - 1);
        keep(rows, centre, middle);
        if (has_above && coarse_row + 2 == coarse_.x.rows) keep(rows, above, middle + 1);
      }
    }
    if (level_.d.p) restrict_cells(linear, rows, coarse_row);
    if (level_.coarse_special) restrict_parts(rows, coarse_row);
  }

 private:
  SplitRow<T> split(T* row) const { return {{row, row + scratch_.odd()}}; }
  static SplitRow<const T> as_const(const SplitRow<T>& row) { return {{row.half[0], row.half[1]}}; }

  void restrict_cells(LinearRows<T>& linear, typename RowScratch<T>::Rows& rows, int coarse_row) {
    const int first = 2 * coarse_row;
    const bool pair = first + 1 < level_.d.p.rows;
    for (int n = 0; n <= int(pair); ++n) {
      hold(linear, rows, first + n);
      if (parts_)
        overwrite_part_row(*level_.membrane.special, &f_, d_, split(rows.p[n]), parts_, first + n);
    }
    const SplitRow<const T> upper = as_const(split(rows.p[1]));
    kernels_.sum_cells(as_const(split(rows.p[0])), pair ? &upper : nullptr, level_.d.p.columns,
                       coarse_.p, coarse_row);
  }

  void restrict_parts(const typename RowScratch<T>::Rows& rows, int coarse_row) const {
    clear_without_equation(*level_.coarse_special, coarse_, coarse_row);
    if (!level_.d.p) return;
    for (int j = 2 * coarse_row; j < std::min(2 * coarse_row + 2, level_.d.p.rows); ++j)
      add_restricted_parts<T>(*level_.transfer, parts_, split(rows.p[j & 1]), coarse_, j);
  }

  /// Residual row j for coarse curve nodes: every row in one call, by the thread that calls it.
  void keep(const typename RowScratch<T>::Rows& rows, int slot, int j) const {
    keep_for_curve(*level_.transfer, as_const(split(rows.x[slot])), as_const(split(rows.y[slot])),
                   j, for_curve_);
  }

  /// Index of the buffer that holds residual row j, computing it if it is not there.
  int hold(LinearRows<T>& linear, typename RowScratch<T>::Rows& rows, int j) {
    const int slot = j & 3;
    if (rows.held[slot] != j) {
      residual_row(linear, rows.next, level_.membrane, f_, d_, split(rows.x[slot]),
                   split(rows.y[slot]), split(rows.p[j & 1]), j);
      rows.held[slot] = j;
    }
    return slot;
  }

  void restrict_component(T* const (&buffers)[4], int below, int centre, int above, bool has_above,
                          const Plane<T>& out, int coarse_row) const {
    const SplitRow<const T> upper = as_const(split(buffers[above]));
    kernels_.restrict_nodes(as_const(split(buffers[below])), as_const(split(buffers[centre])),
                            has_above ? &upper : nullptr, level_.d.x.columns, out, coarse_row);
    if (!level_.coarse_special) return;
    const int middle = 2 * coarse_row;
    add_restricted_nodes(*level_.transfer, as_const(split(buffers[below])), middle - 1, out,
                         coarse_row);
    add_restricted_nodes(*level_.transfer, as_const(split(buffers[centre])), middle, out,
                         coarse_row);
    if (has_above) add_restricted_nodes(*level_.transfer, upper, middle + 1, out, coarse_row);
  }

  const LevelSystem<T>& level_;
  const Unknowns<T>& coarse_;
  RowScratch<T>& scratch_;
  T *parts_, *for_curve_;
  const KernelTable<T>& kernels_;
  const Unknowns<const T> f_ = level_.f, d_ = level_.d;
};

}  // namespace drumhead::kernels
