// SPDX-License-Identifier: MIT
#pragma once
// The command line of `drumhead`, made from the keys of options.h.
#include <optional>

#include "options.h"

namespace drumhead::driver {

/// Exit codes: 0 converged, 1 written but not converged, 2 bad input and nothing written.
enum : int { kConverged = 0, kNotConverged = 1, kBadInput = 2 };

/// Reads the command line, and the scene it names first, so that flags overrule the scene. Prints
/// the help or the version where asked and returns nothing then. Throws std::invalid_argument for
/// bad input.
std::optional<Options> read_command_line(int argc, char** argv);

}  // namespace drumhead::driver
