// SPDX-License-Identifier: MIT
#pragma once
// The measurements in a few sentences, each only where its rows are there.
#include <string>
#include <vector>

#include "measurements.h"

namespace drumhead::bench {

std::vector<std::string> summary(const Measurements& measured);

/// Processor, commit and dates of the runs, for the page, bench/tables.md and README.md.
std::string machine(const Measurements& measured);

}  // namespace drumhead::bench
