// SPDX-License-Identifier: MIT
#include "hierarchy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <drumhead/kernels/threads.h>
#include <drumhead/kernels/transfer.h>

namespace drumhead::multigrid {
namespace {

// The dense solver of the bottom level costs n³: at 8² (about 220 unknowns) .54 ms, as much as a
// cycle on 100² cells; at 4² it is negligible.
constexpr int kBottomCells = 4;
// Isotropic membranes and masks of mu, whose coarse operators are poor on a lattice of fewer cells
// than curves: ML with arap takes 52 cycles a step from 3 cells instead of 4 from 6; S2 with mu 100
// in a disc, kappa 10, 128²: an F-cycle leaves 55 times the residual from 4 cells, .87 from 8.
constexpr int kLargeBottomCells = 8;
// kappa = 0 in some cells of a scene with pressures: compliance that makes P negligible.
constexpr double kMostCompliance = 1e6;
// arap: stiffness of a corner at first; Newton raises it, and takes what kappa has above that from
// corner pressures.
constexpr double kRelief = 10.0;
// fold-free: of a corner below eps, in the end. With 1e6 pressures take longer to settle (S2, kappa
// 1, 200²: at corners that have not, the energy of what is left is 5 % of the whole).
constexpr double kCornerStiffness = 1e4;

// Fields that take so much together lie in one piece. Smaller ones stay apart, so that a tool that
// looks for accesses beyond an end finds them.
constexpr std::size_t kOnePiece = std::size_t(1) << 21;

bool coarsest(int nx, int ny, bool large) {
  const int most = large ? kLargeBottomCells : kBottomCells;
  return std::max(nx, ny) <= most || std::min(nx, ny) <= 3;
}

/// Of the fields that every level has: lattices halve, so a third more than the finest's.
template <class T>
std::size_t bytes_of_levels(int nx, int ny, const SceneTraits& traits) {
  std::size_t bytes = 0;
  for (; std::min(nx, ny) > 1; nx = grid::coarse_cells(nx), ny = grid::coarse_cells(ny))
    bytes += Level<T>::bytes(nx, ny, traits);
  return bytes;
}

/// Geometric means of the cells that a coarse cell covers, those at an odd edge counted twice. The
/// mean of mu is too stiff where it jumps, that of 1/kappa too soft: a stiff region loses half a
/// coarse cell along its edge on every level, and its coarse corrections overshoot. What F-cycles
/// leave in the end: S3, 400², .91 (mean of 1/kappa: 5.0); mu .01 in a disc, kappa 10, 128²: S2 .90
/// (mean of mu: 38), S4 .94 (4.2).
template <class T>
void geometric_means(const kernels::Plane<const T>& fine, const kernels::Plane<T>& coarse) {
  for (int j = 0; j < coarse.rows; ++j)
    for (int i = 0; i < coarse.columns; ++i) {
      const int east = std::min(2 * i + 1, fine.columns - 1);
      const int north = std::min(2 * j + 1, fine.rows - 1);
      const double below = double(fine.at(2 * i, 2 * j)) * double(fine.at(east, 2 * j));
      const double above = double(fine.at(2 * i, north)) * double(fine.at(east, north));
      coarse.at(i, j) = T(std::sqrt(std::sqrt(below) * std::sqrt(above)));
    }
}

}  // namespace

template <class T>
Hierarchy<T>::Hierarchy(const grid::Lattice& lattice, const grid::Material& material,
                        const grid::CutCells& cuts, const SceneTraits& traits,
                        grid::MemoryMeter& meter)
    : traits_(traits), scratch_(lattice.nx + 1, kernels::thread_limit()) {
  int nx = lattice.nx, ny = lattice.ny;
  if (const std::size_t bytes = bytes_of_levels<T>(nx, ny, traits); bytes >= kOnePiece)
    meter.reserve(bytes);
  grid::CutCells rows = cuts;
  for (T spacing = T(1);; spacing *= T(2)) {
    Level<T>& level = levels_.emplace_back(nx, ny, spacing, traits, meter);
    if (kernels::isotropic(traits.model) && levels_.size() > 1)
      level.solid.tangent = grid::Field<T>(nx, 10 * ny, meter);
    level.cuts = CutRows<T>(rows);
    if (!rows.column.empty()) level.set_band(rows.row_begin, rows.column, meter);
    level.wanted = rows.wanted;
    level.q.assign(2 * rows.column.size(), T(0));
    level.dq = level.fq = level.q;
    meter.add(level.cuts.bytes() + 3 * level.q.size() * sizeof(T) +
              level.wanted.size() * sizeof(grid::Point));
    const bool large = kernels::isotropic(traits.model) || !material.mu_cells.empty();
    if (coarsest(nx, ny, large)) break;
    grid::CoarseCuts coarse = grid::coarsen(rows, nx, ny);
    level.to_coarse = {std::move(coarse.parent), {coarse.share.begin(), coarse.share.end()}};
    rows = std::move(coarse.cuts);
    nx = grid::coarse_cells(nx);
    ny = grid::coarse_cells(ny);
  }
  set_material(material, meter);
}

template <class T>
void Hierarchy<T>::set_material(const grid::Material& material, grid::MemoryMeter& meter) {
  Level<T>& finest = levels_.front();
  auto fill = [&](grid::Field<T>& field, const std::vector<float>& cells, auto&& value) {
    if (cells.empty()) return;
    field = grid::Field<T>(finest.nx, finest.ny, meter);
    std::size_t c = 0;
    for (int j = 0; j < finest.ny; ++j)
      for (int i = 0; i < finest.nx; ++i) field.view().at(i, j) = T(value(double(cells[c++])));
  };
  fill(finest.mu, material.mu_cells, [](double mu) { return mu; });
  if (traits_.pressure && !material.kappa_cells.empty())
    for (Level<T>& level : levels_) level.compliance = grid::Field<T>(level.nx, level.ny, meter);
  set_compliance(material, std::numeric_limits<double>::infinity());
  if (kernels::isotropic(traits_.model))
    fill(finest.solid.kappa, material.kappa_cells, [](double kappa) { return kappa; });
  const bool fold_free = traits_.model == kernels::Model::fold_free;
  for (Level<T>& level : levels_) {
    level.solid.law.kappa.value = T(material.kappa);
    if (fold_free) level.solid.law.corner = T(kCornerStiffness);
    level.solid.law.eps =
        T(material.model == kernels::Model::neohookean ? kFirstFloor : material.eps);
  }
  if (traits_.model == kernels::Model::arap || fold_free) relieve(material, meter);
  law_ = levels_.front().solid.law;
  for (int l = 0; l + 1 < size(); ++l) {
    Level<T>&fine = levels_[std::size_t(l)], &coarse = levels_[std::size_t(l) + 1];
    auto average = [&](const grid::Field<T>& from, grid::Field<T>& to) {
      if (!from) return;
      to = grid::Field<T>(coarse.nx, coarse.ny, meter);
      kernels::mean_cells<T>(from.view(), to.view());
    };
    if (kernels::isotropic(traits_.model)) {
      average(fine.mu, coarse.mu);
    } else if (fine.mu) {
      coarse.mu = grid::Field<T>(coarse.nx, coarse.ny, meter);
      geometric_means<T>(fine.mu.view(), coarse.mu.view());
    }
    average(fine.solid.kappa, coarse.solid.kappa);
  }
  for (Level<T>& level : levels_) {
    if (!level.mu) continue;
    set_diagonal(level, meter);
    level.cuts.divide_jump(level.mu.view());
  }
}

template <class T>
void Hierarchy<T>::set_compliance(const grid::Material& material, double most) {
  auto compliance = [most](double kappa) {
    return T(std::min(kMostCompliance, 1.0 / std::min(kappa, most)));
  };
  const Level<T>& finest = levels_.front();
  std::size_t cell = 0;
  for (int j = 0; j < finest.ny && finest.compliance; ++j)
    for (int i = 0; i < finest.nx; ++i)
      levels_.front().compliance.view().at(i, j) = compliance(double(material.kappa_cells[cell++]));
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].compliance_value = compliance(material.kappa);
    if (l > 0 && finest.compliance)
      geometric_means<T>(levels_[l - 1].compliance.view(), levels_[l].compliance.view());
  }
}

