// SPDX-License-Identifier: MIT
#include "special_isotropic.h"

#include <algorithm>

#include "soft_isotropic.h"
#include "special_energy.h"
#include "special_points.h"

namespace drumhead::kernels {
namespace {

constexpr int kEntries = 10;

/// Place in a BlockRow of corner `other` of a cell, seen from its corner `own`.
std::size_t block_place(int own, int other) {
  return std::size_t(4 + ((other & 1) - (own & 1)) + 3 * ((other >> 1) - (own >> 1)));
}

/// Adds a point's stiffness to the rows of the near nodes at a cell's corners.
template <class T>
void add_point(const Point<T>& point, const T* entries, const int* near,
               std::vector<BlockRow<T>>& block) {
  const Stiffness<T> k(entries);
  const std::size_t count = std::size_t(point.count);
  for (std::size_t a = 0; a < count; ++a) {
    const int own = point.vertex[a];
    if (own >= kFirstCrossing || near[own] < 0) continue;
    BlockRow<T>& row = block[std::size_t(near[own])];
    const PointRow<T> of_node(k, point, a);
    for (std::size_t b = 0; b < count; ++b) {
      if (point.vertex[b] >= kFirstCrossing) continue;
      const std::size_t place = block_place(own, point.vertex[b]);
      const NodeBlock<T> value = of_node.block(point, b);
      row.xx[place] += value.xx;
      row.xy[place] += value.xy;
      row.yx[place] += value.yx;
      row.yy[place] += value.yy;
    }
  }
}

/// Adds the points of cells to block rows, and to their mean tangents.
template <class T>
class Linearisation {
 public:
  Linearisation(const Membrane<T>& m, std::vector<BlockRow<T>>& block, SoftRows<T>& soft)
      : m_(m), block_(block), soft_(soft) {}

  void fringe(const FringeCell& cell) {
    if (m_.tangent) {
      read(cell.column, cell.row);
      for (const double t : kGauss)
        for (const double s : kGauss)
          add_point(point_of(m_.spacing, T(s), T(t)), entries_, cell.near, block_);
      return;
    }
    const CellLaw<T> law(m_, cell.column, cell.row);
    law.for_points([&](const Point<T>& point, Share share, T shift) {
      evaluate(law, point, share, shift);
      add_point(point, entries_, cell.near, block_);
    });
  }

  /// `mean`: ten entries.
  void special(int n, int i, int j, T* mean) {
    const SpecialRows<T>& rows = *m_.special;
    const SpecialCells<T>& cells = rows.cells();
    int near[4];
    for (int c = 0; c < 4; ++c) near[c] = rows.unknown_corner(n, c);
    if (m_.tangent) {
      read(i, j);
      std::copy_n(entries_, kEntries, mean);
      for (int t = cells.triangle_begin[std::size_t(n)];
           t < cells.triangle_begin[std::size_t(n) + 1]; ++t)
        add(point_of(cells.triangle[std::size_t(t)]), near, i, j);
      return;
    }
    std::fill_n(mean, kEntries, T(0));
    T area = T(0);
    const CellLaw<T> law(m_, i, j);
    law.for_points(n, [&](const Point<T>& point, Share share, T shift) {
      evaluate(law, point, share, shift);
      add(point, near, i, j);
      for (int e = 0; e < kEntries; ++e) mean[e] += point.weight * entries_[e];
    });
    for_parts(cells, n, [&](int p) { area += cells.area[std::size_t(p)]; });
    for (int e = 0; e < kEntries; ++e) mean[e] /= area;
  }

 private:
  void add(const Point<T>& point, const int* near, int i, int j) {
    add_point(point, entries_, near, block_);
    if (soft_.size() > 0) add_curve_point(point, entries_, near, i, j, soft_);
  }
  void evaluate(const CellLaw<T>& law, const Point<T>& point, Share share, T shift) {
    law.tangent(point, share, shift, entries_);
  }
  void read(int i, int j) {
    const int rows = m_.tangent.rows / kEntries;
    for (int e = 0; e < kEntries; ++e) entries_[e] = m_.tangent.at(i, e * rows + j);
  }

