// SPDX-License-Identifier: MIT
#pragma once
// Where successive steps of Newton's method point, from the moves of every other node of every
// other row: 4 bytes a node, taken when first asked for.
#include <cmath>
#include <limits>
#include <utility>

#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/transfer.h>

#include "level.h"

namespace drumhead::multigrid {

/// A step beside the one before: cosine between their moves, and ratio of their lengths.
struct Turned {
  double cosine = std::numeric_limits<double>::quiet_NaN();
  double ratio = std::numeric_limits<double>::quiet_NaN();
};

template <class T>
class Turn {
 public:
  /// `level` and `meter` must outlive it.
  Turn(const Level<T>& level, grid::MemoryMeter& meter) : level_(level), meter_(meter) {}

  /// Of the moves of step d beside those of the d that it was called with last; not numbers the
  /// first time.
  Turned from_last_to(const kernels::Unknowns<const T>& d) {
    if (!x_)
      for (grid::Field<T>* field : {&x_, &y_, &next_x_, &next_y_})
        *field = grid::Field<T>(grid::coarse_cells(level_.nx) + 1,
                                grid::coarse_cells(level_.ny) + 1, meter_);
    kernels::inject_nodes<T>(d.x, next_x_.view());
    kernels::inject_nodes<T>(d.y, next_y_.view());
    const double products = dot(x_, next_x_) + dot(y_, next_y_);
    const double before = last_, squares = dot(next_x_, next_x_) + dot(next_y_, next_y_);
    last_ = squares;
    std::swap(x_, next_x_);
    std::swap(y_, next_y_);
    return {products / std::sqrt(squares * before), std::sqrt(squares / before)};
  }

 private:
  static double dot(const grid::Field<T>& a, const grid::Field<T>& b) {
    return kernels::dot<T>(a.view(), b.view());
  }

  const Level<T>& level_;
  grid::MemoryMeter& meter_;
  grid::Field<T> x_, y_, next_x_, next_y_;
  double last_ = 0.0;  ///< squares of x_, y_
};

}  // namespace drumhead::multigrid
