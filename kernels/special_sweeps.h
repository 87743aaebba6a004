// SPDX-License-Identifier: MIT
#pragma once
// Rows of the list pass: what overwrites the vectorised kernels at near nodes and special cells.
// Plain loops, compiled once for every instruction set.
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

/// H d at near node n, of node row j.
template <class T>
[[gnu::always_inline]] inline Vector2<T> apply_near(const SpecialRows<T>& rows, int n,
                                                    const Unknowns<const T>& d, int j) {
  const NearRow<T>& row = rows.near(n);
  const int parity = row.column & 1, half = row.column >> 1;
  // x and y are laid out alike.
  const std::ptrdiff_t stride = d.x.stride, begin = j * stride + half;
  const std::ptrdiff_t middle = begin + (parity ? d.x.odd : 0),
                       side = begin + (parity ? 0 : d.x.odd - 1);
  const Neighbours<T> x(d.x.data + side, d.x.data + middle, stride),
      y(d.y.data + side, d.y.data + middle, stride);
  const Four<T> k(row.k), l(row.k + 4);
  Four<T> hx = k * x.sides + l * x.rest, hy = k * y.sides + l * y.rest;
  const T own = row.k[kStencilPlaces - 1];
  Vector2<T> product{own * x.centre, own * y.centre};
  if (rows.soft()) add_curve_to_near(*rows.soft(), n, d.curve, product);
  if (!d.p) return {hx.sum() + product.x, hy.sum() + product.y};
  const Four<T> g(row.g), h(row.g + 4);
  const T* const west = d.p.half(j, 1 - parity) + (half - 1 + parity);
  const T* const east = d.p.half(j, parity) + half;
  const Four<T> p(west[-d.p.stride], east[-d.p.stride], west[0], east[0]);
  hx = (hx + (g * y.sides + h * y.rest)) + Four<T>(row.bx) * p;
  hy = (hy - (g * x.sides + h * x.rest)) + Four<T>(row.by) * p;
  product = {hx.sum() + product.x, hy.sum() + product.y};
  const int end = rows.near(n + 1).coupling_begin;
  for (int c = row.coupling_begin; c < end; ++c) {
    const PartCoupling<T>& coupling = rows.coupling(c);
    product.x += coupling.bx * d.listed[coupling.part];
    product.y += coupling.by * d.listed[coupling.part];
  }
  return product;
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

/// visit(part) for the parts of the special cells in row j.
template <class T, class F>
void for_parts_of_row(const SpecialCells<T>& cells, int j, F&& visit) {
  const int begin = cells.row_begin[std::size_t(j)], end = cells.row_begin[std::size_t(j) + 1];
  for (int p = cells.part_begin[std::size_t(begin)]; p < cells.part_begin[std::size_t(end)]; ++p)
    visit(p);
}
template <class T>
void clear_part_row(const SpecialCells<T>& cells, T* values, int j) {
  for_parts_of_row(cells, j, [&](int p) { values[p] = T(0); });
}
template <class T>
double part_squares(const SpecialCells<T>& cells, const T* values, int j) {
  double sum = 0.0;
  for_parts_of_row(cells, j, [&](int p) { sum += double(values[p]) * double(values[p]); });
  return sum;
}

/// Near nodes of row j of H d, or of f − H d if there is an f; 0 at known nodes.
template <class T>
void overwrite_near_row(const SpecialRows<T>& rows, const Unknowns<const T>* f,
                        const Unknowns<const T>& d, const SplitRow<T>& out_x,
                        const SplitRow<T>& out_y, int j) {
  for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
    const int i = rows.near(n).column, parity = i & 1, k = i >> 1;
    Vector2<T> value = apply_near(rows, n, d, j);
    if (f) value = {f->x.half(j, parity)[k] - value.x, f->y.half(j, parity)[k] - value.y};
    out_x.half[parity][k] = value.x;
    out_y.half[parity][k] = value.y;
  }
  for (const int i : rows.known(j)) out_x.half[i & 1][i >> 1] = out_y.half[i & 1][i >> 1] = T(0);
}

