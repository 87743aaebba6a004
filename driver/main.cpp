// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>

#include "command_line.h"
#include "warp_command.h"

int main(int argc, char** argv) {
  using namespace drumhead::driver;
  try {
    const auto options = read_command_line(argc, argv);
    return options ? run_warp(*options) : int(kConverged);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "drumhead: %s\n", error.what());
    return kBadInput;
  }
}
