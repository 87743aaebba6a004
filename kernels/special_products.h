// SPDX-License-Identifier: MIT
#pragma once
// Rows of near nodes and parts times a correction, from the rows that SpecialRows stores.
#include <algorithm>
#include <type_traits>

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
  /// a.sum() and b.sum().
  friend Vector2<T> sums(const Four& a, const Four& b) {
    if constexpr (kVectors == 1) {
      const Vector half = __builtin_shufflevector(a.v_[0], b.v_[0], 0, 4, 1, 5) +
                          __builtin_shufflevector(a.v_[0], b.v_[0], 2, 6, 3, 7);
      return {half[0] + half[2], half[1] + half[3]};
    } else {
      return {a.sum(), b.sum()};
    }
  }

 private:
  using Vector [[gnu::vector_size(16)]] = T;
  static constexpr int kLanes = int(16 / sizeof(T)), kVectors = 4 / kLanes;
  Vector v_[kVectors];
};

/// Node row j of a correction as its near nodes see it; x and y are laid out alike.
template <class T>
class NearRowView {
 public:
  NearRowView(const Unknowns<const T>& d, int j)
      : x_(d.x.data + j * d.x.stride),
        y_(d.y.data + j * d.y.stride),
        stride_(d.x.stride),
        p_(d.p ? d.p.data + j * d.p.stride : nullptr),
        p_stride_(d.p.stride),
        listed_(d.listed) {}

  /// H d without diagonals, curve nodes and further parts.
  [[gnu::always_inline]] Vector2<T> apply(const NearRow<T>& row) const {
    const Four<T> x = sides(x_, row), y = sides(y_, row), k(row.k);
    Four<T> hx = k * x, hy = k * y;
    if (p_) {
      const Four<T> g(row.g), p = pressures(row);
      hx = (hx + g * y) + Four<T>(row.bx) * p;
      hy = (hy - g * x) + Four<T>(row.by) * p;
    }
    const Vector2<T> sum = sums(hx, hy);
    return {sum.x + row.own * x_[row.place], sum.y + row.own * y_[row.place]};
  }
  /// What the nodes south-west, south-east, north-west and north-east add to that.
  [[gnu::always_inline]] void add_diagonals(const NearRow<T>& row, const DiagonalRow<T>& diagonals,
                                            Vector2<T>& product) const {
    const T *south = x_ + row.west - stride_, *north = x_ + row.west + stride_;
    const Four<T> x(south[0], south[1], north[0], north[1]);
    south = y_ + row.west - stride_, north = y_ + row.west + stride_;
    const Four<T> y(south[0], south[1], north[0], north[1]);
    const Four<T> k(diagonals.k), g(diagonals.g);
    const Vector2<T> sum = sums(k * x + g * y, k * y - g * x);
    product = {product.x + sum.x, product.y + sum.y};
  }

