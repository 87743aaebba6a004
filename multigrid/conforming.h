// SPDX-License-Identifier: MIT
#pragma once
// A level whose lattice conforms to the curves (grid/conforming.h): its special cells for the
// kernels, the pressures of their parts, and how state and corrections pass to and from the next
// coarser level. Every level's cells are built from the curves themselves. Nodes on hard curves are
// known; corrections of nodes pass by index (snapped nodes move by a quarter cell at most), states
// are evaluated at the fine node's rest position in the coarse triangles. So are corrections of
// nodes on soft curves; of their states, what passes is how far they are off their targets, which
// is smooth along the curve and small where that is stiff.
#include <vector>

#include <drumhead/grid/conforming.h>
#include <drumhead/grid/field.h>
#include <drumhead/kernels/special.h>

#include "conforming_regions.h"

namespace drumhead::multigrid {

/// An inner node (i, j) of a level, and the triangle of the special cell (I, J) of the next coarser
/// one in which it rests: its vertices and the node's barycentric coordinates. Rounded to float
/// they cost a solve up to three steps more, by chance (S4, kappa 5 and 10, 800²: .5 and 1.2 on
/// average over six offsets).
struct PlacedNode {
  int i, j, I, J;
  std::array<int, 3> code;
  std::array<double, 3> weight;
};

template <class T>
struct ConformingLevel {
  grid::ConformingCells geometry;
  kernels::SpecialCells<T> cells;
  kernels::SpecialRows<T> rows;
  kernels::SpecialTransfer<T> to_coarse;  ///< empty on the coarsest level
  std::vector<PlacedNode> placed;         ///< in special cells of the coarser one, by rows
  std::vector<T> pressure;                ///< state: P per part
  std::vector<T> shift;                   ///< state: Law::listed_shift, empty: none
  Regions regions;                        ///< whose mean pressures cycles set

  /// `spacing`: side of a cell of the level in finest cells.
  ConformingLevel(grid::ConformingCells cells, T spacing);
  ConformingLevel(const ConformingLevel&) = delete;
  ConformingLevel& operator=(const ConformingLevel&) = delete;

  /// Values that the curve nodes add to a correction: two each if any of them is on a soft curve.
  std::size_t curve_unknowns() const;
  /// Takes the targets that `geometry` has now; soft nodes stay as far off.
  void retarget(T spacing);
  /// No pressures, and held nodes, whose planes are these, at their targets.
  void clear(const kernels::Plane<T>& ux, const kernels::Plane<T>& uy);
  std::size_t bytes() const;
  /// Of `to_coarse` and `placed`, which are made later.
  std::size_t transfer_bytes() const;
};

/// Makes `to_coarse` and `placed` of `fine`.
template <class T>
void join_levels(const grid::ConformingCells& coarse, ConformingLevel<T>& fine);

/// Lattice nodes that curves hold take their places.
template <class T>
void set_held(const ConformingLevel<T>& level, const kernels::Plane<T>& ux,
              const kernels::Plane<T>& uy);

/// Held nodes of soft curves move by step·d; the planes, which have done so, take their places.
template <class T>
void move_held(ConformingLevel<T>& level, const kernels::Unknowns<const T>& d, T step,
               const kernels::Plane<T>& ux, const kernels::Plane<T>& uy);

/// Nodes of soft curves become as far off their targets as those of another level of the same
/// curves, `from` (planes: its lattice nodes), on which a cell of `to` is `scale` cells wide. A
/// node that has none near takes the other level's displacement.
template <class T>
void transfer_soft(const ConformingLevel<T>& from, const kernels::Plane<const T>& from_x,
                   const kernels::Plane<const T>& from_y, double scale, ConformingLevel<T>& to);

/// The plane at special cells takes the mean of their parts.
template <class T>
void set_part_means(const ConformingLevel<T>& level, const kernels::Plane<T>& pressure);

/// Shifts of arap's corners: the planes at special cells take the means of their triangles,
template <class T>
void set_shift_means(const ConformingLevel<T>& level, grid::Field<T> (&shift)[4]);
/// and fine triangles what the planes have at the corners of their cell.
template <class T>
void set_shifts(const grid::Field<T> (&shift)[4], ConformingLevel<T>& level);

/// Pressures of coarse parts: mean over the fine parts and cells they cover, weighted by area.
/// `area`: of a fine regular cell.
template <class T>
void restrict_parts(const ConformingLevel<T>& fine, const kernels::Plane<const T>& fine_pressure,
                    T area, ConformingLevel<T>& coarse);
/// Pressures of fine parts and of cells under coarse parts, constant on those.
template <class T>
void prolong_parts(const ConformingLevel<T>& coarse, const kernels::Plane<const T>& coarse_pressure,
                   ConformingLevel<T>& fine, const kernels::Plane<T>& fine_pressure);

/// Displacements of the fine nodes in special cells of the coarse level, by its triangles.
template <class T>
void prolong_special_nodes(const ConformingLevel<T>& coarse,
                           const kernels::Plane<const T>& coarse_x,
                           const kernels::Plane<const T>& coarse_y, const ConformingLevel<T>& fine,
                           const kernels::Plane<T>& x, const kernels::Plane<T>& y);

}  // namespace drumhead::multigrid
