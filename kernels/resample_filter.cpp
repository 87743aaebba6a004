// SPDX-License-Identifier: MIT
#include "resample_filter.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "resample_footprint.h"

namespace drumhead::kernels {
namespace {

constexpr int kLanes =
    8;  // taps are weighed in groups of this many, so that every width vectorises
constexpr int kChunk = 64;  // taps of a row at a time

using Four = float __attribute__((vector_size(16)));

inline Four load_four(const float* from) {
  Four four;
  std::memcpy(&four, from, sizeof four);
  return four;
}

// ⌊x⌋ and ⌈x⌉ of moderate numbers, without the library calls of plain SSE2.
inline int floor_int(double x) {
  const int i = int(x);
  return i - (double(i) > x);
}
inline int ceil_int(double x) { return -floor_int(-x); }

// Samples C neighbouring channels, from `channel` on, of the pyramid's levels. If the picture has
// just these (kPacked), its rows are read in place, otherwise through a packed copy of the pixels
// in question.
template <int C, bool kPacked>
class Sampler {
 public:
  Sampler(const Pyramid& pyramid, const FilterBounds& bounds, int channel)
      : pyramid_(pyramid), bounds_(bounds), channel_(channel) {}

  void sample(Position p, const float (&jacobian)[4], float* out) const {
    const Footprint filter = footprint(jacobian, bounds_.anisotropy);
    if (filter.plain) return bicubic(p, out);
    if (filter.least <= kBlendFrom * bounds_.detail) return weigh(filter, p, 0, out);
    int level = 0;
    // least = detail·m·2^level with m in [1, 2), or below that level 0.
    const float m = 2.0f * std::frexp(filter.least / bounds_.detail, &level);
    const int fine = std::clamp(level - 1, 0, pyramid_.levels() - 1);
    const int coarse = std::clamp(level, 0, pyramid_.levels() - 1);
    weigh(filter, p, fine, out);
    if (m <= kBlendFrom || coarse == fine) return;
    float other[C];
    weigh(filter, p, coarse, other);
    const float share = (m - kBlendFrom) / (2.0f - kBlendFrom);
    for (int c = 0; c < C; ++c) out[c] += share * (other[c] - out[c]);
  }

 private:
  // n ≤ kChunk pixels of a row from (x, y) on, packed; `copy` is used where they are not in one
  // piece.
  const float* window(const ImageView& image, int x, int y, int n, float* copy) const {
    const bool inside = x >= 0 && x + n <= image.width && y >= 0 && y < image.height;
    if (kPacked && inside) return image.data + y * image.row_stride + std::ptrdiff_t(x) * C;
    gather(image, x, y, n, copy);
    return copy;
  }

  void gather(const ImageView& image, int x, int y, int n, float* copy) const {
    const int row = border_index(y, image.height, pyramid_.border());
    for (int k = 0; k < n; ++k) {
      const int column = border_index(x + k, image.width, pyramid_.border());
      for (int c = 0; c < C; ++c) {
        copy[k * C + c] = row < 0 || column < 0
                              ? 0.0f
                              : image.data[row * image.row_stride +
                                           std::ptrdiff_t(column) * image.channels + channel_ + c];
      }
    }
  }

  static void add_taps(const float* weight, const float* in, int n, float* sum) {
    if constexpr (C == 3 || C == 4) {
      add_pixels(weight, in, n, sum);
    } else {
      float row[C] = {};
      for (int k = 0; k < n; ++k) {
        for (int c = 0; c < C; ++c) row[c] += weight[k] * in[k * C + c];
      }
      for (int c = 0; c < C; ++c) sum[c] += row[c];
    }
  }

