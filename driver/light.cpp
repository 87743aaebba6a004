// SPDX-License-Identifier: MIT
#include "light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumhead::driver {
namespace {

constexpr int kCodes = 65536;
// Over t = √l the curve 1.055 t^(1/1.2) − 0.055 bends little: linear between 4096 points it is good
// to 3e-8, and a hundred megapixels need no pow.
constexpr int kPoints = 4096;
constexpr float kLinearLight = 0.0031308f;

std::array<float, kCodes> decoding() {
  std::array<float, kCodes> table{};
  for (int k = 0; k < kCodes; ++k) {
    const double e = double(k) / (kCodes - 1);
    const double l = e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
    table[std::size_t(k)] = float(l);
  }
  return table;
}

std::array<float, kPoints + 2> encoding() {
  std::array<float, kPoints + 2> table{};
  for (int k = 0; k < kPoints + 2; ++k) {
    const double t = double(k) / kPoints;
    table[std::size_t(k)] = float(1.055 * std::pow(t, 2 / 2.4) - 0.055);
  }
  return table;
}

// Not a number becomes 0.
float unit(float x) { return x > 0.0f ? std::min(x, 1.0f) : 0.0f; }

}  // namespace

float decode_srgb(float code) {
  static const auto table = decoding();
  return table[std::size_t(unit(code) * (kCodes - 1) + 0.5f)];
}

float encode_srgb(float light) {
  static const auto table = encoding();
  const float l = unit(light);
  if (l <= kLinearLight) return 12.92f * l;
  const float t = std::sqrt(l) * kPoints;
  const auto k = std::size_t(t);
  return table[k] + (t - float(k)) * (table[k + 1] - table[k]);
}

}  // namespace drumhead::driver
