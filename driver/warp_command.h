// SPDX-License-Identifier: MIT
#pragma once
// `drumhead warp`: reads picture and curves, solves, renders, writes.
#include "options.h"

namespace drumhead::driver {

/// Returns the exit code 0 or 1. Throws std::invalid_argument for bad input, before anything is
/// written, and std::runtime_error where writing fails, in which case no output has appeared that
/// is not whole.
int run_warp(Options options);

}  // namespace drumhead::driver
