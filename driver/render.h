// SPDX-License-Identifier: MIT
#pragma once
// The picture through the solution.
#include <drumhead/grid/lattice.h>
#include <drumhead/kernels/resample.h>
#include <drumhead/multigrid/warp.h>

#include "frame.h"
#include "image.h"

namespace drumhead::driver {

/// The picture's own frame, or with `expand` the whole padded domain's. Throws
/// std::invalid_argument where a side would have more than 65535 pixels.
Frame frame_of(const Image& picture, const grid::Lattice& lattice, bool expand);

/// The warped picture, in bands of rows. The filter overshoots at edges; each channel is clamped to
/// the range that it had.
class Renderer {
 public:
  /// Both must outlive it.
  Renderer(const Image& picture, const multigrid::Solution& solution, const Frame& frame,
           kernels::Border border, int threads);

  /// Of the whole output; in OpenEXR's terms its data window is the frame, its display window the
  /// picture's.
  const OIIO::ImageSpec& spec() const { return spec_; }
  bool decoded() const { return decoded_; }
  /// Rows top … top + height − 1 of the frame, as Image holds them.
  std::vector<float> rows(int top, int height) const;

 private:
  struct Range {
    float least, greatest;
  };

  const Frame frame_;
  OIIO::ImageSpec spec_;
  const bool decoded_;
  const kernels::Resampler resampler_;
  std::vector<Range> ranges_;
};

}  // namespace drumhead::driver
