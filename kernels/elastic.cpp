// SPDX-License-Identifier: MIT
#include <drumhead/kernels/elastic.h>

#include <atomic>
#include <cassert>
#include <cmath>
#include <vector>

#include "isotropic.h"
#include "kernel_table.h"
#include "linear_rows.h"
#include "parallel.h"
#include "soft_sweeps.h"
#include "special_energy.h"
#include "special_isotropic.h"
#include "special_sweeps.h"

namespace drumhead::kernels {
namespace {

/// Near nodes and special cells of rows j of H d, or of f − H d.
template <class T>
void overwrite(const Membrane<T>& m, const Unknowns<const T>* f, const Unknowns<const T>& d,
               const Unknowns<T>& out, int j) {
  if (!m.special) return;
  overwrite_near_row(*m.special, f, d, out.x.row(j), out.y.row(j), j);
  if (d.p) overwrite_part_row(*m.special, f, d, out.p.row(j), out.listed, j);
}

/// H d, or f − H d if there is an f, of the elastic kernels' membranes.
template <class T>
void linear_rows(const Membrane<T>& m, const Unknowns<const T>* f, const Unknowns<const T>& d,
                 const Unknowns<T>& out) {
  const KernelTable<T>& kernels = table<T>();
  const auto nodes = f ? kernels.residual_nodes : kernels.apply_nodes;
  for_chunks_of_rows(0, d.x.rows - 1, d.x.columns, [&](int first, int last, int) {
    LinearRows<T> rows(d.x.columns);
    if (d.p) rows.begin(m, d, first);
    for (int j = first; j < last; ++j) {
      if (d.p)
        rows.row(m, f, d, out, j);
      else if (j > 0)
        nodes(m, f, d, out.x.row(j), out.y.row(j), j);
      overwrite<T>(m, f, d, out, j);
    }
  });
  if (m.special) write_curve_rows<T>(*m.special, f, d, out);
}

}  // namespace

template <class T>
void apply_hessian(const Membrane<T>& m, const Unknowns<const T>& d, const Unknowns<T>& out) {
  if (isotropic(m.law.model)) return apply_isotropic(m, d, out);
  linear_rows<T>(m, nullptr, d, out);
}

template <class T>
void linear_residual(const Membrane<T>& m, const Unknowns<const T>& f, const Unknowns<const T>& d,
                     const Unknowns<T>& r) {
  assert(!isotropic(m.law.model));
  linear_rows<T>(m, &f, d, r);
}

template <class T>
int force(const Membrane<T>& m, const Unknowns<T>& f) {
  if (isotropic(m.law.model)) {
    isotropic_force(m, f);
    return 0;
  }
  const KernelTable<T>& kernels = table<T>();
  std::atomic<int> inverted = 0;
  for_rows(0, f.x.rows - 1, f.x.columns, [&](int j) {
    if (j > 0) kernels.force_nodes(m, f, j);
    if (!m.pressure) return;
    kernels.force_cells(m, f, j);
    if (m.special) clear_special_force(m, f, j);
    const int count = kernels.inverted_cells(m, f, j);
    if (count > 0) inverted.fetch_add(count, std::memory_order_relaxed);
  });
  return m.special ? inverted + special_force(m, f) : int(inverted);
}

template <class T>
EnergySums energy(const Membrane<T>& m, const Unknowns<const T>& d, T step) {
  const KernelTable<T>& kernels = table<T>();
  const auto row_energy = isotropic(m.law.model) ? isotropic_rows(m).energy : nullptr;
  const int rows = m.ux.rows - 1;
  thread_local std::vector<EnergySums> of_row;  // of the calling thread, kept from call to call
  of_row.assign(static_cast<std::size_t>(rows), {});
  EnergySums* const at = of_row.data();
  for_rows(0, rows, m.ux.columns, [&](int j) {
    const Columns special = m.special ? special_columns(m.special->cells(), j) : Columns{};
    if (row_energy) {
      row_energy(m, d, step, special, at[j], j);
      if (m.special) add_special_isotropic_energy(m, d, step, at[j], j);
      return;
    }
    kernels.energy(m, d, step, bool(d.x), special, at[j], j);
    if (m.special) add_special_energy(m, d, step, at[j], j);
  });
  EnergySums sums;
  for (const EnergySums& row : of_row) {
    sums.elastic += row.elastic;
    sums.volume += row.volume;
    sums.volume_merit += row.volume_merit;
    sums.constraint += row.constraint;
    sums.inverted_cells += row.inverted_cells;
    if (row.least_J < sums.least_J || std::isnan(row.least_J)) sums.least_J = row.least_J;
  }
  return sums;
}

#define DRUMHEAD_INSTANTIATE(T)                                                                  \
  template void apply_hessian(const Membrane<T>&, const Unknowns<const T>&, const Unknowns<T>&); \
  template void linear_residual(const Membrane<T>&, const Unknowns<const T>&,                    \
                                const Unknowns<const T>&, const Unknowns<T>&);                   \
  template int force(const Membrane<T>&, const Unknowns<T>&);                                    \
  template EnergySums energy(const Membrane<T>&, const Unknowns<const T>&, T);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
