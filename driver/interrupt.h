// SPDX-License-Identifier: MIT
#pragma once

namespace drumhead::driver {

/// While one lives, the first SIGINT is only noted; a second one acts as it would have before. At
/// most one at a time.
class SolveInterrupt {
 public:
  SolveInterrupt();
  /// A SIGINT acts as before.
  ~SolveInterrupt();
  SolveInterrupt(const SolveInterrupt&) = delete;
  SolveInterrupt& operator=(const SolveInterrupt&) = delete;

  /// Whether a SIGINT came.
  bool asked() const;
};

}  // namespace drumhead::driver
