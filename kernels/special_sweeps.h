// SPDX-License-Identifier: MIT
#pragma once
// Rows of the list pass: what overwrites the vectorised kernels at near nodes and special cells.
// Plain loops, compiled once for every instruction set.
#include <drumhead/kernels/special.h>

namespace drumhead::kernels {

/// Pointers to three rows of a plane around (i, j).
template <class T>
struct Neighbourhood {
  const T *side[3], *middle[3];  // side: west at [0], east at [1]
  Neighbourhood(const Plane<const T>& f, int i, int j) {
    const int parity = i & 1, k = i >> 1;
    for (int r = 0; r < 3; ++r) {
      side[r] = f.half(j - 1 + r, 1 - parity) + (k - 1 + parity);
      middle[r] = f.half(j - 1 + r, parity) + k;
    }
  }
};

/// H d at a near node of node row j; `next`: the row after it in the list.
template <class T>
void apply_near(const SpecialRows<T>& rows, int n, const Unknowns<const T>& d, int j, T& hx,
                T& hy) {
  const NearRow<T>& row = rows.near(n);
  const Neighbourhood<T> x(d.x, row.column, j), y(d.y, row.column, j);
  T sx[3], sy[3];
  for (int r = 0; r < 3; ++r) {
    const T *k = row.k + 3 * r, *g = row.g + 3 * r;
    const T xw = x.side[r][0], xm = *x.middle[r], xe = x.side[r][1];
    const T yw = y.side[r][0], ym = *y.middle[r], ye = y.side[r][1];
    sx[r] = ((k[0] * xw + k[1] * xm) + k[2] * xe) + ((g[0] * yw + g[1] * ym) + g[2] * ye);
    sy[r] = ((k[0] * yw + k[1] * ym) + k[2] * ye) - ((g[0] * xw + g[1] * xm) + g[2] * xe);
  }
  hx = (sx[0] + sx[1]) + sx[2];
  hy = (sy[0] + sy[1]) + sy[2];
  if (!d.p) return;
  const int parity = row.column & 1, k = row.column >> 1;
  for (int q = 0; q < 4; ++q) {
    const int east = q & 1;
    const T p = d.p.half(j - 1 + (q >> 1), east ? parity : 1 - parity)[east ? k : k - 1 + parity];
    hx += row.bx[q] * p;
    hy += row.by[q] * p;
  }
  const int end = rows.near(n + 1).coupling_begin;
  for (int l = row.coupling_begin; l < end; ++l) {
    const PartCoupling<T>& c = rows.coupling(l);
    hx += c.bx * d.listed[c.part];
    hy += c.by * d.listed[c.part];
  }
}

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
    const NearRow<T>& row = rows.near(n);
    const int parity = row.column & 1, k = row.column >> 1;
    T hx = T(0), hy = T(0);
    if (row.inverse != T(0)) {
      apply_near(rows, n, d, j, hx, hy);
      if (f) {
        hx = f->x.half(j, parity)[k] - hx;
        hy = f->y.half(j, parity)[k] - hy;
      }
    }
    out_x.half[parity][k] = hx;
    out_y.half[parity][k] = hy;
  }
}

/// visit(border) for the borders of regular cells of row j with parts.
template <class T, class F>
void for_borders(const SpecialCells<T>& cells, int j, F&& visit) {
  for (int b = cells.border_begin[std::size_t(j)]; b < cells.border_begin[std::size_t(j) + 1]; ++b)
    visit(cells.border[std::size_t(b)]);
}

/// Row of part p of special cell (i, j), times d.
template <class T>
T apply_part(const SpecialRows<T>& rows, const Unknowns<const T>& d, int p, int i, int j) {
  const PartRow<T>& row = rows.part(p);
  T sum = T(0);
  for (int c = 0; c < 4; ++c)
    sum += row.bx[c] * d.x.at(i + (c & 1), j + (c >> 1)) +
           row.by[c] * d.y.at(i + (c & 1), j + (c >> 1));
  sum -= (row.compliance + row.jumps) * d.listed[p];
  if (row.jumps == T(0)) return sum;
  const std::vector<int>& begin = rows.cells().neighbour_begin;
  for (int k = begin[std::size_t(p)]; k < begin[std::size_t(p) + 1]; ++k) {
    const PartNeighbour& other = rows.cells().neighbour[std::size_t(k)];
    constexpr int kEast[] = {0, 1, 0, -1}, kNorth[] = {-1, 0, 1, 0};
    sum += rows.jump(k) * (other.part >= 0 ? d.listed[other.part]
                                           : d.p.at(i + kEast[other.side], j + kNorth[other.side]));
  }
  return sum;
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
    for (int p = cells.part_begin[std::size_t(n)]; p < cells.part_begin[std::size_t(n) + 1]; ++p) {
      const T product = apply_part(rows, d, p, i, j);
      out[p] = f ? f->listed[p] - product : product;
    }
  }
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
    if (row.inverse == T(0)) continue;
    T hx, hy;
    apply_near<T>(rows, n, d, j, hx, hy);
    const int parity = row.column & 1, k = row.column >> 1;
    d.x.half(j, parity)[k] += (f.x.half(j, parity)[k] - hx) * row.inverse;
    d.y.half(j, parity)[k] += (f.y.half(j, parity)[k] - hy) * row.inverse;
  }
}

