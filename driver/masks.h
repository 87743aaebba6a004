// SPDX-License-Identifier: MIT
#pragma once
// Grey pictures that say how stiff and how resistant to change of area the membrane is from place
// to place: the keys mu_mask, mu_black, mu_white, mu_scale and the same of kappa (see grid/mask.h).
#include "image.h"
#include "options.h"

namespace drumhead::driver {

/// Reads the masks that the options name and gives the material their values per cell. `width` and
/// `height` are the picture's. Throws std::invalid_argument naming file, pixel and bound: a file
/// that cannot be read, another size than the picture's, colours, greys outside 0…1 or not numbers,
/// black or white outside the coefficient's domain, keys of a mask that is not there, a kappa mask
/// for a membrane without kappa.
void apply_masks(const Options& options, int width, int height, const grid::Lattice& lattice,
                 grid::Material& material);

}  // namespace drumhead::driver
