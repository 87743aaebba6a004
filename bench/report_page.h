// SPDX-License-Identifier: MIT
#pragma once
// One self-contained HTML page of all measurements: plots, tables, pictures, what is lost against
// peers, and how it was measured.
#include <string>

#include "measurements.h"

namespace drumhead::bench {

/// `pictures`: a folder of PNG files, which the page then holds; may be "". Throws
/// std::runtime_error that names a picture which cannot be read.
std::string page_of(const Measurements& measured, const std::string& pictures);

}  // namespace drumhead::bench