  // A pixel a register. Left to itself the compiler takes taps for lanes and shuffles the channels
  // apart, which takes 1.2 times as long. Three channels read the next pixel's first as a fourth,
  // which is dropped; the last pixel, after which the picture may end, is copied.
  static void add_pixels(const float* weight, const float* in, int n, float* sum) {
    Four even{}, odd{}, last{};
    const int whole = C == 3 ? n - 1 : n;
    int k = 0;
    for (; k + 2 <= whole; k += 2) {
      even += weight[k] * load_four(in + k * C);
      odd += weight[k + 1] * load_four(in + (k + 1) * C);
    }
    if (k < whole) even += weight[k] * load_four(in + k * C);
    if (whole < n) {
      std::memcpy(&last, in + whole * C, C * sizeof(float));
      odd += weight[whole] * last;
    }
    even += odd;
    for (int c = 0; c < C; ++c) sum[c] += even[c];
  }

  void bicubic(Position p, float* out) const {
    const ImageView& image = pyramid_.level(0);
    const double x = p.x - 0.5, y = p.y - 0.5;
    const int x0 = floor_int(x), y0 = floor_int(y);
    const float dx = float(x - x0), dy = float(y - y0);
    float copy[4 * C];
    if (dx == 0.0f && dy == 0.0f) {
      std::copy_n(window(image, x0, y0, 1, copy), C, out);
      return;
    }
    float wx[4], wy[4];
    for (int k = 0; k < 4; ++k) {
      wx[k] = catmull_rom_16(float(k - 1) - dx) / 16.0f;
      wy[k] = catmull_rom_16(float(k - 1) - dy) / 16.0f;
    }
    float sum[C] = {};
    for (int k = 0; k < 4; ++k) {
      float row[C] = {};
      add_taps(wx, window(image, x0 - 1, y0 - 1 + k, 4, copy), 4, row);
      for (int c = 0; c < C; ++c) sum[c] += wy[k] * row[c];
    }
    std::copy_n(sum, C, out);
  }

  // A footprint on one level of the pyramid, in that level's pixels.
  struct Taps {
    double cx, cy;       // centre, in pixel indices
    float xx, xy, yy;    // S⁻¹
    int x0, x1, y0, y1;  // its box, inclusive
  };

  Taps taps(const Footprint& filter, Position p, int level) const {
    const float size = float(1 << level), scale = 1.0f / size;
    const double cx = p.x * scale - 0.5, cy = p.y * scale - 0.5;
    const float reach_x = filter.reach_x * scale, reach_y = filter.reach_y * scale;
    return {cx,
            cy,
            filter.inv_xx * size,
            filter.inv_xy * size,
            filter.inv_yy * size,
            ceil_int(cx - reach_x),
            floor_int(cx + reach_x),
            ceil_int(cy - reach_y),
            floor_int(cy + reach_y)};
  }

  // The footprint's weighted mean over one level of the pyramid.
  void weigh(const Footprint& filter, Position p, int level, float* out) const {
    const Taps t = taps(filter, p, level);
    float sum[C] = {}, weights = 0.0f;
    if (t.x1 - t.x0 < kLanes) {
      add_narrow(pyramid_.level(level), t, sum, weights);
    } else {
      add_wide(pyramid_.level(level), t, sum, weights);
    }
    for (int c = 0; c < C; ++c) out[c] = sum[c] / weights;
  }

  // At most kLanes taps a row, which is the common case: the box whole, weights vanishing outside.
  void add_narrow(const ImageView& image, const Taps& t, float* sum, float& weights) const {
    const int n = t.x1 - t.x0 + 1;
    float u[kLanes], v[kLanes], weight[kLanes], column[kLanes] = {}, copy[kLanes * C];
    for (int k = 0; k < kLanes; ++k) {
      const float dx = float(t.x0 - t.cx) + float(k);
      u[k] = t.xx * dx;
      v[k] = t.xy * dx;
    }
    for (int y = t.y0; y <= t.y1; ++y) {
      const float dy = float(y - t.cy), u0 = t.xy * dy, v0 = t.yy * dy;
      for (int k = 0; k < kLanes; ++k) {
        weight[k] = catmull_rom_16(u[k] + u0) * catmull_rom_16(v[k] + v0);
        column[k] += weight[k];
      }
      add_taps(weight, window(image, t.x0, y, n, copy), n, sum);
    }
    for (int k = 0; k < n; ++k) weights += column[k];
  }