/// visit(border) for the borders of regular cells of row j with parts.
template <class T, class F>
void for_borders(const SpecialCells<T>& cells, int j, F&& visit) {
  for (int b = cells.border_begin[std::size_t(j)]; b < cells.border_begin[std::size_t(j) + 1]; ++b)
    visit(cells.border[std::size_t(b)]);
}

/// What the jumps between part p of special cell (i, j) and its neighbours add to its row: the
/// neighbours' share.
template <class T>
T neighbour_jumps(const SpecialRows<T>& rows, const Unknowns<const T>& d, int p, int i, int j) {
  T sum = T(0);
  const std::vector<int>& begin = rows.cells().neighbour_begin;
  for (int k = begin[std::size_t(p)]; k < begin[std::size_t(p) + 1]; ++k) {
    const PartNeighbour& other = rows.cells().neighbour[std::size_t(k)];
    constexpr int kEast[] = {0, 1, 0, -1}, kNorth[] = {-1, 0, 1, 0};
    sum += rows.jump(k) * (other.part >= 0 ? d.listed[other.part]
                                           : d.p.at(i + kEast[other.side], j + kNorth[other.side]));
  }
  return sum;
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
  return row.jumps == T(0) ? product : product + neighbour_jumps(rows, d, p, i, j);
}

/// Special cells of cell row j: 0 in the plane's row, B d − compliance dP (or f − that) per part.
/// `out`: one value per part of the level.
template <class T>
void overwrite_part_row(const SpecialRows<T>& rows, const Unknowns<const T>* f,
                        const Unknowns<const T>& d, const SplitRow<T>& out_p, T* out, int j) {
  const SpecialCells<T>& cells = rows.cells();
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n) {
    const int i = cells.column[std::size_t(n)];
    out_p.half[i & 1][i >> 1] = T(0);
    const Four<T> x = CornerValues<const T>(d.x, i, j).load(),
                  y = CornerValues<const T>(d.y, i, j).load();
    for (int p = cells.part_begin[std::size_t(n)]; p < cells.part_begin[std::size_t(n) + 1]; ++p) {
      const T product = apply_part(rows, d, x, y, p, i, j);
      out[p] = f ? f->listed[p] - product : product;
    }
  }
  if (!rows.has_jumps()) return;
  // The vectorised kernels took dP of special cells as 0.
  for_borders(cells, j, [&](const PartBorder& border) {
    const T jump = rows.jump(border.neighbour) * d.listed[border.part];
    out_p.half[border.column & 1][border.column >> 1] += f ? -jump : jump;
  });
}

/// Gauss–Seidel on the near nodes of row j, one after the other.
template <class T>
void relax_near_row(const SpecialRows<T>& rows, const Unknowns<const T>& f, const Unknowns<T>& d,
                    int j) {
  for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
    const NearRow<T>& row = rows.near(n);
    const Vector2<T> product = apply_near<T>(rows, n, d, j);
    const int parity = row.column & 1, k = row.column >> 1;
    d.x.half(j, parity)[k] += (f.x.half(j, parity)[k] - product.x) * row.inverse;
    d.y.half(j, parity)[k] += (f.y.half(j, parity)[k] - product.y) * row.inverse;
  }
}