template <class T>
void Hierarchy<T>::relieve(const grid::Material& material, grid::MemoryMeter& meter) {
  const std::vector<float>& cells = material.kappa_cells;
  const double most = cells.empty() ? material.kappa : double(*std::ranges::max_element(cells));
  if (most <= kRelief && traits_.model == kernels::Model::arap) return;
  for (Level<T>& level : levels_) {
    level.solid.law.relief = T(kRelief);
    for (auto& shift : level.solid.shift) shift = grid::Field<T>(level.nx, level.ny, meter);
  }
}

template <class T>
void Hierarchy<T>::set_diagonal(Level<T>& level, grid::MemoryMeter& meter) {
  level.inverse_diagonal = grid::Field<T>(level.nx + 1, level.ny + 1, meter);
  const kernels::Plane<T> out = level.inverse_diagonal.view(), mu = level.mu.view();
  for (int j = 1; j < level.ny; ++j)
    for (int i = 1; i < level.nx; ++i)
      out.at(i, j) =
          T(1) / ((mu.at(i - 1, j - 1) + mu.at(i, j - 1)) + (mu.at(i - 1, j) + mu.at(i, j)));
}

template <class T>
void Hierarchy<T>::restrict_state(int top) {
  for (int l = top; l + 1 < size(); ++l) {
    Level<T>&fine = (*this)[l], &coarse = (*this)[l + 1];
    if (fine.conforming && fine.pressure) set_part_means<T>(*fine.conforming, fine.pressure.view());
    kernels::inject_nodes<T>(fine.ux.view(), coarse.ux.view());
    kernels::inject_nodes<T>(fine.uy.view(), coarse.uy.view());
    if (fine.pressure) kernels::mean_cells<T>(fine.pressure.view(), coarse.pressure.view());
    if (fine.conforming) {
      const kernels::Plane<const T> x = fine.ux.view(), y = fine.uy.view();
      transfer_soft<T>(*fine.conforming, x, y, 2.0, *coarse.conforming);
      set_held<T>(*coarse.conforming, coarse.ux.view(), coarse.uy.view());
      if (fine.pressure)
        restrict_parts<T>(*fine.conforming, fine.pressure.view(), fine.spacing * fine.spacing,
                          *coarse.conforming);
    }
    coarse.clamp_centre = fine.clamp_centre;
    coarse.clamp_width = fine.clamp_width;
  }
}

