// SPDX-License-Identifier: MIT
#include <drumhead/kernels/parts.h>

#include "special_sweeps.h"

namespace drumhead::kernels {

template <class T>
void parts_residual(const LevelSystem<T>& level, double* residual) {
  const SpecialRows<T>& rows = *level.membrane.special;
  const Unknowns<const T> d = level.d;
  with_kind(rows, [&](auto soft, auto jumps) {
    for_special(rows.cells(), [&](int n, int i, int j) {
      const PartRowView<T, soft.value, jumps.value> view(rows, d, j);
      const Four<T> x = CornerValues<const T>(d.x, i, j).load(),
                    y = CornerValues<const T>(d.y, i, j).load();
      for_parts(rows.cells(), n,
                [&](int p) { residual[p] = double(level.f.listed[p] - view.apply(x, y, p, i)); });
    });
  });
}

template <class T>
void move_along_parts(const LevelSystem<T>& level, const double* t) {
  const SpecialRows<T>& rows = *level.membrane.special;
  const Unknowns<T>& d = level.d;
  for (int j = 0; j < d.p.rows; ++j)
    for (const int parity : {0, 1})
      for (const CellVisit<T>& visit : rows.visits(j, parity)) {
        const CornerValues<T> at_x(d.x, visit.column, j), at_y(d.y, visit.column, j);
        Four<T> x = at_x.load(), y = at_y.load();
        const Four<T> inverse(visit.inverse);
        for (int p = visit.part_begin; p < visit.part_end; ++p) {
          const T step = T(t[p]);
          d.listed[p] -= step;
          const Four<T> move = inverse * Four<T>(step);
          x = x + Four<T>(rows.part(p).bx) * move;
          y = y + Four<T>(rows.part(p).by) * move;
          if (rows.soft()) move_curve_of_part(*rows.soft(), p, step, d.curve);
        }
        at_x.store(x);
        at_y.store(y);
      }
}

template void parts_residual(const LevelSystem<float>&, double*);
template void parts_residual(const LevelSystem<double>&, double*);
template void move_along_parts(const LevelSystem<float>&, const double*);
template void move_along_parts(const LevelSystem<double>&, const double*);

}  // namespace drumhead::kernels
