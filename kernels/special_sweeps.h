// SPDX-License-Identifier: MIT
#pragma once
// Rows of the list pass: what overwrites the vectorised kernels at near nodes and special cells.
// Plain loops, compiled once for every instruction set.
#include <drumhead/kernels/special.h>

#include "special_products.h"

namespace drumhead::kernels {

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
  // Rows of buffers may be laid out otherwise than those of fields.
  const std::ptrdiff_t odd = d.x.odd, shift = (out_x.half[1] - out_x.half[0]) - odd;
  const T *fx = f ? f->x.half(j, 0) : nullptr, *fy = f ? f->y.half(j, 0) : nullptr;
  T *x = out_x.half[0], *y = out_y.half[0];
  for_near_products(rows, d, j, [=](const NearRow<T>& row, Vector2<T> value) {
    if (fx) value = {fx[row.place] - value.x, fy[row.place] - value.y};
    const std::ptrdiff_t at = row.place + (row.place >= odd ? shift : 0);
    x[at] = value.x;
    y[at] = value.y;
  });
  for (const int i : rows.known(j)) out_x.half[i & 1][i >> 1] = out_y.half[i & 1][i >> 1] = T(0);
}

/// Special cells of cell row j: 0 in the plane's row, B d − compliance dP (or f − that) per part.
/// `out`: one value per part of the level.
template <class T>
void overwrite_part_row(const SpecialRows<T>& rows, const Unknowns<const T>* f,
                        const Unknowns<const T>& d, const SplitRow<T>& out_p, T* out, int j) {
  with_kind(rows, [&](auto soft, auto joined) {
    const PartRowView<T, soft.value, joined.value> view(rows, d, j);
    const SpecialCells<T>& cells = rows.cells();
    const int begin = cells.row_begin[std::size_t(j)], end = cells.row_begin[std::size_t(j) + 1];
    int p = cells.part_begin[std::size_t(begin)];
    for (int n = begin; n < end; ++n) {
      const int i = cells.column[std::size_t(n)];
      out_p.half[i & 1][i >> 1] = T(0);
      const Four<T> x = CornerValues<const T>(d.x, i, j).load(),
                    y = CornerValues<const T>(d.y, i, j).load();
      for (const int last = cells.part_begin[std::size_t(n) + 1]; p < last; ++p) {
        const T product = view.apply(x, y, p, i);
        out[p] = f ? f->listed[p] - product : product;
      }
    }
  });
  if (!rows.has_border_jumps()) return;
  // The vectorised kernels took dP of special cells as 0.
  for (const int parity : {0, 1})
    for (const BorderJump<T>& border : rows.borders(j, parity)) {
      const T jump = border.jump * d.listed[border.part];
      out_p.half[parity][border.half] += f ? -jump : jump;
    }
}

/// Gauss–Seidel on the near nodes of row j, one after the other.
template <class T>
void relax_near_row(const SpecialRows<T>& rows, const Unknowns<const T>& f, const Unknowns<T>& d,
                    int j) {
  const T *fx = f.x.half(j, 0), *fy = f.y.half(j, 0);
  T *x = d.x.half(j, 0), *y = d.y.half(j, 0);
  for_near_products<T>(rows, d, j, [=](const NearRow<T>& row, const Vector2<T>& product) {
    x[row.place] += (fx[row.place] - product.x) * row.inverse;
    y[row.place] += (fy[row.place] - product.y) * row.inverse;
  });
}

/// Kaczmarz, weighted by the diagonal, on the parts of the special cells in cell row j: those of
/// even columns first, or, if `reverse`, those of odd ones and of a cell's the last part first.
template <class T>
void relax_part_row(const SpecialRows<T>& rows, const Unknowns<const T>& f, const Unknowns<T>& d,
                    bool reverse, int j) {
  with_kind(rows, [&](auto soft, auto joined) {
    const PartRowView<T, soft.value, joined.value> view(rows, d, j);
    const T* const wanted = f.listed;
    T* const listed = d.listed;
    const int step = reverse ? -1 : 1;
    const auto relax = [&](const CellVisit<T>& visit) {
      const CornerValues<T> at_x(d.x, visit.column, j), at_y(d.y, visit.column, j);
      Four<T> x = at_x.load(), y = at_y.load();
      const Four<T> inverse(visit.inverse);
      int p = reverse ? visit.part_end - 1 : visit.part_begin;
      for (int m = visit.part_begin; m < visit.part_end; ++m, p += step) {
        const PartRow<T>& row = rows.part(p);
        const T t = (wanted[p] - view.apply(x, y, p, visit.column)) * row.inverse;
        listed[p] -= t;
        const Four<T> move = inverse * Four<T>(t);
        x = x + Four<T>(row.bx) * move;
        y = y + Four<T>(row.by) * move;
        if constexpr (soft.value) move_curve_of_part(*rows.soft(), p, t, d.curve);
      }
      at_x.store(x);
      at_y.store(y);
    };
    for (const int parity : {int(reverse), int(!reverse)})
      for (const CellVisit<T>& visit : rows.visits(j, parity)) relax(visit);
  });
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

/// Runs a sweep while f of the regular cells of cell row j that have a part as neighbour carries
/// the jump terms with its dP. `kept`: one value a border.
template <class T, class F>
void with_border_jumps(const SpecialRows<T>& rows, const Unknowns<T>& f, const Unknowns<T>& d,
                       int j, T* kept, F&& sweep) {
  if (!rows.has_border_jumps()) return sweep();
  for (const int parity : {0, 1})
    for (const BorderJump<T>& border : rows.borders(j, parity)) {
      T& volume = f.p.half(j, parity)[border.half];
      *kept++ = volume;
      volume -= border.jump * d.listed[border.part];
    }
  sweep();
  // Backwards: of a cell with several parts the first entry kept what it had.
  for (const int parity : {1, 0}) {
    const auto borders = rows.borders(j, parity);
    for (std::size_t b = borders.size(); b-- > 0;) f.p.half(j, parity)[borders[b].half] = *--kept;
  }
}

/// Runs a vectorised sweep(share) over cell row j that leaves special cells as they are. `share`: 1
/// for every cell.
template <class T, class F>
void without_special_cells(const SpecialRows<T>& rows, int j, const SplitRow<T>& share, F&& sweep) {
  const auto set_share = [&](T value) {
    for (const int parity : {0, 1})
      for (const CellVisit<T>& visit : rows.visits(j, parity))
        share.half[parity][visit.column >> 1] = value;
  };
  set_share(T(0));
  sweep({{share.half[0], share.half[1]}});
  set_share(T(1));
}

/// The volume rows of the cells of cell row j: a sweep over regular ones, then the parts of the
/// special ones, of each those of even columns first unless `reverse`. The sweep takes dP of
/// special cells as 0; meanwhile f carries the jump terms that this leaves out. `kept`: one value a
/// border.
template <class T, class F>
void relax_volume_and_parts(const SpecialRows<T>& rows, const Unknowns<T>& f, const Unknowns<T>& d,
                            bool reverse, int j, T* kept, F&& sweep) {
  with_border_jumps(rows, f, d, j, kept, sweep);
  for (const int row : {j, j + 1})
    for (const int i : rows.loose(row)) d.x.at(i, row) = d.y.at(i, row) = T(0);
  relax_part_row<T>(rows, f, d, reverse, j);
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
