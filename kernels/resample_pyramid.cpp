// SPDX-License-Identifier: MIT
#include "resample_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "resample_threads.h"

namespace drumhead::kernels {
namespace {

constexpr int kTaps = 12, kBefore = 5;  // taps 2a − 5 … 2a + 6 of the finer row make pixel a

std::array<float, kTaps> half_band() {
  std::array<double, kTaps> weight{};
  double sum = 0.0;
  for (int k = 0; k < kTaps; ++k) {
    const double x = M_PI * 0.5 * (k - kBefore - 0.5);
    weight[std::size_t(k)] = 3.0 * std::sin(x) * std::sin(x / 3.0) / (x * x);
    sum += weight[std::size_t(k)];
  }
  std::array<float, kTaps> result{};
  for (int k = 0; k < kTaps; ++k) result[std::size_t(k)] = float(weight[std::size_t(k)] / sum);
  return result;
}

// Columns first: `column` is one row of the finer level after filtering down, with kBefore pixels
// of border before it and kTaps − kBefore after it.
void halve_row(const ImageView& fine, Border border, const std::array<float, kTaps>& weight, int b,
               std::vector<float>& column, float* out, int out_width) {
  const int channels = fine.channels, n = fine.width * channels;
  float* row = column.data() + kBefore * channels;
  std::fill(column.begin(), column.end(), 0.0f);
  for (int k = 0; k < kTaps; ++k) {
    const int y = border_index(2 * b + k - kBefore, fine.height, border);
    if (y < 0) continue;
    const float w = weight[std::size_t(k)];
    const float* in = fine.data + y * fine.row_stride;
    for (int i = 0; i < n; ++i) row[i] += w * in[i];
  }
  for (int a = -kBefore; a < 2 * out_width + kTaps - 1 - kBefore; ++a) {
    if (a == 0) a = fine.width;
    const int from = border_index(a, fine.width, border);
    if (from >= 0) std::copy_n(row + from * channels, channels, row + a * channels);
  }
  std::fill_n(out, out_width * channels, 0.0f);
  for (int a = 0; a < out_width; ++a) {
    for (int k = 0; k < kTaps; ++k) {
      const float* in = row + (2 * a + k - kBefore) * channels;
      for (int c = 0; c < channels; ++c) out[a * channels + c] += weight[std::size_t(k)] * in[c];
    }
  }
}

}  // namespace

int border_index(int i, int n, Border border) {
  if (i >= 0 && i < n) return i;
  if (border == Border::transparent) return -1;
  if (border == Border::clamp) return i < 0 ? 0 : n - 1;
  // Reflected at −½ and n − ½: period 2n.
  const int m = i % (2 * n), k = m < 0 ? m + 2 * n : m;
  return k < n ? k : 2 * n - 1 - k;
}

void Pyramid::build(int threads) {
  const std::array<float, kTaps> weight = half_band();
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const ImageView fine = levels_.back();
    const int width = (fine.width + 1) / 2, height = (fine.height + 1) / 2;
    const std::size_t stride = std::size_t(width) * std::size_t(fine.channels);
    storage_.emplace_back(stride * std::size_t(height));
    float* out = storage_.back().data();
    const std::size_t padded = std::size_t(2 * width + kTaps) * std::size_t(fine.channels);
    std::vector<std::vector<float>> columns(std::size_t(thread_count(threads)),
                                            std::vector<float>(padded));
    for_each_task(height, threads, [&](int b, int thread) {
      halve_row(fine, border_, weight, b, columns[std::size_t(thread)],
                out + std::size_t(b) * stride, width);
    });
    levels_.push_back({out, width, height, fine.channels, std::ptrdiff_t(stride)});
  }
}

}  // namespace drumhead::kernels
