// SPDX-License-Identifier: MIT
#pragma once
// The filter of one output pixel: its Jacobian M = ∂(source)/∂(output) to the symmetric stretch
// S = U prefilter(Σ) Uᵀ, whose image of the kernel's square [−2, 2]² is the footprint. Of the polar
// decomposition M = (U Σ Uᵀ)(U Vᵀ) the rotation is left out on purpose: with it a rotated picture
// would be interpolated along axes that are not the source's, where Catmull–Rom neither
// interpolates nor sums to 1.
#include <algorithm>
#include <cmath>

namespace drumhead::kernels {

/// Sixteen times Catmull–Rom, support [−2, 2], as truncated powers of the distances to ±2 and ±1:
/// c = p² (p−1)/2 + r² (1−2r). z + |z| is 2 max(z, 0); written so, the compiler sees no branch and
/// vectorises without leave to reorder floating-point traps (with std::max a footprint takes 1.7
/// times as long).
inline float catmull_rom_16(float x) {
  const float d = std::abs(x), near_two = 2.0f - d, near_one = 1.0f - d;
  const float p = near_two + std::abs(near_two), r = near_one + std::abs(near_one);  // twice p, r
  return p * p * (p - 2.0f) + r * r * (4.0f - 4.0f * r);
}

/// Compression up to here is not prefiltered: Catmull–Rom, soft near the band's end, has then let
/// through hardly anything that could alias, and most pixels of a moderate warp take a third of the
/// time.
constexpr float kPlain = 1.125f;

/// The kernel's stretch for a compression by sigma: 1 up to kPlain, sigma from 2 kPlain − 1 on, a
/// line of slope 2 between.
inline float prefilter(float sigma) {
  return std::max(1.0f, std::min(sigma, 1.0f + 2.0f * (sigma - kPlain)));
}

struct Footprint {
  bool plain = true;   ///< S = 1
  float least = 1.0f;  ///< σ2 after max and the bound on anisotropy: radius across, source pixels
  float reach_x = 2.0f, reach_y = 2.0f;               ///< half sides of the footprint's box
  float inv_xx = 1.0f, inv_xy = 0.0f, inv_yy = 1.0f;  ///< S⁻¹
};

inline Footprint footprint(const float (&jacobian)[4], float anisotropy) {
  const float xa = jacobian[0], xb = jacobian[1], ya = jacobian[2], yb = jacobian[3];
  // M Mᵀ = mean·1 + [c d; d −c]: eigenvalues mean ± dev, eigenvectors at half the angle of (c, d).
  const float xx = xa * xa + xb * xb, yy = ya * ya + yb * yb, d = xa * ya + xb * yb;
  const float mean = 0.5f * (xx + yy), c = 0.5f * (xx - yy), dev_squared = c * c + d * d;
  const float room = kPlain * kPlain - mean;
  Footprint result;
  if (room >= 0.0f && dev_squared <= room * room) return result;
  result.plain = false;
  const float dev = std::sqrt(dev_squared), sigma1 = std::sqrt(mean + dev);
  const float sigma2 = std::abs(xa * yb - xb * ya) / sigma1;
  const float s1 = prefilter(sigma1), s2 = std::max(prefilter(sigma2), s1 / anisotropy);
  const float half = 0.5f * (s1 + s2), split = dev > 0.0f ? 0.5f * (s1 - s2) / dev : 0.0f;
  const float S_xx = half + split * c, S_yy = half - split * c, S_xy = split * d;
  const float inv = 1.0f / (s1 * s2);
  result.least = s2;
  result.reach_x = 2.0f * (S_xx + std::abs(S_xy));
  result.reach_y = 2.0f * (S_yy + std::abs(S_xy));
  result.inv_xx = S_yy * inv;
  result.inv_yy = S_xx * inv;
  result.inv_xy = -S_xy * inv;
  return result;
}

}  // namespace drumhead::kernels