template <class T>
void Hierarchy<T>::prolong_state(int l) {
  Level<T>& fine = (*this)[l];
  Level<T>& coarse = (*this)[l + 1];
  kernels::prolong_nodes<T>(coarse.ux.view(), fine.ux.view());
  kernels::prolong_nodes<T>(coarse.uy.view(), fine.uy.view());
  if (fine.pressure) kernels::interpolate_cells<T>(coarse.pressure.view(), fine.pressure.view());
  if (fine.conforming) {
    const kernels::Plane<const T> cx = coarse.ux.view(), cy = coarse.uy.view();
    prolong_special_nodes<T>(*coarse.conforming, cx, cy, *fine.conforming, fine.ux.view(),
                             fine.uy.view());
    transfer_soft<T>(*coarse.conforming, cx, cy, 0.5, *fine.conforming);
    set_held<T>(*fine.conforming, fine.ux.view(), fine.uy.view());
    if (fine.pressure)
      prolong_parts<T>(*coarse.conforming, coarse.pressure.view(), *fine.conforming,
                       fine.pressure.view());
    if (fine.pressure) set_part_means<T>(*fine.conforming, fine.pressure.view());
  }
  fine.solid.law = coarse.solid.law;
  const bool listed = coarse.conforming && !coarse.conforming->shift.empty();
  if (listed) set_shift_means<T>(*coarse.conforming, coarse.solid.shift);
  for (std::size_t n = 0; n < 4; ++n)
    if (fine.solid.shift[n])
      kernels::interpolate_cells<T>(coarse.solid.shift[n].view(), fine.solid.shift[n].view());
  if (listed) set_shifts<T>(fine.solid.shift, *fine.conforming);
  for (std::size_t k = 0; k < fine.to_coarse.parent.size(); ++k) {
    const int parent = fine.to_coarse.parent[k];
    for (std::size_t c = 0; c < 2; ++c)
      fine.q[2 * k + c] =
          parent < 0 ? T(0) : fine.to_coarse.share[k] * coarse.q[2 * std::size_t(parent) + c];
  }
}

