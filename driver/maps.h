// SPDX-License-Identifier: MIT
#pragma once
// The warp as maps that other programs sample by, float32 EXR with channels R (horizontal) and G
// (vertical). The backward map says for each output pixel from which source position its centre
// came (what samplers take), the forward map for each source pixel to which output position its
// centre goes. A position (x, y) in continuous picture pixels (0 at the left and top edge, y down)
// of a picture W × H, seen from pixel (a, b), is written as
//
//     st            R = x/W, G = 1 − y/H     0…1; pixel centres at (i+½)/W; up, as STMap takes it
//     pixel         R = x − ½, G = y − ½     pixel centres at integers, y down
//     displacement  R = x − a − ½, G = y − b − ½     pixels, y down
//
// and the file's header says so. The display window is the picture, the data window may be the
// whole padded domain; W and H are the picture's then too. Where no lattice is, a map is the
// identity; where the output is folded, the backward map follows the resampler's rule (resample.h).
#include <drumhead/kernels/resample.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "frame.h"

namespace drumhead::driver {

enum class MapConvention { st, pixel, displacement };

/// As it is called in flags and headers.
std::string_view name(MapConvention convention);
std::optional<MapConvention> map_convention(std::string_view name);

struct MapFormat {
  MapConvention convention = MapConvention::st;
  int width = 1, height = 1;  ///< of the picture
  Frame frame;                ///< pixels that the map holds: its data window
};

/// Hears of the share that is done, now and then.
using MapProgress = std::function<void(double done)>;

/// In bands: beside the warp they need some 50 MB, however large the frame is. Throws
/// std::runtime_error naming `file`, as the next.
void write_backward_map(const kernels::LatticeMapView& map, const MapFormat& format, int threads,
                        const std::filesystem::path& file, const MapProgress& progress = {});
void write_forward_map(const kernels::LatticeMapView& map, const MapFormat& format, int threads,
                       const std::filesystem::path& file, const MapProgress& progress = {});

/// Distance of forward(backward(centre)) from the centre, in pixels, over the output pixels of the
/// frame that have a source with J > 0. The backward map is taken as the file rounds it.
struct RoundTrip {
  /// The warp itself as forward: what float32 and the inversion lose.
  double rms_px = 0.0, max_px = 0.0;
  /// The forward map of the same frame, bilinear between its pixels: what a user of both files
  /// gets. Over the pixels whose source lies between four pixels of the forward map that are not
  /// folded.
  double sampled_rms_px = 0.0, sampled_max_px = 0.0;
};
RoundTrip round_trip(const kernels::LatticeMapView& map, const MapFormat& format, int threads,
                     const MapProgress& progress = {});

}  // namespace drumhead::driver
