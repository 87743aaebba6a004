// SPDX-License-Identifier: MIT
#include <drumhead/kernels/isa.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "isotropic_table.h"
#include "kernel_table.h"

namespace drumhead::kernels {
namespace {

constexpr std::array<Isa, 4> kAll{Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512};

// __builtin_cpu_supports also asks whether the operating system saves the wide registers.
int count_available() {
  if (!__builtin_cpu_supports("avx2")) return 2;
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512vl");
  return wide ? 4 : 3;
}

struct Choice {
  Isa isa;
  std::string error;
};

Choice choose() {
  const auto available = available_isas();
  const Isa best = available.back();
  const char* wanted = std::getenv("DRUMHEAD_ISA");
  if (!wanted || !*wanted) return {best, {}};
  const auto known =
      std::ranges::find(kAll, std::string_view(wanted), [](Isa isa) { return name(isa); });
  if (known == kAll.end())
    return {best, "DRUMHEAD_ISA=" + std::string(wanted) +
                      ": not one of scalar, sse2, avx2, avx512; using " + std::string(name(best))};
  if (*known > best)
    return {best, "DRUMHEAD_ISA=" + std::string(wanted) + ": this processor has only " +
                      std::string(name(best)) + "; using that"};
  return {*known, {}};
}

Choice& choice() {
  static Choice chosen = choose();
  return chosen;
}

}  // namespace

std::string_view name(Isa isa) {
  constexpr std::array<std::string_view, 4> names{"scalar", "sse2", "avx2", "avx512"};
  return names[std::size_t(isa)];
}

std::span<const Isa> available_isas() {
  static const int count = count_available();
  return {kAll.data(), std::size_t(count)};
}

Isa current_isa() { return choice().isa; }

std::string_view forced_isa_error() { return choice().error; }

bool use_isa(Isa isa) {
  if (isa > available_isas().back()) return false;
  choice().isa = isa;
  return true;
}

template <>
const KernelTable<float>& table<float>() {
  static const std::array<const KernelTable<float>*, 4> tables{
      &scalar::float_table, &sse2::float_table, &avx2::float_table, &avx512::float_table};
  return *tables[std::size_t(current_isa())];
}

template <>
const KernelTable<double>& table<double>() {
  static const std::array<const KernelTable<double>*, 4> tables{
      &scalar::double_table, &sse2::double_table, &avx2::double_table, &avx512::double_table};
  return *tables[std::size_t(current_isa())];
}

template <>
const IsotropicTable<float>& isotropic_table<float>() {
  static const std::array<const IsotropicTable<float>*, 4> tables{
      &scalar::isotropic_floats, &sse2::isotropic_floats, &avx2::isotropic_floats,
      &avx512::isotropic_floats};
  return *tables[std::size_t(current_isa())];
}

template <>
const IsotropicTable<double>& isotropic_table<double>() {
  static const std::array<const IsotropicTable<double>*, 4> tables{
      &scalar::isotropic_doubles, &sse2::isotropic_doubles, &avx2::isotropic_doubles,
      &avx512::isotropic_doubles};
  return *tables[std::size_t(current_isa())];
}

}  // namespace drumhead::kernels
