// SPDX-License-Identifier: MIT
#pragma once
// Where drumhead is slower, larger or less accurate than a peer, or does not converge: found by
// comparing the rows, so that nothing is left out that was measured.
#include <string>
#include <vector>

#include "measurements.h"

namespace drumhead::bench {

struct Losses {
  std::string where;               ///< what was compared
  std::vector<std::string> words;  ///< a sentence each; empty: nothing was found
};

/// One entry for each comparison whose rows are there.
std::vector<Losses> losses(const Measurements& measured);

}  // namespace drumhead::bench