  const Membrane<T>& m_;
  std::vector<BlockRow<T>>& block_;
  SoftRows<T>& soft_;
  T entries_[kEntries];
};

template <class T, class F>
void add_force(const Point<T>& point, const PointStress<T>& stress, F&& add) {
  for (std::size_t a = 0; a < std::size_t(point.count); ++a) {
    const T gx = point.gx[a], gy = point.gy[a];
    add(point.vertex[a], -point.weight * (stress.p11 * gx + stress.p12 * gy),
        -point.weight * (stress.p21 * gx + stress.p22 * gy));
  }
}

/// Whether hard curves and the fixed boundary hold all of a point's nodes.
template <class T>
bool is_held(const SpecialRows<T>& rows, int n, const Point<T>& point) {
  return std::none_of(point.vertex.begin(), point.vertex.begin() + point.count, [&](int vertex) {
    return vertex < kFirstCrossing ? rows.unknown_corner(n, vertex) >= 0
                                   : is_soft(rows.soft(), vertex);
  });
}

template <class T>
void clear_known_row(const SpecialRows<T>& rows, const Unknowns<T>& f, int j) {
  for (const int i : rows.known(j)) f.x.at(i, j) = f.y.at(i, j) = T(0);
}

/// The row of near node n = (i, j) times d.
template <class T>
Vector2<T> block_times(const SpecialRows<T>& rows, int n, const Unknowns<const T>& d, int i,
                       int j) {
  const BlockRow<T>& row = rows.block(n);
  Vector2<T> sum{T(0), T(0)};
  for (int k = 0; k < 9; ++k) {
    const T x = d.x.at(i + k % 3 - 1, j + k / 3 - 1), y = d.y.at(i + k % 3 - 1, j + k / 3 - 1);
    sum.x += row.xx[k] * x + row.xy[k] * y;
    sum.y += row.yx[k] * x + row.yy[k] * y;
  }
  if (rows.soft()) add_curve_blocks_to_near(*rows.soft(), n, d.curve, sum);
  return sum;
}

/// Adds the springs of soft curves' lattice nodes to their rows.
template <class T>
void add_springs(const SpecialRows<T>& rows, std::vector<BlockRow<T>>& block) {
  const SpecialCells<T>& cells = rows.cells();
  for (int j = 0; j + 1 < int(cells.held_begin.size()); ++j) {
    int n = rows.near_begin(j);
    for (int k = cells.held_begin[std::size_t(j)]; k < cells.held_begin[std::size_t(j) + 1]; ++k) {
      const HeldNode<T>& node = cells.held[std::size_t(k)];
      if (node.known()) continue;
      while (n < rows.near_begin(j + 1) && rows.near_node(n).column < node.place) ++n;
      if (n == rows.near_begin(j + 1) || rows.near_node(n).column != node.place) continue;
      block[std::size_t(n)].xx[4] += node.stiffness;
      block[std::size_t(n)].yy[4] += node.stiffness;
    }
  }
}

}  // namespace

template <class T>
void SpecialRows<T>::list_fringe(int rows) {
  block_.resize(near_.size());
  tangent_.assign(std::size_t(kEntries * cells_->size()), T(0));
  for (int j = 0; j + 1 < rows; ++j) {
    std::vector<FringeCell> cells;
    for (const int row : {j, j + 1}) {
      if (row == 0 || row + 1 == rows) continue;
      for (int n = near_begin(row); n < near_begin(row + 1); ++n) {
        const NearNode& node = near_node(n);
        for (const int east : {0, 1}) {  // of the node, seen from the cell
          const int corner = east + 2 * (row - j), q = 3 - corner;
          if (!(node.regular >> q & 1)) continue;
          const int column = node.column - east;
          auto at = std::ranges::find(cells, column, &FringeCell::column);
          if (at == cells.end()) at = cells.insert(cells.end(), {.column = column, .row = j});
          at->near[corner] = n;
        }
      }
    }
    std::ranges::sort(cells, {}, &FringeCell::column);
    fringe_.insert(fringe_.end(), cells.begin(), cells.end());
  }
}

template <class T>
void SpecialRows<T>::linearise_isotropic(const Membrane<T>& m) {
  std::ranges::fill(block_, BlockRow<T>{});
  soft_.clear_blocks(*cells_);
  add_springs(*this, block_);
  Linearisation<T> to(m, block_, soft_);
  for (const FringeCell& cell : fringe_) to.fringe(cell);
  for_special(*cells_, [&](int n, int i, int j) {
    to.special(n, i, j, &tangent_[std::size_t(kEntries * n)]);
  });
  soft_.invert_blocks(m.mu.value);
}

template <class T>
void special_isotropic_force(const Membrane<T>& m, const Unknowns<T>& f) {
  const SpecialRows<T>& rows = *m.special;
  for (int j = 1; j + 1 < m.ux.rows; ++j) {
    clear_known_row(rows, f, j);
    for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n)
      f.x.at(rows.near_node(n).column, j) = f.y.at(rows.near_node(n).column, j) = T(0);
  }
  add_spring_force(rows.cells(), f);
  // `add`(vertex, x, y): to the force on one of the cell's nodes.
  auto visit = [](const CellLaw<T>& law, auto&& add) {
    return [&law, add](const Point<T>& point, Share share, T shift) {
      add_force(point, law.law(share).stress(law.state(point, share, shift)), add);
    };
  };
  for (const FringeCell& cell : rows.fringe()) {
    const CellLaw<T> law(m, cell.column, cell.row);
    law.for_points(visit(law, [&](int c, T x, T y) {
      if (cell.near[c] < 0) return;
      f.x.at(cell.column + (c & 1), cell.row + (c >> 1)) += x;
      f.y.at(cell.column + (c & 1), cell.row + (c >> 1)) += y;
    }));
  }
  for_special(rows.cells(), [&](int n, int i, int j) {
    const CellLaw<T> law(m, i, j);
    CellForce<T> force(f, rows, n, i, j);
    law.for_points(n, visit(law, [&](int vertex, T x, T y) { force.add(vertex, {x, y}); }));
    force.store();
  });
}

