// SPDX-License-Identifier: MIT
#pragma once
// Where successive steps of Newton's method point, from the moves of every other node of every
// other row: 4 bytes a node, taken when first asked for.
#include <cmath>
#include <utility>

#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/transfer.h>

#include "level.h"

namespace drumhead::multigrid {

template <class T>
class Turn {
 public:
  /// `level` and `meter` must outlive it.
  Turn(const Level<T>& level, grid::MemoryMeter& meter) : level_(level), meter_(meter) {}

  /// Cosine between the moves of step d and of the d that it was called with last; not a number the
  /// first time.
  double cosine_with(const kernels::Unknowns<const T>& d) {
    if (!x_)
      for (grid::Field<T>* field : {&x_, &y_, &next_x_, &next_y_})
        *field = grid::Field<T>(grid::coarse_cells(level_.nx) + 1,
                                grid::coarse_cells(level_.ny) + 1, meter_);
    kernels::inject_nodes<T>(d.x, next_x_.view());
    kernels::inject_nodes<T>(d.y, next_y_.view());
    const double products = dot(x_, next_x_) + dot(y_, next_y_);
    const double squares =
        (dot(x_, x_) + dot(y_, y_)) * (dot(next_x_, next_x_) + dot(next_y_, next_y_));
    std::swap(x_, next_x_);
    std::swap(y_, next_y_);
    return products / std::sqrt(squares);
  }

 private:
  static double dot(const grid::Field<T>& a, const grid::Field<T>& b) {
    return kernels::dot<T>(a.view(), b.view());
  }

  const Level<T>& level_;
  grid::MemoryMeter& meter_;
  grid::Field<T> x_, y_, next_x_, next_y_;
};

}  // namespace drumhead::multigrid
