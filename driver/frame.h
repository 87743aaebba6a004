// SPDX-License-Identifier: MIT
#pragma once
// A rectangle of pixels in the picture's frame: pixel (a, b) is centred at (a+½, b+½), the
// picture's first is (0, 0), those of its margin are negative or beyond its size.
#include <drumhead/grid/lattice.h>

#include <cmath>

namespace drumhead::driver {

struct Frame {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Every pixel that the lattice touches: the picture with its margin, the padded domain.
inline Frame padded_frame(const grid::Lattice& lattice) {
  const grid::Point first = lattice.rest_px(0, 0), last = lattice.rest_px(lattice.nx, lattice.ny);
  const int left = int(std::floor(first.x)), top = int(std::floor(first.y));
  return {left, top, int(std::ceil(last.x)) - left, int(std::ceil(last.y)) - top};
}

}  // namespace drumhead::driver