template <class T>
void add_special_isotropic_energy(const Membrane<T>& m, const Unknowns<const T>& d, T step,
                                  EnergySums& sums, int j) {
  const SpecialCells<T>& cells = m.special->cells();
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n) {
    const int i = cells.column[std::size_t(n)];
    const CellState<T> displacement(cells, m.ux, m.uy, i, j, d, step);
    auto det = [](const PointState<T>& at) {
      return double(at.f11) * double(at.f22) - double(at.f12) * double(at.f21);
    };
    const CellLaw<T> law(m, i, j);
    law.for_points(n, [&](const Point<T>& point, Share share, T shift) {
      if (is_held(*m.special, n, point)) return;
      const PointState<T> at = law.state(point, share, shift, displacement);
      const PointStress<T> psi = law.law(share).stress(at);
      sums.elastic += double(point.weight) * double(psi.shape);
      sums.volume += double(point.weight) * double(psi.volume);
      sums.volume_merit += double(point.weight) * double(psi.volume);
      // Keeps a NaN. The part's mean is not where neohookean has its logarithm alone.
      if (const double J = det(at); !(J >= sums.least_J)) sums.least_J = J;
    });
    bool inverted = false;
    for_parts(cells, n, [&](int p) {
      inverted |= det(law.state(point_of(cells, p), Share::all, T(0), displacement)) < 0.0;
    });
    sums.inverted_cells += inverted;
  }
  add_spring_energy(*m.special, d, step, sums, j);
}

