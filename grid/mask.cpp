// SPDX-License-Identifier: MIT
#include <drumhead/grid/mask.h>

#include <drumhead/kernels/refuse.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace drumhead::grid {
namespace {

using kernels::refuse;

void check(const Mask& mask, bool zero_allowed) {
  if (mask.width < 1 || mask.height < 1 ||
      mask.grey.size() != std::size_t(mask.width) * std::size_t(mask.height))
    throw std::invalid_argument("mask of " + std::to_string(mask.width) + " × " +
                                std::to_string(mask.height) + " pixels has " +
                                std::to_string(mask.grey.size()) + " values: must be one a pixel");
  const bool zero = zero_allowed && mask.scale == MaskScale::linear;
  const char* bound = zero           ? "finite and at least 0"
                      : zero_allowed ? "finite and above 0 on a log scale"
                                     : "finite and above 0";
  for (const auto& [name, value] : {std::pair{"black", mask.black}, {"white", mask.white}})
    if (!(zero ? value >= 0.0 : value > 0.0) || !std::isfinite(value)) refuse(name, value, bound);
  for (std::size_t k = 0; k < mask.grey.size(); ++k)
    if (!(mask.grey[k] >= 0.0f && mask.grey[k] <= 1.0f)) {
      const std::size_t x = k % std::size_t(mask.width), y = k / std::size_t(mask.width);
      refuse("pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")", mask.grey[k],
             "from 0 to 1");
    }
}

double coefficient(const Mask& mask, double grey) {
  if (mask.scale == MaskScale::log) return mask.black * std::pow(mask.white / mask.black, grey);
  return mask.black + grey * (mask.white - mask.black);
}

/// The pixels that a row or column of cells covers, and their shares of the cell's side.
struct Span {
  int first = 0;
  std::vector<double> share;
};

/// Cells of side h from `origin` on, over `pixels` pixels whose outermost two go on for ever.
std::vector<Span> spans(int cells, double origin, double h, int pixels) {
  std::vector<Span> all;
  for (int i = 0; i < cells; ++i) {
    const double low = origin + h * i, high = origin + h * (i + 1);
    const auto pixel_at = [&](double x) { return int(std::clamp(x, 0.0, double(pixels - 1))); };
    Span span{.first = pixel_at(std::floor(low)), .share = {}};
    const int last = std::max(span.first, pixel_at(std::ceil(high) - 1.0));
    for (int a = span.first; a <= last; ++a) {
      const double from = a == 0 ? low : std::max(low, double(a));
      const double to = a == pixels - 1 ? high : std::min(high, double(a + 1));
      span.share.push_back(std::max(0.0, to - from) / h);
    }
    all.push_back(std::move(span));
  }
  return all;
}

/// Area mean of value(grey) over each cell.
template <class Value>
std::vector<double> means(const Mask& mask, const Lattice& lattice, const Value& value) {
  const double h = lattice.cell_px;
  const std::vector<Span> columns = spans(lattice.nx, lattice.origin_px.x, h, mask.width);
  const std::vector<Span> rows = spans(lattice.ny, lattice.origin_px.y, h, mask.height);
  std::vector<double> cells;
  cells.reserve(lattice.cells());
  std::vector<double> strip(std::size_t(mask.width));  // mean over the row of cells
  for (const Span& row : rows) {
    std::ranges::fill(strip, 0.0);
    for (std::size_t b = 0; b < row.share.size(); ++b) {
      if (row.share[b] == 0.0) continue;
      const float* grey = &mask.grey[(std::size_t(row.first) + b) * std::size_t(mask.width)];
      for (std::size_t a = 0; a < strip.size(); ++a) strip[a] += row.share[b] * value(grey[a]);
    }
    for (const Span& column : columns) {
      double sum = 0.0;
      for (std::size_t a = 0; a < column.share.size(); ++a)
        if (column.share[a] > 0.0) sum += column.share[a] * strip[std::size_t(column.first) + a];
      cells.push_back(sum);
    }
  }
  return cells;
}

}  // namespace

std::vector<float> mu_cells(const Mask& mask, const Lattice& lattice) {
  check(mask, false);
  const auto mu = means(mask, lattice, [&](float grey) { return coefficient(mask, grey); });
  return {mu.begin(), mu.end()};
}

std::vector<float> kappa_cells(const Mask& mask, const Lattice& lattice) {
  check(mask, true);
  const auto compliance =
      means(mask, lattice, [&](float grey) { return 1.0 / coefficient(mask, grey); });
  std::vector<float> kappa;
  kappa.reserve(compliance.size());
  for (const double c : compliance) kappa.push_back(float(1.0 / c));
  return kappa;
}

}  // namespace drumhead::grid
