// SPDX-License-Identifier: MIT
#pragma once
// Output pixel → source position for one tile of pixels, by exact inversion of every deformed cell
// that meets it. A cell maps (s, t) ∈ [0, 1]² to x00 + s e + t f + s t g. With h = x − x00 and ×
// the 2D cross product, eliminating s or t leaves
//
//     A_t t² − q_t t + C_t = 0,   A_t = f×g,  q_t = e×f − g×h,  C_t = e×h,
//     A_s s² − q_s s + C_s = 0,   A_s = g×e,  q_s = e×f + g×h,  C_s = h×f,
//
// whose discriminant D = q_t² − 4 A_t C_t = q_s² − 4 A_s C_s is the same, and J at a root is ±√D,
// the same sign for s and t. So the point with J > 0 is t = (q_t − √D)/2A_t = 2C_t/(q_t + √D), the
// one with J < 0 has −√D; of the two quotients the one that does not cancel is taken, which covers
// parallelograms (A = 0), trapezia and cells turned inside out alike. A triangle is a linear
// system.
#include <cstdint>

#include "resample_boxes.h"

namespace drumhead::kernels {

/// The backward map of kSide × kSide output pixels (or less) whose first is (left, top).
struct TileMap {
  static constexpr int kSide = 64;
  static constexpr int kPixels = kSide * kSide;

  int left = 0, top = 0, width = 0, height = 0;  // width, height ≤ kSide; row stride kSide
  Position source[kPixels];
  float jacobian[kPixels][4];
  // How the best point so far ranks, in this order: how far (s, t) of it misses the unit square,
  // whether J > 0 there, and its cell j·nx + i.
  float miss[kPixels];
  signed char side[kPixels];  // as BackwardMapTarget::side
  std::int32_t cell[kPixels];
};

/// Fills source, jacobian and side of the tile at tile.left, top, width, height.
void invert_tile(const LatticeMapView& map, const BoxTree& tree, TileMap& tile);

}  // namespace drumhead::kernels
