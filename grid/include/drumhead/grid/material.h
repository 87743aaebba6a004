// SPDX-License-Identifier: MIT
#pragma once
// Stiffness mu and compression resistance kappa of the membrane (Setaluri et al. 2014, Eq. 1),
// constant or one value per cell. A constant stores no field.
#include <vector>

#include <drumhead/grid/lattice.h>
#include <drumhead/kernels/model.h>

namespace drumhead::grid {

struct Material {
  double mu = 1.0;  ///< > 0; the unit of kappa
  /// In units of mu, 0…infinity; 0: no pressures exist. Models other than crpm: 0…1e6,
  /// fold-free 0…100.
  double kappa = 1.0;
  /// Optional factors per cell, row after row, i fastest, empty or nx·ny: the cell's stiffness is
  /// mu·mu_cells[c] (> 0) and its compression resistance mu·kappa_cells[c] (≥ 0, replaces `kappa`).
  std::vector<float> mu_cells, kappa_cells;
  kernels::Model model = kernels::Model::crpm;
  double eps = 0.2;  ///< arap, fold-free: share of its area below which a cell's corner resists
  friend bool operator==(const Material&, const Material&) = default;
};

/// Throws std::invalid_argument naming the value, the cell and the bound.
void check(const Material& material, const Lattice& lattice);

/// Largest kappa/mu of a cell, in units of the scene's values.
double largest_stiffness(const Material& material);

}  // namespace drumhead::grid
