// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "command_line.h"
#include "warp_command.h"

int main(int argc, char** argv) {
  using namespace drumhead::driver;
  try {
    const auto options = read_command_line(argc, argv);
    return options ? run_warp(*options) : int(kConverged);
  } catch (const std::bad_alloc&) {
    std::fputs(
        "drumhead: not enough memory; fewer --cells, a smaller --margin or a smaller picture need "
        "less\n",
        stderr);
    return kBadInput;
  } catch (const std::exception& error) {
    std::string line = error.what();  // names and data quoted in it may hold line ends
    std::ranges::replace_if(
        line, [](unsigned char c) { return c < ' '; }, ' ');
    std::fprintf(stderr, "drumhead: %s\n", line.c_str());
    return kBadInput;
  }
}
