// SPDX-License-Identifier: MIT
#pragma once
// Folds of a deformed lattice, counted. J is linear in a bilinear cell: its mean is J* (Setaluri et
// al. 2014, Eq. 7) at the centre, its least value lies at a corner.
#include <vector>

#include <drumhead/kernels/resample.h>

namespace drumhead::kernels {

/// Of the bilinear cells of one row of a lattice. A J that is not a number counts as 1.
struct RowFolds {
  double least_J = 1.0;         ///< at the centre of a cell, at most 1
  double least_corner_J = 1.0;  ///< at a corner, at most 1
  int inverted = 0;             ///< cells with J < 0 at the centre
  int folded = 0;               ///< cells with J < 0 at any corner
};

/// One per row of cells. Split cells are left out.
std::vector<RowFolds> count_folds(const LatticeMapView& map);

}  // namespace drumhead::kernels
