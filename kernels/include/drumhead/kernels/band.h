// SPDX-License-Identifier: MIT
#pragma once
// The cells beside some cells of a lattice, those that curves run through.
#include <cassert>
#include <cstddef>
#include <vector>

#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// They are kept as spans of each row of cells.
class Band {
 public:
  /// Of a lattice without rows.
  Band() = default;
  /// The cells within `width` columns and rows of those listed, which are of cell row j
  /// column[row_begin[j]] … column[row_begin[j + 1] − 1], ascending, on a lattice of `columns`
  /// columns and row_begin.size() − 1 rows of cells. `without`: but not the listed cells
  /// themselves.
  Band(const std::vector<int>& row_begin, const std::vector<int>& column, int columns, int width,
       bool without);

  /// Of cell row j; the columns are those of the cells.
  Spans row(int j) const {
    assert(std::size_t(j) + 1 < begin_.size());
    return {span_.data() + begin_[std::size_t(j)], span_.data() + begin_[std::size_t(j) + 1]};
  }
  std::size_t bytes() const { return begin_.size() * sizeof(int) + span_.size() * sizeof(Span); }

 private:
  void add(int begin, int end);

  std::vector<int> begin_;  ///< rows + 1 indices into span_
  std::vector<Span> span_;
};

}  // namespace drumhead::kernels