template <class T>
void update_triangle_pressure(const Membrane<T>& m, T* shift) {
  const SpecialCells<T>& cells = m.special->cells();
  for_special(cells, [&](int n, int i, int j) {
    const CellLaw<T> law(m, i, j);
    for (int t = cells.triangle_begin[std::size_t(n)]; t < cells.triangle_begin[std::size_t(n) + 1];
         ++t) {
      const PointState<T> at =
          law.state(point_of(cells.triangle[std::size_t(t)]), Share::corner, shift[t]);
      shift[t] = isotropic_table<T>().point_pressure(at) * (T(1) / m.law.relief);
    }
  });
}

template <class T>
void overwrite_block_row(const SpecialRows<T>& rows, const Unknowns<const T>& d,
                         const Unknowns<T>& out, int j) {
  clear_known_row(rows, out, j);
  for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
    const int i = rows.near_node(n).column;
    const Vector2<T> image = block_times(rows, n, d, i, j);
    out.x.at(i, j) = image.x;
    out.y.at(i, j) = image.y;
  }
}

template <class T>
void overwrite_diagonal_row(const SpecialRows<T>& rows, const Plane<T>* block, int j) {
  for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
    const int i = rows.near_node(n).column;
    const BlockRow<T>& row = rows.block(n);
    block[0].at(i, j) = row.xx[4];
    block[1].at(i, j) = row.xy[4];
    block[2].at(i, j) = row.yy[4];
  }
}

template <class T>
void hold_known_row(const SpecialRows<T>& rows, const Plane<T>* inverse, int j) {
  for (const int i : rows.known(j))
    for (int e = 0; e < 3; ++e) inverse[e].at(i, j) = T(0);
}

template <class T>
void overwrite_tangent_row(const SpecialRows<T>& rows, const SplitRow<T>* entries, int j) {
  const SpecialCells<T>& cells = rows.cells();
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n) {
    const int i = cells.column[std::size_t(n)];
    for (int e = 0; e < kEntries; ++e) entries[e].half[i & 1][i >> 1] = rows.tangent(n)[e];
  }
}

template <class T>
void relax_block_row(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<T>& d,
                     int j) {
  const SpecialRows<T>& rows = *m.special;
  for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
    const int i = rows.near_node(n).column;
    const Vector2<T> image = block_times<T>(rows, n, d, i, j);
    const T x = f.x.at(i, j) - image.x, y = f.y.at(i, j) - image.y;
    const T xy = m.inverse_block[1].at(i, j);
    d.x.at(i, j) += m.inverse_block[0].at(i, j) * x + xy * y;
    d.y.at(i, j) += xy * x + m.inverse_block[2].at(i, j) * y;
  }
}

#define DRUMHEAD_INSTANTIATE(T)                                                                   \
  template void SpecialRows<T>::list_fringe(int);                                                 \
  template void SpecialRows<T>::linearise_isotropic(const Membrane<T>&);                          \
  template void special_isotropic_force(const Membrane<T>&, const Unknowns<T>&);                  \
  template void add_special_isotropic_energy(const Membrane<T>&, const Unknowns<const T>&, T,     \
                                             EnergySums&, int);                                   \
  template void update_triangle_pressure(const Membrane<T>&, T*);                                 \
  template void overwrite_block_row(const SpecialRows<T>&, const Unknowns<const T>&,              \
                                    const Unknowns<T>&, int);                                     \
  template void overwrite_diagonal_row(const SpecialRows<T>&, const Plane<T>*, int);              \
  template void hold_known_row(const SpecialRows<T>&, const Plane<T>*, int);                      \
  template void overwrite_tangent_row(const SpecialRows<T>&, const SplitRow<T>*, int);            \
  template void relax_block_row(const Membrane<T>&, const Unknowns<const T>&, const Unknowns<T>&, \
                                int);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