/// Kaczmarz, weighted by the diagonal, on the parts of the special cells of column parity `parity`
/// in cell row j; the last part first if `reverse`.
template <class T>
void relax_part_row(const SpecialRows<T>& rows, const Unknowns<const T>& f, const Unknowns<T>& d,
                    int parity, bool reverse, int j) {
  const SpecialCells<T>& cells = rows.cells();
  for (const CellVisit<T>& visit : rows.visits(j, parity)) {
    const CornerValues<T> at_x(d.x, visit.column, j), at_y(d.y, visit.column, j);
    Four<T> x = at_x.load(), y = at_y.load();
    const Four<T> inverse(visit.inverse);
    const int begin = cells.part_begin[std::size_t(visit.cell)],
              end = cells.part_begin[std::size_t(visit.cell) + 1];
    for (int m = 0; m < end - begin; ++m) {
      const int p = reverse ? end - 1 - m : begin + m;
      const PartRow<T>& row = rows.part(p);
      const T t = (f.listed[p] - apply_part<T>(rows, d, x, y, p, visit.column, j)) * row.inverse;
      d.listed[p] -= t;
      const Four<T> move = inverse * Four<T>(t);
      x = x + Four<T>(row.bx) * move;
      y = y + Four<T>(row.by) * move;
      if (rows.soft()) move_curve_of_part(*rows.soft(), p, t, d.curve);
    }
    at_x.store(x);
    at_y.store(y);
  }
}

/// Runs a vectorised sweep over the nodes of columns `parity` in row j; near nodes keep their
/// values. `kept`: room for two values a node.
template <class T, class F>
void keep_near_row(const SpecialRows<T>& rows, const Unknowns<T>& d, int parity, int j, T* kept,
                   F&& sweep) {
  T *x = d.x.half(j, parity), *y = d.y.half(j, parity);
  T* slot = kept;
  for (const int k : rows.near_half(j, parity)) {
    *slot++ = x[k];
    *slot++ = y[k];
  }
  sweep();
  slot = kept;
  for (const int k : rows.near_half(j, parity)) {
    x[k] = *slot++;
    y[k] = *slot++;
  }
}

/// Runs a sweep while f of the regular cells of columns `parity` in cell row j that have a part as
/// neighbour carries the jump terms with its dP. `kept`: one value a border.
template <class T, class F>
void with_border_jumps(const SpecialRows<T>& rows, const Unknowns<T>& f, const Unknowns<T>& d,
                       int parity, int j, T* kept, F&& sweep) {
  if (!rows.has_jumps()) return sweep();
  auto each = [&](auto&& visit) {
    T* slot = kept;
    int before = -1;
    for_borders(rows.cells(), j, [&](const PartBorder& border) {
      if ((border.column & 1) != parity) return;
      visit(*slot++, border, border.column != before);
      before = border.column;
    });
  };
  each([&](T& slot, const PartBorder& border, bool) {
    T& volume = f.p.at(border.column, j);
    slot = volume;
    volume -= rows.jump(border.neighbour) * d.listed[border.part];
  });
  sweep();
  each([&](const T& slot, const PartBorder& border, bool first) {
    if (first) f.p.at(border.column, j) = slot;
  });
}

/// keep_near_row for a sweep over the volume rows of the cells of columns `parity` in cell row j,
/// which share no node: the corners of special cells keep their values, known nodes their 0. The
/// sweep takes dP of special cells as 0; meanwhile f carries the jump terms that this leaves out.
/// `kept`: eight values a special cell, one a border.
template <class T, class F>
void keep_special_row(const SpecialRows<T>& rows, const Unknowns<T>& f, const Unknowns<T>& d,
                      int parity, int j, T* kept, F&& sweep) {
  const auto visits = rows.visits(j, parity);
  T* slot = kept;
  for (const CellVisit<T>& visit : visits) {
    const Four<T> x = CornerValues<T>(d.x, visit.column, j).load(),
                  y = CornerValues<T>(d.y, visit.column, j).load();
    x.store(slot);
    y.store(slot + 4);
    slot += 8;
  }
  with_border_jumps(rows, f, d, parity, j, slot, sweep);
  slot = kept;
  T* const p = d.p.half(j, parity);
  for (const CellVisit<T>& visit : visits) {
    CornerValues<T>(d.x, visit.column, j).store(Four<T>(slot));
    CornerValues<T>(d.y, visit.column, j).store(Four<T>(slot + 4));
    slot += 8;
    p[visit.column >> 1] = T(0);
  }
  for (const int row : {j, j + 1})
    for (const int i : rows.loose(row)) d.x.at(i, row) = d.y.at(i, row) = T(0);
}

