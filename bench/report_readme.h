// SPDX-License-Identifier: MIT
#pragma once
// The README's tables, which stand between marks there:
//   <!-- table NAME, made by bench/report.sh -->  …  <!-- end of table NAME -->
#include <string>

#include "measurements.h"

namespace drumhead::bench {

/// The README with what stands between its marks replaced. NAME is table1 (the paper's, with the
/// machine below it), curves (both ways to meet curves) or solves. Throws std::runtime_error at a
/// mark without its end or with another name.
std::string with_tables(const std::string& readme, const Measurements& measured);

}  // namespace drumhead::bench
