// SPDX-License-Identifier: MIT
#pragma once
// How bad input ends, in all folders.
#include <sstream>
#include <stdexcept>
#include <string>

namespace drumhead::kernels {

/// Throws std::invalid_argument "what = value: must be bound". Six digits with an exponent, because
/// std::to_string writes 1e300 with 301 digits and 1e-9 as 0.
template <class T>
[[noreturn]] void refuse(const std::string& what, const T& value, const std::string& bound) {
  std::ostringstream text;
  text << what << " = " << value << ": must be " << bound;
  throw std::invalid_argument(text.str());
}

}  // namespace drumhead::kernels
