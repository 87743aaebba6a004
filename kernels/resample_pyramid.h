// SPDX-License-Identifier: MIT
#pragma once
// The source picture and its half-sized prefiltered copies. A pixel of level l is centred at (a+½)
// 2ˡ of the source; odd sizes round up, the last pixel reaching past the edge by less than one of
// its own width. Each level is the one below through Lanczos 3 stretched by two (12 taps a
// direction): flat to within 1.2 % over the half of its band that a footprint of radius ≥ 2 reads.
// (A stretched Catmull–Rom droops by 6 % there, which shows as a step where the level changes.)
#include <cstddef>
#include <vector>

#include <drumhead/kernels/resample.h>

namespace drumhead::kernels {

/// Index of pixel i of a row of n under the border's rule, −1 where there is none.
int border_index(int i, int n, Border border);

class Pyramid {
 public:
  Pyramid(const ImageView& source, Border border) : border_(border), levels_{source} {}

  /// Adds all levels down to one pixel; a third of the source's size.
  void build(int threads);

  Border border() const { return border_; }
  int levels() const { return int(levels_.size()); }
  const ImageView& level(int l) const { return levels_[std::size_t(l)]; }

 private:
  Border border_;
  std::vector<ImageView> levels_;
  std::vector<std::vector<float>> storage_;
};

}  // namespace drumhead::kernels
