// SPDX-License-Identifier: MIT
#pragma once
// What the tests of the kernels run over: both number types, all instruction sets, and lattices of
// every parity and shape with every kind of membrane.
#include <array>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include "random_fields.h"

namespace drumhead::fields {

using Numbers = testing::Types<float, double>;
struct NumberName {
  template <class T>
  static std::string GetName(int) {
    return std::is_same_v<T, float> ? "float" : "double";
  }
};

/// Error of a few dozen operations relative to the largest value of a field.
template <class T>
constexpr double kRounding = std::is_same_v<T, float> ? 1e-5 : 1e-12;

inline std::string describe(const LevelSpec& spec) {
  constexpr std::array<const char*, 3> kappa{"constant", "per cell", "infinite"};
  return std::to_string(spec.nx) + " x " + std::to_string(spec.ny) + ", spacing " +
         std::to_string(spec.spacing) + (spec.pressure ? ", kappa " : ", no pressures, kappa ") +
         kappa[std::size_t(spec.kappa)] + (spec.mu_cells ? ", mu per cell" : "") + ", " +
         std::to_string(spec.cuts) + " cuts";
}

template <class F>
void on_every_isa(F&& body) {
  for (const kernels::Isa isa : kernels::available_isas()) {
    const ForcedIsa forced(isa);
    SCOPED_TRACE(std::string(kernels::name(isa)));
    body();
  }
}

/// body(spec) for small lattices, each with every kind of membrane, at three spacings.
template <class F>
void for_small_lattices(LevelSpec base, F&& body) {
  constexpr std::array<std::array<int, 2>, 7> sizes{
      {{2, 2}, {3, 2}, {5, 5}, {4, 7}, {8, 6}, {17, 9}, {9, 18}}};
  unsigned seed = base.seed;
  for (const LevelSpec& membrane : membranes())
    for (const auto& [nx, ny] : sizes)
      for (const double spacing : {1.0, 2.0, 4.0}) {
        LevelSpec spec = base;
        spec.nx = nx;
        spec.ny = ny;
        spec.pressure = membrane.pressure;
        spec.mu_cells = membrane.mu_cells;
        spec.kappa = membrane.kappa;
        spec.spacing = spacing;
        spec.seed = ++seed;
        SCOPED_TRACE(describe(spec));
        body(spec);
      }
}

}  // namespace drumhead::fields
