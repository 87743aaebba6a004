// SPDX-License-Identifier: MIT
#pragma once
// What a function says when it refuses its input.
#include <stdexcept>
#include <string>

namespace drumhead {

/// The text of the std::invalid_argument that body throws, empty if it throws none.
template <class F>
std::string refusal_of(F&& body) {
  try {
    body();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace drumhead
