// SPDX-License-Identifier: MIT
#pragma once
// Loops over curve nodes of soft curves: their rows of products, residuals, relaxations and
// transfers (soft_nodes.h), and what those of near nodes and parts have of them.
#include <drumhead/kernels/special.h>

#include "special_state.h"

namespace drumhead::kernels {

/// Adds to H d at near node n what it has of curve nodes.
template <class T>
void add_curve_to_near(const SoftRows<T>& soft, int n, const T* curve, Vector2<T>& product) {
  for (int k = soft.near_begin(n); k < soft.near_begin(n + 1); ++k) {
    const NodeCoupling<T>& c = soft.of_near(k);
    const T x = curve[2 * c.column], y = curve[2 * c.column + 1];
    product.x += c.k * x + c.g * y;
    product.y += c.k * y - c.g * x;
  }
}
/// What the row of part p has of curve nodes, times d.
template <class T>
T curve_of_part(const SoftRows<T>& soft, int p, const T* curve) {
  T sum = T(0);
  for (int k = soft.area_begin(p); k < soft.area_begin(p + 1); ++k) {
    const AreaCoupling<T>& c = soft.of_part(k);
    sum += c.bx * curve[2 * c.other] + c.by * curve[2 * c.other + 1];
  }
  return sum;
}

/// H d at the n-th soft curve node.
template <class T>
void apply_curve(const SoftRows<T>& soft, int n, const Unknowns<const T>& d, T& hx, T& hy) {
  const typename SoftRows<T>::Row &row = soft.row(n), &next = soft.row(n + 1);
  hx = row.diagonal * d.curve[2 * row.node];
  hy = row.diagonal * d.curve[2 * row.node + 1];
  for (int k = row.node_begin; k < next.node_begin; ++k) {
    const NodeCoupling<T>& c = soft.node(k);
    const T x = c.row < 0 ? d.curve[2 * c.column] : d.x.at(c.column, c.row);
    const T y = c.row < 0 ? d.curve[2 * c.column + 1] : d.y.at(c.column, c.row);
    hx += c.k * x + c.g * y;
    hy += c.k * y - c.g * x;
  }
  if (!d.p) return;
  for (int k = row.part_begin; k < next.part_begin; ++k) {
    const AreaCoupling<T>& c = soft.part(k);
    hx += c.bx * d.listed[c.other];
    hy += c.by * d.listed[c.other];
  }
}

/// Curve nodes of H d, or of f − H d if there is an f.
template <class T>
void write_curve_rows(const SpecialRows<T>& rows, const Unknowns<const T>* f,
                      const Unknowns<const T>& d, const Unknowns<T>& out) {
  if (!rows.soft()) return;
  for (int n = 0; n < rows.soft()->size(); ++n) {
    T hx, hy;
    apply_curve(*rows.soft(), n, d, hx, hy);
    const int c = 2 * rows.soft()->row(n).node;
    out.curve[c] = f ? f->curve[c] - hx : hx;
    out.curve[c + 1] = f ? f->curve[c + 1] - hy : hy;
  }
}

/// Σ (f − H d)² over curve nodes.
template <class T>
double curve_squares(const SpecialRows<T>& rows, const Unknowns<const T>& f,
                     const Unknowns<const T>& d) {
  double sum = 0.0;
  for (int n = 0; rows.soft() && n < rows.soft()->size(); ++n) {
    T hx, hy;
    apply_curve(*rows.soft(), n, d, hx, hy);
    const int c = 2 * rows.soft()->row(n).node;
    const double x = double(f.curve[c] - hx), y = double(f.curve[c + 1] - hy);
    sum += x * x + y * y;
  }
  return sum;
}

template <class T>
void clear_curve_row(const SpecialRows<T>& rows, const Unknowns<T>& d, int j) {
  if (!rows.soft()) return;
  for (int n = rows.soft()->begin(j); n < rows.soft()->begin(j + 1); ++n) {
    const int c = 2 * rows.soft()->row(n).node;
    d.curve[c] = d.curve[c + 1] = T(0);
  }
}

/// Gauss–Seidel on the curve nodes of row j, one after the other.
template <class T>
void relax_curve_row(const SpecialRows<T>& rows, const Unknowns<const T>& f, const Unknowns<T>& d,
                     int j) {
  if (!rows.soft()) return;
  for (int n = rows.soft()->begin(j); n < rows.soft()->begin(j + 1); ++n) {
    T hx, hy;
    apply_curve<T>(*rows.soft(), n, d, hx, hy);
    const typename SoftRows<T>::Row& row = rows.soft()->row(n);
    d.curve[2 * row.node] += (f.curve[2 * row.node] - hx) * row.inverse;
    d.curve[2 * row.node + 1] += (f.curve[2 * row.node + 1] - hy) * row.inverse;
  }
}

/// s of a part's row beyond lattice nodes.
template <class T>
T curve_weight(const SoftRows<T>& soft, int p) {
  T sum = T(0);
  for (int k = soft.area_begin(p); k < soft.area_begin(p + 1); ++k) {
    const AreaCoupling<T>& c = soft.of_part(k);
    sum += (c.bx * c.bx + c.by * c.by) * soft.inverse(c.other);
  }
  return sum;
}
template <class T>
void move_curve_of_part(const SoftRows<T>& soft, int p, T t, T* curve) {
  for (int k = soft.area_begin(p); k < soft.area_begin(p + 1); ++k) {
    const AreaCoupling<T>& c = soft.of_part(k);
    curve[2 * c.other] += c.bx * soft.inverse(c.other) * t;
    curve[2 * c.other + 1] += c.by * soft.inverse(c.other) * t;
  }
}

/// Adds the prolonged correction of the coarser level to what curve nodes have to do with in row j.
template <class T>
void prolong_curve_row(const SpecialTransfer<T>& transfer, const Unknowns<const T>& coarse,
                       const Unknowns<T>& fine, int j) {
  auto entries = [j](const std::vector<int>& begin) {
    return begin.empty() ? Span{0, 0} : Span{begin[std::size_t(j)], begin[std::size_t(j) + 1]};
  };
  const Span nodes = entries(transfer.of_node_begin), curves = entries(transfer.of_curve_begin);
  for (int k = nodes.begin; k < nodes.end; ++k) {
    const auto& [to, from, weight] = transfer.of_node[std::size_t(k)];
    fine.x.at(to, j) += weight * coarse.curve[2 * from];
    fine.y.at(to, j) += weight * coarse.curve[2 * from + 1];
  }
  for (int k = curves.begin; k < curves.end; ++k) {
    const auto& [to, column, row, weight] = transfer.of_curve[std::size_t(k)];
    fine.curve[2 * to] += weight * (row < 0 ? coarse.curve[2 * column] : coarse.x.at(column, row));
    fine.curve[2 * to + 1] +=
        weight * (row < 0 ? coarse.curve[2 * column + 1] : coarse.y.at(column, row));
  }
}

/// Keeps what residual row j of lattice nodes has for coarse curve nodes. `kept`: two per entry of
/// SpecialTransfer::of_node.
template <class T>
void keep_for_curve(const SpecialTransfer<T>& transfer, const SplitRow<const T>& x,
                    const SplitRow<const T>& y, int j, T* kept) {
  if (transfer.of_node_begin.empty()) return;
  for (int k = transfer.of_node_begin[std::size_t(j)];
       k < transfer.of_node_begin[std::size_t(j) + 1]; ++k) {
    const int i = transfer.of_node[std::size_t(k)].fine;
    kept[2 * k] = x.half[i & 1][i >> 1];
    kept[2 * k + 1] = y.half[i & 1][i >> 1];
  }
}

/// The adjoint of prolong_curve_row for all rows, on a coarse level that has all the rest.
template <class T>
void restrict_curves(const SpecialRows<T>& rows, const SpecialTransfer<T>& transfer,
                     const Unknowns<const T>& f, const Unknowns<const T>& d, const T* kept,
                     const Unknowns<T>& coarse) {
  for (int c = 0; c < coarse.curve_count; ++c) coarse.curve[c] = T(0);
  for (std::size_t k = 0; k < transfer.of_node.size(); ++k) {
    const auto& [from, to, weight] = transfer.of_node[k];
    coarse.curve[2 * to] += weight * kept[2 * k];
    coarse.curve[2 * to + 1] += weight * kept[2 * k + 1];
  }
  T rx = T(0), ry = T(0);
  int node = -1;  // whose residual that is
  for (const auto& [from, column, row, weight] : transfer.of_curve) {
    if (from != node) {
      T hx, hy;
      apply_curve(*rows.soft(), rows.soft()->index(from), d, hx, hy);
      rx = f.curve[2 * from] - hx;
      ry = f.curve[2 * from + 1] - hy;
      node = from;
    }
    (row < 0 ? coarse.curve[2 * column] : coarse.x.at(column, row)) += weight * rx;
    (row < 0 ? coarse.curve[2 * column + 1] : coarse.y.at(column, row)) += weight * ry;
  }
}

}  // namespace drumhead::kernels
