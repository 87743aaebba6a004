// SPDX-License-Identifier: MIT
#include "maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "float_exr.h"

namespace drumhead::driver {
namespace {

using kernels::Position;

constexpr std::array<std::string_view, 3> kNames = {"st", "pixel", "displacement"};

struct Written {
  float r = 0.0f, g = 0.0f;
};

/// Position ↔ what stands in the file at the pixel whose centre is `at`.
class Code {
 public:
  explicit Code(const MapFormat& format) : format_(format) {}

  Written written(Position at, Position to) const {
    switch (format_.convention) {
      case MapConvention::st:
        return {float(to.x / format_.width), float(1.0 - to.y / format_.height)};
      case MapConvention::pixel:
        return {float(to.x - 0.5), float(to.y - 0.5)};
      case MapConvention::displacement:
        break;
    }
    return {float(to.x - at.x), float(to.y - at.y)};
  }
  Position read(Position at, Written file) const {
    switch (format_.convention) {
      case MapConvention::st:
        return {double(file.r) * format_.width, (1.0 - double(file.g)) * format_.height};
      case MapConvention::pixel:
        return {double(file.r) + 0.5, double(file.g) + 0.5};
      case MapConvention::displacement:
        break;
    }
    return {at.x + double(file.r), at.y + double(file.g)};
  }
  /// As a reader of the file sees `to`.
  Position rounded(Position at, Position to) const { return read(at, written(at, to)); }

 private:
  MapFormat format_;
};

Position centre(const Frame& frame, int a, int b) {
  return {frame.left + a + 0.5, frame.top + b + 0.5};
}

std::string described(MapConvention convention, bool backward) {
  const std::string what =
      backward ? "backward map: for every output pixel, the source position (x, y) of its centre; "
               : "forward map: for every source pixel, the output position (x, y) of its centre; ";
  switch (convention) {
    case MapConvention::st:
      return what +
             "R = x / W, G = 1 - y / H of the display window W x H: 0 to 1, pixel centres at "
             "(i + 1/2) / W, G up (x right, y down, 0 at the left and top edge)";
    case MapConvention::pixel:
      return what + "R = x, G = y in pixels, x right, y down, pixel centres at integers";
    case MapConvention::displacement:
      break;
  }
  return what + "R = x minus that centre's x, G likewise, in pixels, x right, y down";
}

/// positions(first, rows, to): the map's rows as Positions.
template <class Rows>
void write_map(const MapFormat& format, bool backward, const std::filesystem::path& file,
               const MapProgress& progress, const Rows& positions) {
  const Frame& frame = format.frame;
  const FloatExr exr{.data = frame,
                     .display = {0, 0, format.width, format.height},
                     .channels = {"R", "G"},
                     .header = {{"ImageDescription", described(format.convention, backward)},
                                {"drumhead:map", backward ? "backward" : "forward"},
                                {"drumhead:convention", std::string(name(format.convention))}}};
  const Code code(format);
  std::vector<Position> to;
  write_float_exr(exr, file, [&](int first, int rows, float* pixels) {
    to.resize(std::size_t(rows) * std::size_t(frame.width));
    positions(first, rows, to.data());
    const Position* next = to.data();
    for (int b = first; b < first + rows; ++b) {
      for (int a = 0; a < frame.width; ++a) {
        const auto [r, g] = code.written(centre(frame, a, b), *next++);
        *pixels++ = r;
        *pixels++ = g;
      }
    }
    if (progress) progress(double(first + rows) / frame.height);
  });
}

/// The forward map's file between its pixels.
class ForwardSampler {
 public:
  ForwardSampler(const kernels::LatticeMapView& map, const MapFormat& format)
      : map_(map), frame_(format.frame), code_(format) {}

