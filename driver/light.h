// SPDX-License-Identifier: MIT
#pragma once
// What a channel's number means: sRGB's transfer curve (IEC 61966-2-1) between the code e that a
// file holds and light l, both 0…1 for black…white,
//
//     l = e/12.92 for e ≤ 0.04045, else ((e + 0.055)/1.055)^2.4,
//
// and colours weighted by alpha.
#include "image.h"

namespace drumhead::driver {

/// l of e, for codes of at most 16 bits; others are rounded to the nearest such. Below 0 as 0,
/// above 1 as 1, not a number as 0.
float decode_srgb(float code);

/// e of l, to 1e-6: a 16-bit code that was decoded comes back. Below 0 as 0, above 1 as 1, not a
/// number as 0.
float encode_srgb(float light);

/// Calls colour(value, alpha) for every value of `pixels` that alpha weights: all but alpha itself
/// and depth. Without an alpha channel, alpha is 1.
template <class Colour>
void for_each_colour(const OIIO::ImageSpec& spec, std::vector<float>& pixels,
                     const Colour& colour) {
  const int channels = spec.nchannels, alpha = spec.alpha_channel;
  for (std::size_t p = 0; p < pixels.size(); p += std::size_t(channels)) {
    const float a = alpha >= 0 ? pixels[p + std::size_t(alpha)] : 1.0f;
    for (int c = 0; c < channels; ++c) {
      if (c != alpha && c != spec.z_channel) colour(pixels[p + std::size_t(c)], a);
    }
  }
}

/// value·alpha.
inline void multiply_alpha(float& value, float alpha) { value *= alpha; }

/// value/alpha. Where alpha is 0 nothing is known of the colour: it is 0.
inline void divide_alpha(float& value, float alpha) { value = alpha > 0 ? value / alpha : 0.0f; }

}  // namespace drumhead::driver
