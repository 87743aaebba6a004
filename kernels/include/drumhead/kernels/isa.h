// SPDX-License-Identifier: MIT
#pragma once
// Which instruction set the kernels run on. Chosen once: the best that this processor and its
// operating system support, or the one that the environment variable DRUMHEAD_ISA names. Results
// are bit-equal for all.
#include <span>
#include <string_view>

namespace drumhead::kernels {

enum class Isa { scalar, sse2, avx2, avx512 };

std::string_view name(Isa isa);

/// The instruction sets that this machine can run, in rising order.
std::span<const Isa> available_isas();

/// The one in use. If DRUMHEAD_ISA names an unknown or unavailable set, the best available one is
/// used; `forced_isa_error` says what was wrong.
Isa current_isa();
/// Empty, or a sentence about a DRUMHEAD_ISA that could not be obeyed.
std::string_view forced_isa_error();

/// Changes the instruction set for all later calls (tests and benchmarks); false if not available.
/// Not to be called while kernels run.
bool use_isa(Isa isa);

}  // namespace drumhead::kernels
