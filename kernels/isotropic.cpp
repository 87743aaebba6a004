// SPDX-License-Identifier: MIT
#include "isotropic.h"

#include <drumhead/kernels/blocks.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/threads.h>
#include <drumhead/kernels/transfer.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel_table.h"
#include "parallel.h"
#include "soft_isotropic.h"
#include "special_energy.h"
#include "special_isotropic.h"
#include "special_sweeps.h"

namespace drumhead::kernels {
namespace {

// The Chebyshev steps damp eigenvalues from this share of the largest on; the coarser lattice takes
// those below.
constexpr double kDampedShare = 0.25;

/// row(first, j) for all cell rows: even ones, then odd ones, so that no two rows at work share a
/// node.
template <class F>
void for_cell_rows(int rows, int columns, F&& row) {
  for (const int odd : {0, 1})
    for_rows(0, (rows + 1 - odd) / 2, 2 * columns, [&](int n) { row(odd == 0, 2 * n + odd); });
}

template <class T>
void for_nodes(const Unknowns<T>& d, int columns, auto&& row) {
  for_rows(1, d.x.rows - 1, columns, row);
}

/// d += omega D⁻¹ (f − H d)
template <class T>
void block_step(const LevelSystem<T>& level, T omega) {
  const Unknowns<const T> d = level.d, f = level.f, product = level.product;
  apply_isotropic(level.membrane, d, level.product);
  for_nodes(level.d, d.x.columns, [&](int j) {
    isotropic_table<T>().block_step(level.membrane.inverse_block, omega, f, product, level.d, j);
  });
}

/// product := f − H d
template <class T>
void residual(const LevelSystem<T>& level) {
  apply_isotropic<T>(level.membrane, level.d, level.product);
  combine<T>(T(1), level.f, T(-1), level.product);
}

template <class T>
void restrict_residual(const LevelSystem<T>& level, const Plane<const T>& fine,
                       const Plane<T>& coarse) {
  for_rows(1, coarse.rows - 1, fine.columns, [&](int j) {
    const int above = 2 * j + 1;
    const SplitRow<const T> upper = fine.row(above < fine.rows ? above : 2 * j);
    table<T>().restrict_nodes(fine.row(2 * j - 1), fine.row(2 * j),
                              above + 1 < fine.rows ? &upper : nullptr, fine.columns, coarse, j);
    if (!level.transfer) return;
    for (int row = 2 * j - 1; row < std::min(2 * j + 2, fine.rows - 1); ++row)
      add_restricted_nodes(*level.transfer, fine.row(row), row, coarse, j);
  });
}

/// Gauss–Seidel on the nodes of special cells: odd rows, then even ones.
template <class T>
void relax_near(const LevelSystem<T>& level) {
  for (const int first : {1, 0})
    for (int j = first; j + 1 < level.d.x.rows; j += 2) {
      relax_block_row<T>(level.membrane, level.f, level.d, j);
      relax_curve_block_row<T>(*level.membrane.special, level.f, level.d, j);
    }
}

template <class T>
void relax_curves(const LevelSystem<T>& level, bool reverse) {
  const int rows = level.d.x.rows - 1;
  for (const int n : {0, 1})
    for (int j = reverse ? 1 - n : n; j < rows; j += 2)
      relax_cuts_row(level.membrane, level.cuts, level.fq, level.dq, level.d, level.f, reverse, j);
}

}  // namespace

template <class T>
const IsotropicRows<T>& isotropic_rows(const Membrane<T>& m) {
  const IsotropicTable<T>& kernels = isotropic_table<T>();
  if (m.tangent) return kernels.averaged;
  switch (m.law.model) {
    case Model::arap:
      return kernels.arap;
    case Model::fold_free:
      return kernels.fold_free;
    case Model::linear:
      return kernels.linear;
    case Model::neohookean:
      return kernels.neohookean;
    case Model::stvk:
      return kernels.stvk;
    case Model::corotated:
    case Model::crpm:
    case Model::harmonic:
      break;
  }
  return kernels.corotated;
}

template <class T>
void apply_isotropic(const Membrane<T>& m, const Unknowns<const T>& d, const Unknowns<T>& out) {
  const IsotropicRows<T>& rows = isotropic_rows(m);
  for_cell_rows(d.x.rows - 1, d.x.columns,
                [&](bool first, int j) { rows.product(m, d, out, first, j); });
  if (!m.special) return;
  for_nodes(d, d.x.columns, [&](int j) { overwrite_block_row(*m.special, d, out, j); });
  write_curve_blocks(*m.special, d, out);
}

template <class T>
void isotropic_force(const Membrane<T>& m, const Unknowns<T>& f) {
  const IsotropicRows<T>& rows = isotropic_rows(m);
  for_cell_rows(f.x.rows - 1, f.x.columns, [&](bool first, int j) { rows.force(m, f, first, j); });
  if (m.special) special_isotropic_force(m, f);
}

template <class T>
void relax_isotropic(const LevelSystem<T>& level, bool from_zero, const Unknowns<const T>* coarse_d,
                     const Unknowns<T>* coarse_f) {
  const Unknowns<T>& d = level.d;
  if (from_zero) {
    combine<T>(T(0), level.f.x, T(0), d.x);
    combine<T>(T(0), level.f.y, T(0), d.y);
    std::fill_n(d.curve, d.curve_count, T(0));
  }
  if (coarse_d)
    for_nodes(d, d.x.columns, [&](int j) {
      table<T>().add_prolonged_nodes(coarse_d->x, d.x, j);
      table<T>().add_prolonged_nodes(coarse_d->y, d.y, j);
      if (level.transfer)
        finish_prolongation(*level.membrane.special, *level.transfer, *coarse_d, d, j);
    });
  // Roots of the second Chebyshev polynomial on [kDampedShare, 1]·largest.
  const double centre = 0.5 * (1.0 + kDampedShare), radius = 0.5 * (1.0 - kDampedShare);
  for (const double side : {1.0, -1.0})
    block_step(level, T(1.0 / (double(level.largest) * (centre + side * radius * std::sqrt(0.5)))));
  if (level.cuts.count > 0)
    for (const bool reverse : {false, true}) relax_curves(level, reverse);
  if (level.membrane.special) relax_near(level);
  if (!coarse_f) return;
  residual(level);
  restrict_residual<T>(level, level.product.x, coarse_f->x);
  restrict_residual<T>(level, level.product.y, coarse_f->y);
  if (level.coarse_special)
    for (int j = 1; j + 1 < coarse_f->x.rows; ++j)
      clear_without_equation(*level.coarse_special, *coarse_f, j);
  if (level.transfer) restrict_to_curves<T>(*level.transfer, level.product, *coarse_f);
}

template <class T>
double isotropic_residual_norm2(const LevelSystem<T>& level) {
  residual(level);
  return dot<T>(level.product.x, level.product.x) + dot<T>(level.product.y, level.product.y) +
         dot_curve<T>(level.product, level.product);
}

template <class T>
void inverse_blocks(const Membrane<T>& m, const Plane<T> (&block)[3]) {
  const IsotropicRows<T>& rows = isotropic_rows(m);
  const Plane<T>& xx = block[0];
  for_cell_rows(xx.rows - 1, xx.columns,
                [&](bool first, int j) { rows.diagonal(m, block, first, j); });
  for_rows(1, xx.rows - 1, xx.columns, [&](int j) {
    if (m.special) overwrite_diagonal_row(*m.special, block, j);
    isotropic_table<T>().invert_blocks(m.mu.value, block, j);
    if (m.special) hold_known_row(*m.special, block, j);
  });
}

template <class T>
void average_tangents(const Membrane<T>& m, const Plane<T>& coarse) {
  constexpr int kEntries = 10;
  auto entry = [](auto plane, int e) {
    plane.rows /= kEntries;
    plane.data += e * plane.rows * plane.stride;
    return plane;
  };
  if (m.tangent) {
    for (int e = 0; e < kEntries; ++e) mean_cells<T>(entry(m.tangent, e), entry(coarse, e));
    return;
  }
  const IsotropicRows<T>& rows = isotropic_rows(m);
  const int columns = m.ux.columns - 1, fine_rows = m.ux.rows - 1;
  const std::ptrdiff_t odd = ((columns + 1) / 2 + 15) / 16 * 16, stride = 2 * odd;
  std::vector<T> storage(std::size_t(thread_limit()) * 2 * kEntries * std::size_t(stride));
  for_rows_on_threads(0, coarse.rows / kEntries, columns, [&](int j, int thread) {
    SplitRow<T> row[2][kEntries];
    T* at = storage.data() + thread * 2 * kEntries * stride;
    for (auto& entries : row)
      for (SplitRow<T>& r : entries) {
        r = {{at, at + odd}};
        at += stride;
      }
    const bool pair = 2 * j + 1 < fine_rows;
    for (int n = 0; n <= int(pair); ++n) {
      rows.tangent(m, row[n], 2 * j + n);
      if (m.special) overwrite_tangent_row(*m.special, row[n], 2 * j + n);
    }
    for (int e = 0; e < kEntries; ++e) {
      const SplitRow<const T> below{{row[0][e].half[0], row[0][e].half[1]}},
          above{{row[1][e].half[0], row[1][e].half[1]}};
      table<T>().mean_cells(below, pair ? &above : nullptr, columns, entry(coarse, e), j);
    }
  });
}

template <class T>
double largest_eigenvalue(const LevelSystem<T>& level, int steps) {
  const Unknowns<T>&d = level.d, &product = level.product;
  std::fill_n(d.curve, d.curve_count, T(0));
  // Signs without a pattern: all frequencies, high ones most.
  unsigned bits = 1;
  for (int j = 1; j + 1 < d.x.rows; ++j)
    for (int i = 1; i + 1 < d.x.columns; ++i) {
      bits = bits * 1664525u + 1013904223u;
      d.x.at(i, j) = bits >> 31 ? T(1) : T(-1);
      d.y.at(i, j) = bits >> 30 & 1u ? T(1) : T(-1);
    }
  double ratio = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double before = std::sqrt(dot<T>(d.x, d.x) + dot<T>(d.y, d.y));
    if (!(before > 0.0)) break;
    apply_isotropic<T>(level.membrane, d, product);
    // d := D⁻¹ H d / |d|, as a step from 0 of the system H d = product
    combine<T>(T(0), d.x, T(0), d.x);
    combine<T>(T(0), d.y, T(0), d.y);
    const Unknowns<const T> nothing = d, image = product;
    for_nodes(d, d.x.columns, [&](int j) {
      isotropic_table<T>().block_step(level.membrane.inverse_block, T(1.0 / before), image, nothing,
                                      d, j);
    });
    ratio = std::sqrt(dot<T>(d.x, d.x) + dot<T>(d.y, d.y));
  }
  return ratio;
}

