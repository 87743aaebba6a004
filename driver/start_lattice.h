// SPDX-License-Identifier: MIT
#pragma once
// Going on from the lattice that an earlier run has written (--lattice): a curve was dragged a
// little, or let go.
#include <drumhead/grid/lattice.h>
#include <drumhead/multigrid/warp.h>

#include <filesystem>

namespace drumhead::driver {

/// The file's displacements as a solution to start from on `lattice`, with the discretisation error
/// and the curve method that its header tells; pressures and forces are not in it. Throws
/// std::invalid_argument naming `file`: other channels than u, v, another number of nodes, a value
/// that is not finite; std::runtime_error where it cannot be read.
multigrid::Solution read_start(const std::filesystem::path& file, const grid::Lattice& lattice);

}  // namespace drumhead::driver