template <class T>
void Hierarchy<T>::set_wanted(int l, std::vector<grid::Point> wanted) {
  for (int m = 0; m < l; ++m) {
    const CutTransfer<T>& transfer = (*this)[m].to_coarse;
    std::vector<grid::Point> coarse((*this)[m + 1].wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (transfer.parent[k] >= 0) {
        grid::Point& parent = coarse[std::size_t(transfer.parent[k])];
        parent = parent + double(transfer.share[k]) * wanted[k];
      }
    wanted = std::move(coarse);
  }
  (*this)[l].wanted = std::move(wanted);
}

template <class T>
void Hierarchy<T>::conform(const std::vector<grid::CurvePair>& curves, const grid::Lattice& lattice,
                           grid::MemoryMeter& meter) {
  conform(grid::conform_levels(curves, lattice, size()), meter);
}

template <class T>
std::unique_ptr<grid::CurveConformer> Hierarchy<T>::make_conformer(
    const grid::Lattice& lattice) const {
  return std::make_unique<grid::CurveConformer>(lattice, size());
}

template <class T>
void Hierarchy<T>::conform(std::vector<grid::ConformingCells> cells, grid::MemoryMeter& meter) {
  for (int l = 0; l < size(); ++l) {
    (*this)[l].conform(std::move(cells[std::size_t(l)]), meter);
    if (l == 0) continue;
    ConformingLevel<T>& fine = *(*this)[l - 1].conforming;
    join_levels<T>((*this)[l].conforming->geometry, fine);
    meter.add(fine.transfer_bytes());
  }
}

template <class T>
void Hierarchy<T>::clear() {
  for (Level<T>& level : levels_) level.clear(law_);
}

template <class T>
void Hierarchy<T>::retarget(const grid::CutCells& cuts) {
  levels_.front().wanted = cuts.wanted;
  // To the last bit as grid::coarsen has them, whose children come in this order.
  std::vector<double> length = cuts.length;
  for (int l = 0; l + 1 < size(); ++l) {
    const std::vector<int>& parent = (*this)[l].to_coarse.parent;
    const std::vector<grid::Point>& fine = (*this)[l].wanted;
    std::vector<grid::Point>& wanted = (*this)[l + 1].wanted;
    std::vector<double> sum(wanted.size(), 0.0);
    std::ranges::fill(wanted, grid::Point{});
    for (std::size_t k = 0; k < fine.size(); ++k) {
      if (parent[k] < 0) continue;
      const std::size_t p = std::size_t(parent[k]);
      sum[p] += length[k];
      wanted[p] = wanted[p] + length[k] * fine[k];
    }
    for (std::size_t p = 0; p < wanted.size(); ++p) wanted[p] = (1.0 / sum[p]) * wanted[p];
    length = std::move(sum);
  }
}

template <class T>
void Hierarchy<T>::retarget(grid::CurveConformer& conformer, int top) {
  for (int l = top; l < size(); ++l) {
    Level<T>& level = (*this)[l];
    conformer.retarget(l, level.conforming->geometry);
    level.conforming->retarget(level.spacing);
    set_held<T>(*level.conforming, level.ux.view(), level.uy.view());
  }
}

template class Hierarchy<float>;
template class Hierarchy<double>;

}  // namespace drumhead::multigrid
