// SPDX-License-Identifier: MIT
#pragma once
// What callers of resample.h may get wrong, refused before anything is read or written.
#include <drumhead/kernels/refuse.h>
#include <drumhead/kernels/resample.h>

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace drumhead::kernels {

template <class T>
void require(bool holds, const char* what, T value, std::string_view bound) {
  if (!holds) refuse(what, value, std::string(bound));
}

inline void require(const void* pointer, const char* what) {
  require(pointer != nullptr, what, "null", "an array");
}

inline void check_threads(int threads) { require(threads >= 0, "threads", threads, "at least 0"); }

inline void check(const LatticeMapView& map) {
  require(map.nx >= 1, "nx of the lattice map", map.nx, "at least 1");
  require(map.ny >= 1, "ny of the lattice map", map.ny, "at least 1");
  const double cells = double(map.nx) * map.ny;
  require(cells < std::numeric_limits<int>::max(), "nx·ny of the lattice map", cells, "below 2³¹");
  require(map.cell_px > 0.0 && std::isfinite(map.cell_px), "cell_px of the lattice map",
          map.cell_px, "positive and finite");
  require(std::isfinite(map.origin_px.x), "origin_px.x of the lattice map", map.origin_px.x,
          "finite");
  require(std::isfinite(map.origin_px.y), "origin_px.y of the lattice map", map.origin_px.y,
          "finite");
  require(map.u, "u of the lattice map");
  require(map.v, "v of the lattice map");
  if (!map.split.row_begin) return;
  require(map.split.column, "split.column of the lattice map");
  require(map.split.triangle_begin, "split.triangle_begin of the lattice map");
  require(map.split.triangle, "split.triangle of the lattice map");
}

inline void check(const ImageView& source) {
  require(source.width >= 1, "width of the source", source.width, "at least 1");
  require(source.height >= 1, "height of the source", source.height, "at least 1");
  require(source.channels >= 1, "channels of the source", source.channels, "at least 1");
  const std::ptrdiff_t row = std::ptrdiff_t(source.width) * source.channels;
  require(source.row_stride >= row, "row_stride of the source", source.row_stride,
          "at least width·channels = " + std::to_string(row));
  require(source.data, "data of the source");
}

inline void check(const ResampleOptions& options) {
  require(options.detail >= 1.0 && options.detail <= 16.0, "detail", options.detail, "1…16");
  require(options.anisotropy >= 1.0 && options.anisotropy <= 64.0, "anisotropy", options.anisotropy,
          "1…64");
  check_threads(options.threads);
}

/// `pixel`: values of one.
inline void check_rectangle(int width, int height, std::ptrdiff_t row_stride, int pixel) {
  require(width >= 0, "width of the target", width, "at least 0");
  require(height >= 0, "height of the target", height, "at least 0");
  const std::ptrdiff_t row = std::ptrdiff_t(width) * pixel;
  require(row_stride >= row, "row_stride of the target", row_stride,
          "at least " + std::to_string(row));
}

inline void check(const ImageTarget& out, int channels) {
  require(out.channels == channels, "channels of the target", out.channels,
          "the source's " + std::to_string(channels));
  check_rectangle(out.width, out.height, out.row_stride, channels);
  if (out.width > 0 && out.height > 0) require(out.data, "data of the target");
}

inline void check(const ForwardMapTarget& out) {
  check_rectangle(out.width, out.height, out.row_stride, 1);
  if (out.width > 0 && out.height > 0) require(out.output, "output of the target");
}

}  // namespace drumhead::kernels
