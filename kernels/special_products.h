// SPDX-License-Identifier: MIT
#pragma once
// Rows of near nodes and parts times a correction, from the rows that SpecialRows stores.
#include <algorithm>

#include <drumhead/kernels/special.h>

#include "soft_sweeps.h"
#include "special_state.h"

namespace drumhead::kernels {

/// Four numbers side by side, in the vectors of 16 bytes that every x86-64 has.
template <class T>
class Four {
 public:
  Four(T a, T b, T c, T d) {
    if constexpr (kVectors == 1)
      v_[0] = Vector{a, b, c, d};
    else
      v_[0] = Vector{a, b}, v_[1] = Vector{c, d};
  }
  explicit Four(T a) : Four(a, a, a, a) {}
  explicit Four(const T* at) { __builtin_memcpy(v_, at, sizeof v_); }
  /// Two from one place.
  Four(const T* first, T c, T d) {
    using Two [[gnu::vector_size(2 * sizeof(T))]] = T;
    Two one, two{c, d};
    __builtin_memcpy(&one, first, sizeof one);
    if constexpr (kVectors == 1)
      v_[0] = __builtin_shufflevector(one, two, 0, 1, 2, 3);
    else
      v_[0] = one, v_[1] = two;
  }
  friend Four operator*(Four a, const Four& b) {
    for (int n = 0; n < kVectors; ++n) a.v_[n] *= b.v_[n];
    return a;
  }
  friend Four operator+(Four a, const Four& b) {
    for (int n = 0; n < kVectors; ++n) a.v_[n] += b.v_[n];
    return a;
  }
  friend Four operator-(Four a, const Four& b) {
    for (int n = 0; n < kVectors; ++n) a.v_[n] -= b.v_[n];
    return a;
  }
  T operator[](int n) const { return v_[n / kLanes][n % kLanes]; }
  T sum() const { return ((*this)[0] + (*this)[2]) + ((*this)[1] + (*this)[3]); }
  void store(T* at) const { __builtin_memcpy(at, v_, sizeof v_); }

 private:
  using Vector [[gnu::vector_size(16)]] = T;
  static constexpr int kLanes = int(16 / sizeof(T)), kVectors = 4 / kLanes;
  Vector v_[kVectors];
};

/// The eight neighbours of a node in the order of NearRow, and the node.
template <class T>
struct Neighbours {
  Four<T> sides, rest;
  T centre;
  /// `side`, `middle`: the node's western neighbour and itself.
  Neighbours(const T* side, const T* middle, std::ptrdiff_t stride)
      : sides(side - stride, side[0], side[1]),
        rest(side + stride, middle[-stride], middle[stride]),
        centre(*middle) {}
};

/// Node row j of a correction as its near nodes see it; x and y are laid out alike.
template <class T>
class NearRowView {
 public:
  NearRowView(const Unknowns<const T>& d, int j)
      : x_(d.x.data + j * d.x.stride),
        y_(d.y.data + j * d.y.stride),
        stride_(d.x.stride),
        odd_(d.x.odd),
        p_(d.p ? d.p.data + j * d.p.stride : nullptr),
        p_stride_(d.p.stride),
        p_odd_(d.p.odd),
        listed_(d.listed) {}

  /// H d without curve nodes and further parts.
  [[gnu::always_inline]] Vector2<T> apply(const NearRow<T>& row) const {
    // By masks: columns' parities could not be predicted.
    const std::ptrdiff_t odd = -std::ptrdiff_t(row.column & 1), half = row.column >> 1;
    const std::ptrdiff_t middle = half + (odd & odd_), side = half + (~odd & (odd_ - 1));
    const Neighbours<T> x(x_ + side, x_ + middle, stride_), y(y_ + side, y_ + middle, stride_);
    const Four<T> k(row.k), l(row.k + 4);
    Four<T> hx = k * x.sides + l * x.rest, hy = k * y.sides + l * y.rest;
    if (p_) {
      const Four<T> g(row.g), h(row.g + 4);
      const Four<T> p =
          pressures(row, p_ + half + (~odd & (p_odd_ - 1)), p_ + half + (odd & p_odd_));
      hx = (hx + (g * y.sides + h * y.rest)) + Four<T>(row.bx) * p;
      hy = (hy - (g * x.sides + h * x.rest)) + Four<T>(row.by) * p;
    }
    const T own = row.k[kStencilPlaces - 1];
    return {hx.sum() + own * x.centre, hy.sum() + own * y.centre};
  }

 private:
  /// The pressures of the cells sw, se, nw, ne, `west` and `east` those of the row, or of the parts
  /// that the node belongs to.
  [[gnu::always_inline]] Four<T> pressures(const NearRow<T>& row, const T* west,
                                           const T* east) const {
    const T* at[4] = {west - p_stride_, east - p_stride_, west, east};
    for (int q = 0; q < 4; ++q)
      if (row.part[q] >= 0) at[q] = listed_ + row.part[q];
    return {*at[0], *at[1], *at[2], *at[3]};
  }

