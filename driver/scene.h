// SPDX-License-Identifier: MIT
#pragma once
// The scene file: TOML whose keys are the flags of the command (see options.h), and one [[curve]]
// table for each curve that has a weight or a turn of its own:
//
//     picture = "face.jpg"
//     curves = "face.svg"
//     kappa = 10
//     [[curve]]
//     name = "brow"
//     weight = 200
#include <filesystem>

#include "options.h"

namespace drumhead::driver {

/// Sets what the scene says; paths are taken relative to its folder.
/// Throws std::invalid_argument naming file and line: unreadable or broken TOML, an unknown key, a
/// value outside its bound, `cells` beside `cell_size`, a curve table without name or named twice.
void read_scene(const std::filesystem::path& file, Options& options);

}  // namespace drumhead::driver
