// SPDX-License-Identifier: MIT
#include "level.h"

#include <algorithm>

namespace drumhead::multigrid {
namespace {

// Half width of the band beside the curves. Averaged rows: what the first cycles leave at S1, kappa
// 100, 400²: .33, .52 with 1, .28, .56 with 2, .22, .58 with 3 (and two such sweeps a cycle).
constexpr int kBand = 2;
// Strength of the jump of pressures between parts. RMS error in px of S4, means of three offsets,
// without it and with .125, .25, .5: kappa 10, 100² .163 .135 .130 .131; kappa 100, 100² .82 .54
// .54 .57, 200² .229 .179 .176 .176; kappa 1e4, 100² 1.50 .67 .67 .72, 200² .43 .22 .22 .22. Cycles
// of the finest level, means of six, without, with .25, .5, .7: S1 kappa 1e4, 128² 95 93 41 44; S2
// 1e4, 128² 12 10 10 10; S4 100, 400² 10 12 13 19. With 1 S4, kappa 100, 50² is wrong by 2.0 px
// instead of 1.4 (2.3 without).
constexpr double kPartJump = 0.5;

}  // namespace

template <class T>
CutRows<T>::CutRows(const grid::CutCells& cuts)
    : row_begin_(cuts.row_begin),
      column_(cuts.column),
      link_begin_(cuts.link_begin),
      link_(cuts.link),
      compliance_(cuts.compliance.begin(), cuts.compliance.end()),
      length_(cuts.length.begin(), cuts.length.end()) {
  for (const auto& weight : cuts.weight)
    for (const double w : weight) weight_.push_back(T(w));
  divide_jump({});
}

template <class T>
void CutRows<T>::divide_jump(const kernels::Plane<const T>& mu) {
  std::vector<T> local(length_.size(), T(1));
  if (mu)
    for (std::size_t j = 0; j + 1 < row_begin_.size(); ++j)
      for (int k = row_begin_[j]; k < row_begin_[j + 1]; ++k)
        local[std::size_t(k)] = mu.at(column_[std::size_t(k)], int(j));
  strength_.clear();
  link_diagonal_.clear();
  for (std::size_t k = 0; k < length_.size(); ++k) {
    T diagonal = T(0);
    for (int l = link_begin_[k]; l < link_begin_[k + 1]; ++l) {
      const std::size_t next = std::size_t(link_[std::size_t(l)]);
      const T own = length_[k], other = length_[next], shorter = std::min(own, other);
      const T softness = T(2) / (local[k] + local[next]);
      strength_.push_back(softness * (shorter * shorter / (own * other)));
      diagonal += softness * (shorter * shorter / (own * own));
    }
    link_diagonal_.push_back(diagonal);
  }
}

template <class T>
kernels::Cuts<T> CutRows<T>::view(T jump) const {
  return {.count = size(),
          .row_begin = row_begin_.data(),
          .column = column_.data(),
          .weight = weight_.data(),
          .compliance = compliance_.data(),
          .length = length_.data(),
          .link_diagonal = link_diagonal_.data(),
          .link_begin = link_begin_.data(),
          .link = link_.data(),
          .link_strength = strength_.data(),
          .jump = jump};
}

template <class T>
std::size_t CutRows<T>::bytes() const {
  return (row_begin_.size() + column_.size() + link_begin_.size() + link_.size()) * sizeof(int) +
         (weight_.size() + compliance_.size() + length_.size() + link_diagonal_.size() +
          strength_.size()) *
             sizeof(T);
}

template <class T>
Level<T>::Level(int nx_, int ny_, T spacing_, const SceneTraits& traits, grid::MemoryMeter& meter)
    : nx(nx_),
      ny(ny_),
      spacing(spacing_),
      ux(nx + 1, ny + 1, meter),
      uy(nx + 1, ny + 1, meter),
      d(nx, ny, traits.pressure, meter),
      f(nx, ny, traits.pressure, meter) {
  if (traits.pressure) pressure = grid::Field<T>(nx, ny, meter);
  if (kernels::isotropic(traits.model)) solid = Solid<T>(nx, ny, meter);
  solid.law.model = traits.model;
}

template <class T>
std::size_t Level<T>::bytes(int nx, int ny, const SceneTraits& traits) {
  const std::size_t of_nodes = kernels::isotropic(traits.model) ? 11 : 6;
  const std::size_t of_cells = traits.pressure ? 3 : 0;
  return of_nodes * grid::Field<T>::bytes(nx + 1, ny + 1) +
         of_cells * grid::Field<T>::bytes(nx, ny);
}

template <class T>
kernels::Membrane<T> Level<T>::membrane() const {
  kernels::Membrane<T> m = harmonic();
  m.pressure = pressure.view();
  m.compliance = {compliance_value, compliance.view()};
  m.clamp_centre = clamp_centre;
  m.clamp_width = clamp_width;
  m.pressure_jump = pressure_jump;
  m.part_jump = T(kPartJump);
  if (kernels::isotropic(solid.law.model)) solid.view(m);
  if (conforming && !conforming->shift.empty()) m.law.listed_shift = conforming->shift.data();
  return m;
}

template <class T>
kernels::Membrane<T> Level<T>::harmonic() const {
  kernels::Membrane<T> m;
  m.ux = ux.view();
  m.uy = uy.view();
  m.spacing = spacing;
  m.mu = {T(1), mu.view()};
  m.inverse_diagonal = inverse_diagonal.view();
  if (conforming) {
    m.special = &conforming->rows;
    m.listed = conforming->pressure.data();
  }
  return m;
}

template <class T>
void Level<T>::set_band(const std::vector<int>& row_begin, const std::vector<int>& column,
                        grid::MemoryMeter& meter) {
  if (kernels::isotropic(solid.law.model)) return;
  band = kernels::Band(row_begin, column, nx, kBand, bool(conforming));
  meter.add(band.bytes());
}

template <class T>
void Level<T>::conform(grid::ConformingCells cells, grid::MemoryMeter& meter) {
  conforming = std::make_unique<ConformingLevel<T>>(std::move(cells), spacing);
  conforming->rows = kernels::SpecialRows<T>(conforming->cells, membrane());
  d.listed.assign(pressure ? conforming->pressure.size() : 0, T(0));
  d.curve.assign(conforming->curve_unknowns(), T(0));
  f.listed = d.listed;
  f.curve = solid.product.curve = d.curve;
  if (solid.law.relief > T(0)) conforming->shift.assign(conforming->cells.triangle.size(), T(0));
  set_held<T>(*conforming, ux.view(), uy.view());
  meter.add(conforming->bytes());
  set_band(conforming->cells.row_begin, conforming->cells.column, meter);
}

template <class T>
void Level<T>::clear(const kernels::Law<T>& law) {
  for (grid::Field<T>* field : {&ux, &uy, &pressure}) field->clear();
  for (std::vector<T>* values : {&q, &dq, &fq}) std::ranges::fill(*values, T(0));
  d.clear();
  f.clear();
  clamp_centre = pressure_jump = T(0);
  clamp_width = T(1);
  solid.law = law;
  solid.averaged = false;
  solid.largest = T(2);
  for (grid::Field<T>& shift : solid.shift) shift.clear();
  if (conforming) conforming->clear(ux.view(), uy.view());
}

template class CutRows<float>;
template class CutRows<double>;
template struct Level<float>;
template struct Level<double>;

}  // namespace drumhead::multigrid