  const T *x_, *y_;
  std::ptrdiff_t stride_, odd_;
  const T* p_;
  std::ptrdiff_t p_stride_, p_odd_;
  const T* listed_;
};

/// What else H d has at near node n: where curves are soft.
template <class T>
[[gnu::noinline]] void add_soft_to_near(const SpecialRows<T>& rows, int n,
                                        const Unknowns<const T>& d, Vector2<T>& product) {
  if (rows.soft()) add_curve_to_near(*rows.soft(), n, d.curve, product);
  if (!d.p) return;
  for (const PartCoupling<T>& coupling : rows.further(n)) {
    product.x += coupling.bx * d.listed[coupling.part];
    product.y += coupling.by * d.listed[coupling.part];
  }
}

/// visit(near node, H d there) for the near nodes of row j, one after the other.
template <class T, class F>
[[gnu::always_inline]] inline void for_near_products(const SpecialRows<T>& rows,
                                                     const Unknowns<const T>& d, int j, F&& visit) {
  const NearRowView<T> view(d, j);
  const int end = rows.near_begin(j + 1);
  const bool soft = rows.soft() || rows.has_further();
  for (int n = rows.near_begin(j); n < end; ++n) {
    const NearRow<T>& row = rows.near(n);
    Vector2<T> product = view.apply(row);
    if (soft) add_soft_to_near(rows, n, d, product);
    visit(row, product);
  }
}

/// The corners 00, 10, 01, 11 of cell (i, j) of a plane.
template <class T>
struct CornerValues {
  T *south_west, *south_east;
  std::ptrdiff_t stride;
  CornerValues(const Plane<T>& f, int i, int j)
      : south_west(f.half(j, 0) + ((i & 1) ? f.odd : 0) + (i >> 1)),
        south_east(f.half(j, 0) + ((i & 1) ? 0 : f.odd) + ((i + 1) >> 1)),
        stride(f.stride) {}
  Four<std::remove_const_t<T>> load() const {
    return {south_west[0], south_east[0], south_west[stride], south_east[stride]};
  }
  void store(const Four<T>& values) const {
    south_west[0] = values[0];
    south_east[0] = values[1];
    south_west[stride] = values[2];
    south_east[stride] = values[3];
  }
};

/// What the jumps between part p of special cell (i, j) and all its neighbours but the first across
/// each side add to its row: the neighbours' share.
template <class T>
T further_jumps(const SpecialRows<T>& rows, const Unknowns<const T>& d, int p) {
  const SpecialCells<T>& cells = rows.cells();
  T sum = T(0);
  const auto begin = cells.neighbour.begin() + cells.neighbour_begin[std::size_t(p)],
             end = cells.neighbour.begin() + cells.neighbour_begin[std::size_t(p) + 1];
  for (auto other = begin; other != end; ++other)
    if (std::any_of(begin, other, [=](const PartNeighbour& n) { return n.side == other->side; }))
      sum += rows.jump(int(other - cells.neighbour.begin())) * d.listed[other->part];
  return sum;
}

/// The same of all neighbours, of a part in cell row j.
template <class T>
[[gnu::always_inline]] inline T neighbour_jumps(const SpecialRows<T>& rows,
                                                const Unknowns<const T>& d, int p, int i, int j) {
  const PartJumps<T>& row = rows.jumps(p);
  const std::ptrdiff_t odd = i & 1, half = i >> 1;
  const T* const cells = d.p.data + (j * d.p.stride + half);
  const T *own = cells + odd * d.p.odd, *east = cells + ((1 - odd) * d.p.odd + odd);
  const T* at[4] = {own - d.p.stride, east, own + d.p.stride, east - 1};
  for (int s = 0; s < 4; ++s)
    if (row.part[s] >= 0) at[s] = d.listed + row.part[s];
  const T sum = (Four<T>(row.jump) * Four<T>(*at[0], *at[1], *at[2], *at[3])).sum();
  return row.more ? sum + further_jumps(rows, d, p) : sum;
}

/// Row of part p of special cell (i, j), times d, whose values at the cell's corners are x, y.
template <class T>
[[gnu::always_inline]] inline T apply_part(const SpecialRows<T>& rows, const Unknowns<const T>& d,
                                           const Four<T>& x, const Four<T>& y, int p, int i,
                                           int j) {
  const PartRow<T>& row = rows.part(p);
  T product = (Four<T>(row.bx) * x + Four<T>(row.by) * y).sum() -
              (row.compliance + row.jumps) * d.listed[p];
  if (rows.soft()) product += curve_of_part(*rows.soft(), p, d.curve);
  return rows.has_jumps() ? product + neighbour_jumps(rows, d, p, i, j) : product;
}

}  // namespace drumhead::kernels
