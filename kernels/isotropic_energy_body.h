// SPDX-License-Identifier: MIT
#pragma once
// One row of cell energies of an isotropic membrane at x̂ + t d: what a line search needs.
#include <drumhead/kernels/elastic.h>

#include "isotropic_body.h"
#include "sums.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// J at the centre of a cell.
template <class T, class B>
B centre_area(const CellState<T, B>& cell) {
  const Split<B> f = cell.at(T(0.5), T(0.5));
  return B(T(0.25)) * ((f.a1 * f.a1 + f.a2 * f.a2) - (f.b1 * f.b1 + f.b2 * f.b2));
}

/// Adds cell row j's energies (with mu; with kappa), the count of its inverted cells and its least
/// J at the points to sums, at u + step d (d.x null: at u); cells of the columns `left_out` do not
/// count.
template <class Model, class T>
[[gnu::flatten]] void isotropic_energy_row(const Membrane<T>& m, const Unknowns<const T>& d, T step,
                                           const Columns& left_out, EnergySums& sums, int j) {
  constexpr int kChunk = 256;
  T shape[kChunk], volume[kChunk], inverted[kChunk], least[kChunk];
  Sixteen total[3];
  for (int parity = 0; parity < 2; ++parity) {
    const CellReader<T> reader(m, j, parity);
    Corners<const T> dx = reader.ux, dy = reader.uy;
    if (d.x) {
      dx = {d.x, j, parity};
      dy = {d.y, j, parity};
    }
    const int count = half_count(m.ux.columns - 1, parity);
    for (int begin = 0; begin < count; begin += kChunk) {
      const int end = begin + kChunk < count ? begin + kChunk : count;
      for_lanes<T>(begin, end, [&](auto lane, auto zero, int k) {
        using B = decltype(zero);
        const CellState<T, B> cell =
            d.x ? reader.read(lane, zero, dx, dy, B(step), k) : reader.read(lane, zero, k);
        const B one(T(1)), quarter(T(0.25) * m.spacing * m.spacing);
        B with_mu = zero, with_kappa = zero, smallest(T(1e30));
        for_points<T, Model>(cell, [&](auto density, T s, T t, const Parameters<B>& c) {
          const Polar<T, decltype(density), B> p(cell.at(s, t));
          const Moduli<B> psi = decltype(density)::template at<T>(c, p.ra, p.rb);
          with_mu = with_mu + psi.shape;
          with_kappa = with_kappa + psi.volume;
          smallest = smaller(smallest, B(T(0.5)) * (p.ra * p.ra - p.rb * p.rb));
        });
        lane.store(quarter * with_mu, shape + (k - begin));
        lane.store(quarter * with_kappa, volume + (k - begin));
        lane.store(if_less(centre_area<T>(cell), zero, one, zero), inverted + (k - begin));
        lane.store(smallest, least + (k - begin));
      });
      for (const int i : left_out) {
        const int k = i >> 1;
        if ((i & 1) != parity || k < begin || k >= end) continue;
        shape[k - begin] = volume[k - begin] = inverted[k - begin] = T(0);
        least[k - begin] = T(1e30);
      }
      total[0].add(shape, end - begin);
      total[1].add(volume, end - begin);
      total[2].add(inverted, end - begin);
      for (int k = 0; k < end - begin; ++k)
        if (double(least[k]) < sums.least_J || least[k] != least[k])
          sums.least_J = double(least[k]);  // keeps a NaN
    }
  }
  sums.elastic += total[0].total();
  sums.volume += total[1].total();
  sums.volume_merit += total[1].total();
  sums.inverted_cells += total[2].total();
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