  // Any footprint: of each row of the box only the taps within it.
  void add_wide(const ImageView& image, const Taps& t, float* sum, float& weights) const {
    const float per_xx = 1.0f / t.xx, per_xy = t.xy != 0.0f ? 1.0f / std::abs(t.xy) : 0.0f;
    for (int y = t.y0; y <= t.y1; ++y) {
      const float dy = float(y - t.cy), u0 = t.xy * dy, v0 = t.yy * dy;
      // |xx dx + u0| ≤ 2 and |xy dx + v0| ≤ 2: an interval of dx each.
      float from = (-2.0f - u0) * per_xx, to = (2.0f - u0) * per_xx;
      if (per_xy > 0.0f) {
        const float middle = -(t.xy > 0.0f ? v0 : -v0) * per_xy, half = 2.0f * per_xy;
        from = std::max(from, middle - half);
        to = std::min(to, middle + half);
      }
      const int x0 = ceil_int(t.cx + from), x1 = floor_int(t.cx + to);
      for (int x = x0; x <= x1; x += kChunk) {
        add_chunk(image, t, x, y, std::min(kChunk, x1 - x + 1), sum, weights);
      }
    }
  }

  void add_chunk(const ImageView& image, const Taps& t, int x, int y, int n, float* sum,
                 float& weights) const {
    float weight[kChunk], copy[kChunk * C];
    const float dx = float(x - t.cx), dy = float(y - t.cy);
    const float u0 = t.xx * dx + t.xy * dy, v0 = t.xy * dx + t.yy * dy;
    for (int begin = 0; begin < n; begin += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const float k = float(begin + lane);
        weight[begin + lane] = catmull_rom_16(u0 + k * t.xx) * catmull_rom_16(v0 + k * t.xy);
      }
    }
    add_taps(weight, window(image, x, y, n, copy), n, sum);
    for (int k = 0; k < n; ++k) weights += weight[k];
  }

  const Pyramid& pyramid_;
  const FilterBounds bounds_;
  const int channel_;
};

template <int C, bool kPacked>
void filter_channels(const Pyramid& pyramid, const FilterBounds& bounds, int channel,
                     const TileMap& tile, float* out, std::ptrdiff_t row_stride) {
  const Sampler<C, kPacked> sampler(pyramid, bounds, channel);
  const int channels = kPacked ? C : pyramid.level(0).channels;
  for (int b = 0; b < tile.height; ++b) {
    float* pixel = out + b * row_stride + channel;
    for (int a = 0; a < tile.width; ++a, pixel += channels) {
      const int k = b * TileMap::kSide + a;
      sampler.sample(tile.source[k], tile.jacobian[k], pixel);
    }
  }
}

}  // namespace

void filter_tile(const Pyramid& pyramid, const FilterBounds& bounds, const TileMap& tile,
                 float* out, std::ptrdiff_t row_stride) {
  const int channels = pyramid.level(0).channels;
  switch (channels) {
    case 1:
      return filter_channels<1, true>(pyramid, bounds, 0, tile, out, row_stride);
    case 2:
      return filter_channels<2, true>(pyramid, bounds, 0, tile, out, row_stride);
    case 3:
      return filter_channels<3, true>(pyramid, bounds, 0, tile, out, row_stride);
    case 4:
      return filter_channels<4, true>(pyramid, bounds, 0, tile, out, row_stride);
    default:
      break;
  }
  // More are rare (an alpha beside a matte, say): four at a time, weighed anew for each group.
  int channel = 0;
  for (; channel + 4 <= channels; channel += 4) {
    filter_channels<4, false>(pyramid, bounds, channel, tile, out, row_stride);
  }
  for (; channel < channels; ++channel) {
    filter_channels<1, false>(pyramid, bounds, channel, tile, out, row_stride);
  }
}

}  // namespace drumhead::kernels