  /// Nothing outside the frame's centres and where the four pixels are folded.
  std::optional<Position> at(Position source) const {
    const double x = source.x - 0.5 - frame_.left, y = source.y - 0.5 - frame_.top;
    const double i = std::floor(x), j = std::floor(y), s = x - i, t = y - j;
    if (!(i >= 0 && j >= 0 && i + 1 < frame_.width && j + 1 < frame_.height)) return {};
    const Position p00 = pixel(int(i), int(j)), p10 = pixel(int(i) + 1, int(j));
    const Position p01 = pixel(int(i), int(j) + 1), p11 = pixel(int(i) + 1, int(j) + 1);
    const bool upright = turn(p00, p10, p01) > 0 && turn(p10, p11, p00) > 0 &&
                         turn(p01, p00, p11) > 0 && turn(p11, p01, p10) > 0;
    if (!upright) return {};
    const auto blend = [&](double v00, double v10, double v01, double v11) {
      return (1 - t) * ((1 - s) * v00 + s * v10) + t * ((1 - s) * v01 + s * v11);
    };
    return Position{blend(p00.x, p10.x, p01.x, p11.x), blend(p00.y, p10.y, p01.y, p11.y)};
  }

 private:
  Position pixel(int a, int b) const {
    const Position at = centre(frame_, a, b);
    return code_.rounded(at, kernels::forward_position(map_, at));
  }
  /// (q − p) × (r − p)
  static double turn(Position p, Position q, Position r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  }

  kernels::LatticeMapView map_;
  Frame frame_;
  Code code_;
};

/// RMS and maximum of distances.
class Distances {
 public:
  void add(Position a, Position b) {
    const double d = std::hypot(a.x - b.x, a.y - b.y);
    squares_ += d * d;
    max_ = std::max(max_, d);
    ++count_;
  }
  double rms() const { return count_ ? std::sqrt(squares_ / double(count_)) : 0.0; }
  double max() const { return max_; }

 private:
  double squares_ = 0.0, max_ = 0.0;
  std::int64_t count_ = 0;
};

}  // namespace

std::string_view name(MapConvention convention) { return kNames[std::size_t(convention)]; }

std::optional<MapConvention> map_convention(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return {};
  return MapConvention(found - kNames.begin());
}

void write_backward_map(const kernels::LatticeMapView& map, const MapFormat& format, int threads,
                        const std::filesystem::path& file, const MapProgress& progress) {
  const Frame& w = format.frame;
  write_map(format, true, file, progress, [&](int first, int rows, Position* to) {
    kernels::backward_map(
        map, {to, nullptr, nullptr, w.width, rows, w.width, w.left, w.top + first}, threads);
  });
}

void write_forward_map(const kernels::LatticeMapView& map, const MapFormat& format, int threads,
                       const std::filesystem::path& file, const MapProgress& progress) {
  const Frame& w = format.frame;
  write_map(format, false, file, progress, [&](int first, int rows, Position* to) {
    kernels::forward_map(map, {to, w.width, rows, w.width, w.left, w.top + first}, threads);
  });
}

RoundTrip round_trip(const kernels::LatticeMapView& map, const MapFormat& format, int threads,
                     const MapProgress& progress) {
  constexpr int kRows = 256;
  const Frame& w = format.frame;
  const Code code(format);
  const ForwardSampler forward(map, format);
  Distances exact, sampled;
  RoundTrip result;
  std::vector<Position> source(std::size_t(kRows) * std::size_t(w.width));
  std::vector<signed char> side(source.size());
  for (int first = 0; first < w.height; first += kRows) {
    const int rows = std::min(kRows, w.height - first);
    kernels::backward_map(
        map, {source.data(), nullptr, side.data(), w.width, rows, w.width, w.left, w.top + first},
        threads);
    std::size_t k = 0;
    for (int b = first; b < first + rows; ++b) {
      for (int a = 0; a < w.width; ++a, ++k) {
        if (side[k] <= 0) continue;
        const Position at = centre(w, a, b), from = code.rounded(at, source[k]);
        exact.add(kernels::forward_position(map, from), at);
        if (const auto there = forward.at(from)) sampled.add(*there, at);
      }
    }
    if (progress) progress(double(first + rows) / w.height);
  }
  result.rms_px = exact.rms();
  result.max_px = exact.max();
  result.sampled_rms_px = sampled.rms();
  result.sampled_max_px = sampled.max();
  return result;
}

}  // namespace drumhead::driver