template <class T>
void update_corner_pressure(const Membrane<T>& m, const Plane<T> (&shift)[4], T* listed) {
  if (m.special) update_triangle_pressure(m, listed);
  for_rows(0, m.ux.rows - 1, m.ux.columns,
           [&](int j) { isotropic_table<T>().corner_pressure(m, shift, j); });
}

#define DRUMHEAD_INSTANTIATE(T)                                                                    \
  template const IsotropicRows<T>& isotropic_rows(const Membrane<T>&);                             \
  template void apply_isotropic(const Membrane<T>&, const Unknowns<const T>&, const Unknowns<T>&); \
  template void isotropic_force(const Membrane<T>&, const Unknowns<T>&);                           \
  template void relax_isotropic(const LevelSystem<T>&, bool, const Unknowns<const T>*,             \
                                const Unknowns<T>*);                                               \
  template double isotropic_residual_norm2(const LevelSystem<T>&);                                 \
  template void inverse_blocks(const Membrane<T>&, const Plane<T>(&)[3]);                          \
  template void average_tangents(const Membrane<T>&, const Plane<T>&);                             \
  template double largest_eigenvalue(const LevelSystem<T>&, int);                                  \
  template void update_corner_pressure(const Membrane<T>&, const Plane<T>(&)[4], T*);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
