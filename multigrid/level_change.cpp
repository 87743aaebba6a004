// SPDX-License-Identifier: MIT
#include "level_change.h"

#include <algorithm>

namespace drumhead::multigrid {
namespace {

template <class T>
void copy(const grid::Field<T>& from, grid::Field<T>& to) {
  for (int j = 0; j < from.view().rows; ++j)
    for (int i = 0; i < from.view().columns; ++i) to.view().at(i, j) = from.view().at(i, j);
}

/// f(column, row) for the lattice nodes that curves hold.
template <class F>
void for_held(const grid::ConformingCells& cells, F&& f) {
  for (int j = 0; j <= cells.ny; ++j)
    for (int n = cells.node_begin[std::size_t(j)]; n < cells.node_begin[std::size_t(j) + 1]; ++n)
      f(cells.node_column[std::size_t(n)], j);
}

}  // namespace

template <class T>
LevelCopy<T>::LevelCopy(const Level<T>& level, grid::MemoryMeter& meter)
    : ux_(level.nx + 1, level.ny + 1, meter), uy_(level.nx + 1, level.ny + 1, meter) {
  copy(level.ux, ux_);
  copy(level.uy, uy_);
}

template <class T>
LevelChange LevelCopy<T>::change(const Level<T>& coarse, const Level<T>& fine) const {
  const int columns = coarse.nx + 1;
  std::vector<char> held(std::size_t(columns) * std::size_t(coarse.ny + 1), 0);
  auto hold = [&](int i, int j) {
    held[std::size_t(j) * std::size_t(columns) + std::size_t(i)] = 1;
  };
  for_held(coarse.conforming->geometry, hold);
  for_held(fine.conforming->geometry, [&](int i, int j) {
    if (i % 2 == 0 && j % 2 == 0) hold(i / 2, j / 2);
  });
  double squares = 0.0, most = 0.0;
  int nodes = 0;
  for (int j = 0; j <= fine.ny / 2; ++j)
    for (int i = 0; i <= fine.nx / 2; ++i, ++nodes) {
      if (held[std::size_t(j) * std::size_t(columns) + std::size_t(i)]) continue;
      const double x = double(fine.ux.view().at(2 * i, 2 * j)) - double(ux_.view().at(i, j)),
                   y = double(fine.uy.view().at(2 * i, 2 * j)) - double(uy_.view().at(i, j));
      squares += x * x + y * y;
      most = std::max(most, x * x + y * y);
    }
  return {std::sqrt(squares / double(nodes)), std::sqrt(most)};
}

template class LevelCopy<float>;
template class LevelCopy<double>;

}  // namespace drumhead::multigrid