/// Kaczmarz, weighted by the diagonal, on the parts of the special cells of column parity `parity`
/// in cell row j; the last part first if `reverse`.
template <class T>
void relax_part_row(const SpecialRows<T>& rows, const Membrane<T>& membrane,
                    const Unknowns<const T>& f, const Unknowns<T>& d, int parity, bool reverse,
                    int j) {
  const SpecialCells<T>& cells = rows.cells();
  // As in relax_volume: s stays positive where all has collapsed, or all corners are known.
  const T floor = T(1e-6) * membrane.spacing * membrane.spacing / (T(4) * membrane.mu.value);
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n) {
    const int i = cells.column[std::size_t(n)];
    if ((i & 1) != parity) continue;
    T inverse[4];
    for (int c = 0; c < 4; ++c) {
      const int node = rows.corner(n, c);
      inverse[c] = node < 0 ? T(0) : rows.near(node).inverse;
    }
    const int begin = cells.part_begin[std::size_t(n)], end = cells.part_begin[std::size_t(n) + 1];
    for (int m = 0; m < end - begin; ++m) {
      const int p = reverse ? end - 1 - m : begin + m;
      const PartRow<T>& row = rows.part(p);
      T s = (row.compliance + row.jumps) + floor;
      for (int c = 0; c < 4; ++c) s += (row.bx[c] * row.bx[c] + row.by[c] * row.by[c]) * inverse[c];
      const T t = (f.listed[p] - apply_part<T>(rows, d, p, i, j)) / s;
      d.listed[p] -= t;
      for (int c = 0; c < 4; ++c) {
        d.x.at(i + (c & 1), j + (c >> 1)) += row.bx[c] * inverse[c] * t;
        d.y.at(i + (c & 1), j + (c >> 1)) += row.by[c] * inverse[c] * t;
      }
    }
  }
}

/// Runs a vectorised sweep over the nodes of columns `parity` in row j; near nodes keep their
/// values. `kept`: room for two values a node.
template <class T, class F>
void keep_near_row(const SpecialRows<T>& rows, const Unknowns<T>& d, int parity, int j, T* kept,
                   F&& sweep) {
  T *x = d.x.half(j, parity), *y = d.y.half(j, parity);
  auto each = [&](auto&& visit) {
    T* slot = kept;
    for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n)
      if (const int i = rows.near(n).column; (i & 1) == parity) {
        visit(slot, i >> 1);
        slot += 2;
      }
  };
  each([&](T* slot, int k) {
    slot[0] = x[k];
    slot[1] = y[k];
  });
  sweep();
  each([&](const T* slot, int k) {
    x[k] = slot[0];
    y[k] = slot[1];
  });
}

/// The same for a sweep over the volume rows of the cells of columns `parity` in cell row j, which
/// share no node: the corners of special cells keep their values, known nodes their 0. The sweep
/// takes dP of special cells as 0; meanwhile f carries the jump terms that this leaves out. `kept`:
/// eight values a special cell, one a border.
template <class T, class F>
void keep_special_row(const SpecialRows<T>& rows, const Unknowns<T>& f, const Unknowns<T>& d,
                      int parity, int j, T* kept, F&& sweep) {
  const SpecialCells<T>& cells = rows.cells();
  auto each = [&](auto&& visit, auto&& visit_border) {
    T* slot = kept;
    for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n)
      if (const int i = cells.column[std::size_t(n)]; (i & 1) == parity) {
        visit(slot, i);
        slot += 8;
      }
    int before = -1;
    for_borders(cells, j, [&](const PartBorder& border) {
      if ((border.column & 1) != parity) return;
      visit_border(*slot++, border, border.column != before);
      before = border.column;
    });
  };
  auto keep = [&](T* slot, int i) {
    for (int c = 0; c < 4; ++c) {
      slot[c] = d.x.at(i + (c & 1), j + (c >> 1));
      slot[4 + c] = d.y.at(i + (c & 1), j + (c >> 1));
    }
  };
  each(keep, [&](T& slot, const PartBorder& border, bool) {
    T& volume = f.p.at(border.column, j);
    slot = volume;
    volume -= rows.jump(border.neighbour) * d.listed[border.part];
  });
  sweep();
  auto restore = [&](const T* slot, int i) {
    for (int c = 0; c < 4; ++c) {
      d.x.at(i + (c & 1), j + (c >> 1)) = slot[c];
      d.y.at(i + (c & 1), j + (c >> 1)) = slot[4 + c];
    }
    d.p.at(i, j) = T(0);
  };
  each(restore, [&](const T& slot, const PartBorder& border, bool first) {
    if (first) f.p.at(border.column, j) = slot;
  });
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
  for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n)
    if (const NearRow<T>& row = rows.near(n); row.inverse == T(0))
      fine.x.at(row.column, j) = fine.y.at(row.column, j) = T(0);
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
  for (int n = coarse_rows.near_begin(j); n < coarse_rows.near_begin(j + 1); ++n)
    if (const NearRow<T>& row = coarse_rows.near(n); row.inverse == T(0))
      coarse.x.at(row.column, j) = coarse.y.at(row.column, j) = T(0);
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