/// After the prolonged correction of the coarser level was added to rows j of nodes and cells:
/// nodes in special coarse cells get the rest of theirs, known nodes and the plane at special cells
/// 0, parts and cells beside coarse parts their pressures.
template <class T>
void finish_prolongation(const SpecialRows<T>& rows, const SpecialTransfer<T>& transfer,
                         const Unknowns<const T>& coarse, const Unknowns<T>& fine, int j) {
  for (int k = transfer.node_begin[std::size_t(j)]; k < transfer.node_begin[std::size_t(j) + 1];
       ++k) {
    const auto& node = transfer.node[std::size_t(k)];
    for (int c = 0; c < 4; ++c) {
      const int I = node.column + (c & 1), J = node.row + (c >> 1);
      fine.x.at(node.fine, j) += node.weight[c] * coarse.x.at(I, J);
      fine.y.at(node.fine, j) += node.weight[c] * coarse.y.at(I, J);
    }
  }
  prolong_curve_row(transfer, coarse, fine, j);
  for (const int i : rows.known(j)) fine.x.at(i, j) = fine.y.at(i, j) = T(0);
  if (!fine.p) return;
  const SpecialCells<T>& cells = rows.cells();
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n)
    fine.p.at(cells.column[std::size_t(n)], j) = T(0);
  for (int k = transfer.pair_begin[std::size_t(j)]; k < transfer.pair_begin[std::size_t(j) + 1];
       ++k) {
    const auto [to, from] = transfer.pair[std::size_t(k)];
    const T value = from >= 0 ? coarse.listed[from] : coarse.p.at(~from, j / 2);
    (to >= 0 ? fine.listed[to] : fine.p.at(~to, j)) += value;
  }
}

/// After residual row j of a level was restricted to row j of `coarse`: 0 where the coarse level
/// has no equation.
template <class T>
void clear_without_equation(const SpecialRows<T>& coarse_rows, const Unknowns<T>& coarse, int j) {
  for (const int i : coarse_rows.known(j)) coarse.x.at(i, j) = coarse.y.at(i, j) = T(0);
  if (!coarse.p) return;
  const SpecialCells<T>& cells = coarse_rows.cells();
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n)
    coarse.p.at(cells.column[std::size_t(n)], j) = T(0);
  clear_part_row(cells, coarse.listed, j);
}

/// Adds to row J of a coarse plane what residual row j of a finer level gives it beyond bilinear
/// weights.
template <class T>
void add_restricted_nodes(const SpecialTransfer<T>& transfer, const SplitRow<const T>& fine, int j,
                          const Plane<T>& coarse, int J) {
  for (int k = transfer.node_begin[std::size_t(j)]; k < transfer.node_begin[std::size_t(j) + 1];
       ++k) {
    const auto& node = transfer.node[std::size_t(k)];
    if (J != node.row && J != node.row + 1) continue;
    const T* weight = node.weight + 2 * (J - node.row);
    const T value = fine.half[node.fine & 1][node.fine >> 1];
    coarse.at(node.column, J) += weight[0] * value;
    coarse.at(node.column + 1, J) += weight[1] * value;
  }
}

/// Adds the residuals of fine row j's parts, and of its cells under coarse parts, to the coarse
/// level.
template <class T>
void add_restricted_parts(const SpecialTransfer<T>& transfer, const T* parts,
                          const SplitRow<T>& cells, const Unknowns<T>& coarse, int j) {
  for (int k = transfer.pair_begin[std::size_t(j)]; k < transfer.pair_begin[std::size_t(j) + 1];
       ++k) {
    const auto [from, to] = transfer.pair[std::size_t(k)];
    const T value = from >= 0 ? parts[from] : cells.half[~from & 1][~from >> 1];
    (to >= 0 ? coarse.listed[to] : coarse.p.at(~to, j / 2)) += value;
  }
}

}  // namespace drumhead::kernels
