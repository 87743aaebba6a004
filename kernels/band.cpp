// SPDX-License-Identifier: MIT
#include <drumhead/kernels/band.h>

#include <algorithm>

namespace drumhead::kernels {

Band::Band(const std::vector<int>& row_begin, const std::vector<int>& column, int columns,
           int width, bool without) {
  const int rows = int(row_begin.size()) - 1;
  std::vector<int> near;
  for (int j = 0; j < rows; ++j) {
    begin_.push_back(int(span_.size()));
    const int low = row_begin[std::size_t(std::max(0, j - width))];
    const int high = row_begin[std::size_t(std::min(rows, j + width + 1))];
    near.assign(column.begin() + low, column.begin() + high);
    std::ranges::sort(near);
    auto listed = column.begin() + row_begin[std::size_t(j)];
    const auto last =
        column.begin() + (without ? row_begin[std::size_t(j) + 1] : row_begin[std::size_t(j)]);
    int begin = 0;
    for (const int i : near) {
      const int end = std::min(columns, i + width + 1);
      begin = std::max(begin, i - width);
      while (begin < end) {
        listed = std::find_if(listed, last, [=](int c) { return c >= begin; });
        const int stop = listed == last ? end : std::min(end, *listed);
        if (begin < stop) add(begin, stop);
        begin = stop < end ? stop + 1 : end;
      }
    }
  }
  begin_.push_back(int(span_.size()));
}

/// Cells [begin, end) of the last row.
void Band::add(int begin, int end) {
  if (int(span_.size()) > begin_.back() && span_.back().end == begin)
    span_.back().end = end;
  else
    span_.push_back({begin, end});
}

}  // namespace drumhead::kernels
