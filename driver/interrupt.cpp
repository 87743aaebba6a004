// SPDX-License-Identifier: MIT
#include "interrupt.h"

#include <csignal>

namespace drumhead::driver {
namespace {

volatile std::sig_atomic_t noted = 0;
void (*before)(int) = SIG_DFL;

extern "C" void note_interrupt(int) {
  noted = 1;
  std::signal(SIGINT, before);
}

}  // namespace

SolveInterrupt::SolveInterrupt() {
  noted = 0;
  before = std::signal(SIGINT, note_interrupt);
}

SolveInterrupt::~SolveInterrupt() { std::signal(SIGINT, before); }

bool SolveInterrupt::asked() const { return noted != 0; }

}  // namespace drumhead::driver
