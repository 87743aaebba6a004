// SPDX-License-Identifier: MIT
#include "part_patch.h"

#include <utility>

#include <drumhead/kernels/parts.h>

namespace drumhead::multigrid {
namespace {

// Shift of the diagonal, relative to its largest entry: incompressible parts may have dependent
// rows.
constexpr double kShift = 1e-8;

/// An entry of C: of part `part` and an unknown node, whose 1/K_ii is `inverse`.
struct Entry {
  int part = 0, node = 0;
  double bx = 0.0, by = 0.0, inverse = 0.0;
};

/// By part. Nodes are near nodes, then curve nodes.
template <class T>
std::vector<Entry> entries_of(const kernels::SpecialRows<T>& rows) {
  const kernels::SpecialCells<T>& cells = rows.cells();
  std::vector<Entry> entries;
  for (int n = 0; n < cells.size(); ++n)
    for (int p = cells.part_begin[std::size_t(n)]; p < cells.part_begin[std::size_t(n) + 1]; ++p) {
      const kernels::PartRow<T>& row = rows.part(p);
      for (int c = 0; c < 4; ++c) {
        const int node = rows.unknown_corner(n, c);
        if (node < 0 || (row.bx[c] == T(0) && row.by[c] == T(0))) continue;
        entries.push_back(
            {p, node, double(row.bx[c]), double(row.by[c]), double(rows.near(node).inverse)});
      }
      if (!rows.soft()) continue;
      for (int k = rows.soft()->area_begin(p); k < rows.soft()->area_begin(p + 1); ++k) {
        const kernels::AreaCoupling<T>& c = rows.soft()->of_part(k);
        entries.push_back({p, rows.near_count() + c.other, double(c.bx), double(c.by),
                           double(rows.soft()->inverse(c.other))});
      }
    }
  return entries;
}

/// C D⁻¹ Cᵀ + M.
template <class T>
SparseRows normal_matrix(const kernels::SpecialRows<T>& rows) {
  const kernels::SpecialCells<T>& cells = rows.cells();
  const std::vector<Entry> entries = entries_of(rows);
  std::vector<std::size_t> begin(std::size_t(rows.near_count()) + cells.crossing.size() + 1, 0);
  for (const Entry& e : entries) ++begin[std::size_t(e.node) + 1];
  for (std::size_t n = 1; n < begin.size(); ++n) begin[n] += begin[n - 1];
  std::vector<const Entry*> of_node(entries.size());
  std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
  for (const Entry& e : entries) of_node[end[std::size_t(e.node)]++] = &e;

  SparseRows product;
  std::size_t at = 0;
  for (int p = 0; p < cells.parts(); ++p) {
    for (; at < entries.size() && entries[at].part == p; ++at) {
      const Entry& own = entries[at];
      for (std::size_t k = begin[std::size_t(own.node)]; k < end[std::size_t(own.node)]; ++k)
        product.add(of_node[k]->part,
                    own.inverse * (own.bx * of_node[k]->bx + own.by * of_node[k]->by));
    }
    product.add(p, double(rows.part(p).compliance) + double(rows.part(p).jumps));
    for (int k = cells.neighbour_begin[std::size_t(p)];
         k < cells.neighbour_begin[std::size_t(p) + 1]; ++k)
      if (const int other = cells.neighbour[std::size_t(k)].part; other >= 0 && rows.has_jumps())
        product.add(other, -double(rows.jump(k)));
    product.end_row();
  }
  return product;
}

}  // namespace

template <class T>
PartPatch<T>::PartPatch(const kernels::LevelSystem<T>& level, grid::MemoryMeter& meter)
    : t_(std::size_t(level.membrane.special->cells().parts())), meter_(&meter) {
  factors_.factorise(normal_matrix(*level.membrane.special), kShift);
  meter.add(factors_.bytes() + t_.size() * sizeof(double));
}

template <class T>
PartPatch<T>::PartPatch(PartPatch&& other) noexcept
    : factors_(std::move(other.factors_)),
      t_(std::move(other.t_)),
      meter_(std::exchange(other.meter_, nullptr)) {}

template <class T>
PartPatch<T>::~PartPatch() {
  if (meter_) meter_->remove(factors_.bytes() + t_.size() * sizeof(double));
}

template <class T>
void PartPatch<T>::relax(const kernels::LevelSystem<T>& level) {
  kernels::parts_residual(level, t_.data());
  factors_.solve(t_);
  kernels::move_along_parts(level, t_.data());
}

template class PartPatch<float>;
template class PartPatch<double>;

}  // namespace drumhead::multigrid
