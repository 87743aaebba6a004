// SPDX-License-Identifier: MIT
#pragma once
// Coefficients of the membrane from a grey picture (Setaluri et al. 2014, section 3.3: mu and kappa
// vary by an image mask). A pixel of grey g, 0 black to 1 white, has the coefficient
//   linear  black + g (white − black)        log  black (white / black)^g
// on its whole square, and beyond the picture the nearest edge pixel's goes on. A cell takes what
// its terms of Eq. 5 integrate: the area mean of mu, and for kappa the area mean of 1/kappa, since
// the term of the one pressure is P²/(2 kappa). Coarser levels average the same two quantities, so
// that a mask means the same on a lattice and on one of half as many cells.
#include <vector>

#include <drumhead/grid/lattice.h>

namespace drumhead::grid {

enum class MaskScale { linear, log };

struct Mask {
  int width = 0, height = 0;        ///< pixels of the picture that the lattice lies over
  std::vector<float> grey;          ///< 0 black … 1 white, row after row from the top
  double black = 0.0, white = 1.0;  ///< the coefficient of either, finite; above 0 on a log scale
  MaskScale scale = MaskScale::linear;
};

/// Material::mu_cells of a mask whose black and white are factors of the scene's mu, both > 0:
/// means over each cell, exact up to rounding. Throws std::invalid_argument naming the pixel or the
/// value, and its bound: a size that does not fit, a grey outside 0…1 or not a number, black or
/// white outside the coefficient's domain.
std::vector<float> mu_cells(const Mask& mask, const Lattice& lattice);

/// Material::kappa_cells of a mask whose black and white are in units of the scene's mu, both ≥ 0:
/// 1 / mean(1/kappa), which is 0 where any part of the cell has kappa 0. Throws as mu_cells.
std::vector<float> kappa_cells(const Mask& mask, const Lattice& lattice);

}  // namespace drumhead::grid
