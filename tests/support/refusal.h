// SPDX-License-Identifier: MIT
#pragma once
// What is said of bad input.
#include <stdexcept>
#include <string>

namespace drumhead::tests {

/// The message with which `action` is refused as bad input; empty if it is not.
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace drumhead::tests
