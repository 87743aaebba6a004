// SPDX-License-Identifier: MIT
#pragma once
// Loops over curve nodes of soft curves with isotropic membranes: as in soft_sweeps.h, with 2×2
// blocks.
#include "special_points.h"
#include "special_state.h"

namespace drumhead::kernels {

template <class T>
bool is_soft(const SoftRows<T>* soft, int vertex) {
  return soft && vertex >= kFirstCrossing && soft->index(vertex - kFirstCrossing) >= 0;
}

/// Adds a point's stiffness to what curve nodes have to do with; `near`: near nodes at the corners
/// of its cell (i, j).
template <class T>
void add_curve_point(const Point<T>& point, const T* entries, const int* near, int i, int j,
                     SoftRows<T>& soft) {
  const Stiffness<T> k(entries);
  const std::size_t count = std::size_t(point.count);
  for (std::size_t a = 0; a < count; ++a) {
    const int own = point.vertex[a];
    const bool curve = is_soft(&soft, own);
    if (!curve && (own >= kFirstCrossing || near[own] < 0)) continue;
    const PointRow<T> of_node(k, point, a);
    for (std::size_t b = 0; b < count; ++b) {
      const int other = point.vertex[b];
      NodeBlock<T>* to = nullptr;
      if (curve)
        to = other >= kFirstCrossing
                 ? soft.find_block(own - kFirstCrossing, other - kFirstCrossing, -1)
                 : soft.find_block(own - kFirstCrossing, i + (other & 1), j + (other >> 1));
      else if (is_soft(&soft, other))
        to = &soft.find_block_of_near(near[own], other - kFirstCrossing);
      if (!to) continue;
      const NodeBlock<T> value = of_node.block(point, b);
      *to = {to->xx + value.xx, to->xy + value.xy, to->yx + value.yx, to->yy + value.yy};
    }
  }
}

template <class T>
void add_product(const NodeBlock<T>& block, T x, T y, Vector2<T>& product) {
  product.x += block.xx * x + block.xy * y;
  product.y += block.yx * x + block.yy * y;
}

/// Adds to H d at near node n what it has of curve nodes.
template <class T>
void add_curve_blocks_to_near(const SoftRows<T>& soft, int n, const T* curve, Vector2<T>& product) {
  for (int k = soft.near_begin(n); k < soft.near_begin(n + 1); ++k) {
    const int c = soft.of_near(k).column;
    add_product(soft.of_near_block(k), curve[2 * c], curve[2 * c + 1], product);
  }
}

/// H d at the n-th soft curve node.
template <class T>
Vector2<T> curve_block_times(const SoftRows<T>& soft, int n, const Unknowns<const T>& d) {
  const typename SoftRows<T>::Row &row = soft.row(n), &next = soft.row(n + 1);
  Vector2<T> product{T(0), T(0)};
  add_product(soft.own_block(n), d.curve[2 * row.node], d.curve[2 * row.node + 1], product);
  for (int k = row.node_begin; k < next.node_begin; ++k) {
    const NodeCoupling<T>& c = soft.node(k);
    add_product(soft.node_block(k), c.row < 0 ? d.curve[2 * c.column] : d.x.at(c.column, c.row),
                c.row < 0 ? d.curve[2 * c.column + 1] : d.y.at(c.column, c.row), product);
  }
  return product;
}

/// Curve nodes of H d.
template <class T>
void write_curve_blocks(const SpecialRows<T>& rows, const Unknowns<const T>& d,
                        const Unknowns<T>& out) {
  if (!rows.soft()) return;
  for (int n = 0; n < rows.soft()->size(); ++n) {
    const Vector2<T> product = curve_block_times(*rows.soft(), n, d);
    const int c = 2 * rows.soft()->row(n).node;
    out.curve[c] = product.x;
    out.curve[c + 1] = product.y;
  }
}

/// Gauss–Seidel on the curve nodes of row j, one after the other.
template <class T>
void relax_curve_block_row(const SpecialRows<T>& rows, const Unknowns<const T>& f,
                           const Unknowns<T>& d, int j) {
  if (!rows.soft()) return;
  for (int n = rows.soft()->begin(j); n < rows.soft()->begin(j + 1); ++n) {
    const Vector2<T> product = curve_block_times<T>(*rows.soft(), n, d);
    const int c = 2 * rows.soft()->row(n).node;
    Vector2<T> step{T(0), T(0)};
    add_product(rows.soft()->inverse_block(n), f.curve[c] - product.x, f.curve[c + 1] - product.y,
                step);
    d.curve[c] += step.x;
    d.curve[c + 1] += step.y;
  }
}

/// The adjoint of prolong_curve_row for all rows of a residual, on a coarse level that has all the
/// rest.
template <class T>
void restrict_to_curves(const SpecialTransfer<T>& transfer, const Unknowns<const T>& residual,
                        const Unknowns<T>& coarse) {
  for (int c = 0; c < coarse.curve_count; ++c) coarse.curve[c] = T(0);
  for (std::size_t j = 0; j + 1 < transfer.of_node_begin.size(); ++j)
    for (int k = transfer.of_node_begin[j]; k < transfer.of_node_begin[j + 1]; ++k) {
      const auto& [from, to, weight] = transfer.of_node[std::size_t(k)];
      coarse.curve[2 * to] += weight * residual.x.at(from, int(j));
      coarse.curve[2 * to + 1] += weight * residual.y.at(from, int(j));
    }
  for (const auto& [from, column, row, weight] : transfer.of_curve) {
    (row < 0 ? coarse.curve[2 * column] : coarse.x.at(column, row)) +=
        weight * residual.curve[2 * from];
    (row < 0 ? coarse.curve[2 * column + 1] : coarse.y.at(column, row)) +=
        weight * residual.curve[2 * from + 1];
  }
}

}  // namespace drumhead::kernels