 private:
  /// The values west, east, south and north of a node.
  Four<T> sides(const T* values, const NearRow<T>& row) const {
    const T *west = values + row.west, *middle = values + row.place;
    return {west[0], west[1], middle[-stride_], middle[stride_]};
  }
  /// The pressures of the cells sw, se, nw, ne or of the parts that the node belongs to.
  [[gnu::always_inline]] Four<T> pressures(const NearRow<T>& row) const {
    T p[4];
    for (int q = 0; q < 4; ++q) {
      const std::ptrdiff_t part = row.part[q];
      p[q] = part >= 0 ? listed_[part] : (q < 2 ? p_ - p_stride_ : p_)[-1 - part];
    }
    return {p[0], p[1], p[2], p[3]};
  }
  const T *x_, *y_;
  std::ptrdiff_t stride_;
  const T* p_;
  std::ptrdiff_t p_stride_;
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
  const bool soft = rows.soft() || rows.has_further();
  const int end = rows.near_begin(j + 1);
  for (int n = rows.near_begin(j); n < end; ++n) {
    const NearRow<T>& row = rows.near(n);
    Vector2<T> product = view.apply(row);
    if (const int diagonal = rows.near_node(n).diagonal; diagonal >= 0)
      view.add_diagonals(row, rows.diagonal(diagonal), product);
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

/// What the jumps between part p and all its neighbours but the first across each side add to its
/// row: the neighbours' share. `parts`: dP of all parts.
template <class T>
[[gnu::noinline]] T further_jumps(const SpecialRows<T>& rows, const T* parts, int p) {
  const SpecialCells<T>& cells = rows.cells();
  T sum = T(0);
  const auto begin = cells.neighbour.begin() + cells.neighbour_begin[std::size_t(p)],
             end = cells.neighbour.begin() + cells.neighbour_begin[std::size_t(p) + 1];
  for (auto other = begin; other != end; ++other)
    if (std::any_of(begin, other, [=](const PartNeighbour& n) { return n.side == other->side; }))
      sum += rows.jump(int(other - cells.neighbour.begin())) * parts[other->part];
  return sum;
}

/// Which neighbours jumps join parts to.
enum class Joined { none, parts, parts_and_cells };

/// Runs body(kSoft, kJoined as std::integral_constant): whether any curve is soft, and what parts
/// are joined to.
template <class T, class F>
void with_kind(const SpecialRows<T>& rows, F&& body) {
  const auto with_soft = [&](auto soft) {
    if (rows.has_border_jumps())
      body(soft, std::integral_constant<Joined, Joined::parts_and_cells>{});
    else if (rows.has_jumps())
      body(soft, std::integral_constant<Joined, Joined::parts>{});
    else
      body(soft, std::integral_constant<Joined, Joined::none>{});
  };
  rows.soft() ? with_soft(std::true_type{}) : with_soft(std::false_type{});
}

/// Cell row j of a correction as its parts see it.
template <class T, bool kSoft, Joined kJoined>
class PartRowView {
 public:
  PartRowView(const SpecialRows<T>& rows, const Unknowns<const T>& d, int j)
      : rows_(rows),
        p_(d.p.data + j * d.p.stride),
        stride_(d.p.stride),
        odd_(d.p.odd),
        listed_(d.listed),
        curve_(d.curve) {}

  /// Row of part p of the special cell in column i, times the correction, whose values at the
  /// cell's corners are x, y.
  [[gnu::always_inline]] T apply(const Four<T>& x, const Four<T>& y, int p, int i) const {
    const PartRow<T>& row = rows_.part(p);
    T product = (Four<T>(row.bx) * x + Four<T>(row.by) * y).sum() -
                (row.compliance + row.jumps) * listed_[p];
    if constexpr (kSoft) product += curve_of_part(*rows_.soft(), p, curve_);
    if constexpr (kJoined != Joined::none) product += neighbour_jumps(p, i);
    return product;
  }

 private:
  /// What the jumps add: the neighbours' share.
  [[gnu::always_inline]] T neighbour_jumps(int p, int i) const {
    const PartJumps<T>& row = rows_.jumps(p);
    if constexpr (kJoined == Joined::parts) {
      const Four<T> parts(listed_[row.part[0]], listed_[row.part[1]], listed_[row.part[2]],
                          listed_[row.part[3]]);
      const T sum = (Four<T>(row.jump) * parts).sum();
      return row.more ? sum + further_jumps(rows_, listed_, p) : sum;
    }
    const std::ptrdiff_t odd = i & 1, half = i >> 1;
    const T* const cells = p_ + half;
    const T *own = cells + odd * odd_, *east = cells + ((1 - odd) * odd_ + odd);
    const T* at[4] = {own - stride_, east, own + stride_, east - 1};
    for (int s = 0; s < 4; ++s)
      if (row.part[s] >= 0) at[s] = listed_ + row.part[s];
    const T sum = (Four<T>(row.jump) * Four<T>(*at[0], *at[1], *at[2], *at[3])).sum();
    return row.more ? sum + further_jumps(rows_, listed_, p) : sum;
  }

  const SpecialRows<T>& rows_;
  const T* p_;
  std::ptrdiff_t stride_, odd_;
  const T *listed_, *curve_;
};

}  // namespace drumhead::kernels
