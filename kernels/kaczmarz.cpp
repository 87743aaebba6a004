// SPDX-License-Identifier: MIT
#include <drumhead/kernels/kaczmarz.h>

#include <algorithm>

#include "kernel_table.h"
#include "parallel.h"

namespace drumhead::kernels {

template <class T>
CurveNodes<T>::CurveNodes(int nx, int ny, const Cuts<T>& cuts) {
  struct Entry {
    int column, cut, corner;  // no cut: the first or last free column
  };
  constexpr int kNone = -1;
  std::vector<Entry> row;
  row_begin_.assign(2, 0);  // row 0 is fixed
  entry_begin_.push_back(0);
  const auto add_cuts = [&](int cell_row, int corner_row) {
    for (int k = cuts.row_begin[cell_row]; k < cuts.row_begin[cell_row + 1]; ++k)
      for (const int corner : {corner_row, corner_row + 1})
        if (cuts.weight[4 * k + corner] != T(0))
          row.push_back({cuts.column[k] + (corner & 1), k, corner});
  };
  for (int j = 1; j < ny; ++j) {
    row = {{1, kNone, 0}, {nx - 1, kNone, 0}};
    if (cuts.count > 0) {
      add_cuts(j - 1, 2);
      add_cuts(j, 0);
    }
    std::ranges::stable_sort(row, {}, &Entry::column);
    for (std::size_t n = 0; n < row.size(); ++n) {
      if (n == 0 || row[n].column != row[n - 1].column) {
        column_.push_back(row[n].column);
        entry_begin_.push_back(entry_begin_.back());
      }
      if (row[n].cut == kNone) continue;
      cut_.push_back(row[n].cut);
      corner_.push_back(row[n].corner);
      ++entry_begin_.back();
    }
    row_begin_.push_back(int(column_.size()));
  }
}

template <class T>
SingleNodes<T> CurveNodes<T>::view() const {
  return {row_begin_.data(), column_.data(), entry_begin_.data(), cut_.data(), corner_.data()};
}

template <class T>
std::size_t CurveNodes<T>::bytes() const {
  return (row_begin_.size() + column_.size() + entry_begin_.size() + cut_.size() + corner_.size()) *
         sizeof(int);
}

namespace {

/// Entry of M that a link makes.
template <class T>
T compliance_entry(const Cuts<T>& cuts, int link) {
  return T(0) - cuts.jump * cuts.link_strength[link];
}
template <class T>
T weight_norm2(const T* w) {
  return (w[0] * w[0] + w[1] * w[1]) + (w[2] * w[2] + w[3] * w[3]);
}

/// |row|² of a curve row, without the factor β of the row itself.
template <class T>
T curve_row_norm2(const KaczmarzSystem<T>& system, int k) {
  const Cuts<T>& cuts = system.level.cuts;
  const T diagonal = cut_compliance_diagonal(cuts, k);
  T sum = weight_norm2(cuts.weight + 4 * k) + system.beta2[k] * (diagonal * diagonal);
  for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l) {
    const T entry = compliance_entry(cuts, l);
    sum += system.beta2[cuts.link[l]] * (entry * entry);
  }
  return sum;
}

/// fx, fy += Wᵀ (x, y) of a cut in cell (i, j).
template <class T>
void scatter(const T* w, T x, T y, const Plane<T>& fx, const Plane<T>& fy, int i, int j) {
  for (int c = 0; c < 4; ++c) {
    fx.at(i + (c & 1), j + (c >> 1)) += w[c] * x;
    fy.at(i + (c & 1), j + (c >> 1)) += w[c] * y;
  }
}

/// dq_l += (x, y) of a cut in a cell row near j; f goes on carrying Wᵀ dq.
template <class T>
void change_force(const LevelSystem<T>& level, int l, T x, T y, int j) {
  const Cuts<T>& cuts = level.cuts;
  while (l < cuts.row_begin[j]) --j;
  while (l >= cuts.row_begin[j + 1]) ++j;
  level.dq[2 * l] += x;
  level.dq[2 * l + 1] += y;
  scatter(cuts.weight + 4 * l, x, y, level.f.x, level.f.y, cuts.column[l], j);
}

/// Kaczmarz on both rows of cut k in cell row j.
template <class T>
void relax_curve_row(const KaczmarzSystem<T>& system, int k, int j) {
  const LevelSystem<T>& level = system.level;
  const Cuts<T>& cuts = level.cuts;
  const T* w = cuts.weight + 4 * k;
  const int i = cuts.column[k];
  const Pair<T> m = cut_compliance<T>(cuts, level.dq, k);
  T x = level.fq[2 * k] + m.x, y = level.fq[2 * k + 1] + m.y;
  for (int c = 0; c < 4; ++c) {
    x += w[c] * level.d.x.at(i + (c & 1), j + (c >> 1));
    y += w[c] * level.d.y.at(i + (c & 1), j + (c >> 1));
  }
  const T factor = T(0) - system.omega / curve_row_norm2(system, k);
  x *= factor;
  y *= factor;
  scatter(w, x, y, level.d.x, level.d.y, i, j);
  const auto change = [&](int l, T entry) {
    const T gain = system.beta2[l] * entry;
    change_force(level, l, gain * x, gain * y, j);
  };
  change(k, cut_compliance_diagonal(cuts, k));
  for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l)
    change(cuts.link[l], compliance_entry(cuts, l));
}

}  // namespace

template <class T>
void balance_rows(const Membrane<T>& m, const Cuts<T>& cuts, const Plane<T>& alpha2, T* beta2) {
  const int rows = m.ux.rows - 1;
  if (alpha2)
    for_rows(0, rows, m.ux.columns, [&](int j) { table<T>().balance_cells(m, alpha2, j); });
  for (int j = 0; cuts.count > 0 && j < rows; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k) {
      const T mu = m.mu.cells ? m.mu.cells.at(cuts.column[k], j) : m.mu.value;
      beta2[k] = T(20) * (mu * mu) / weight_norm2(cuts.weight + 4 * k);
    }
}

template <class T>
void damped_kaczmarz(const KaczmarzSystem<T>& system, const Unknowns<T>& e, T* eq) {
  const KernelTable<T>& kernels = table<T>();
  const LevelSystem<T>& level = system.level;
  const Cuts<T>& cuts = level.cuts;
  const Unknowns<const T> correction = e, before = level.d;
  // e of the curve rows first: the others' e will change d.
  if (cuts.count > 0) {
    cuts_residual<T>(cuts, level.fq, level.d, level.dq, eq);
    for (int k = 0; k < cuts.count; ++k) {
      const T factor = T(0) - system.omega / curve_row_norm2(system, k);
      eq[2 * k] *= factor;
      eq[2 * k + 1] *= factor;
    }
  }
  const int rows = level.d.x.rows - 1;
  skewed_sweeps(rows, 2, level.d.x.columns, [&](int stage, int j, int) {
    if (stage == 0) {
      if (j > 0) kernels.jacobi_nodes(system, e, j);
      if (level.d.p) kernels.jacobi_cells(system, e, j);
      return;
    }
    // e holds −omega residual/|row|²: d − H e is the damped step.
    if (j > 0)
      kernels.residual_nodes(level.membrane, &before, correction, level.d.x.row(j),
                             level.d.y.row(j), j);
    if (level.d.p) kernels.jacobi_pressures(system, correction, j);
  });
  if (cuts.count == 0) return;
  add_curve_force<T>(cuts, eq, T(1), level.d);
  T* image = eq + 2 * cuts.count;
  apply_cuts<T>(cuts, correction, eq, image);
  for (int k = 0; k < cuts.count; ++k) {
    for (int c = 2 * k; c < 2 * k + 2; ++c) {
      image[c] *= T(0) - system.beta2[k];
      level.dq[c] += image[c];
    }
  }
  add_curve_force<T>(cuts, image, T(1), level.f);
}

template <class T>
void coloured_kaczmarz(const KaczmarzSystem<T>& system, Reach reach) {
  const KernelTable<T>& kernels = table<T>();
  const LevelSystem<T>& level = system.level;
  const Cuts<T>& cuts = level.cuts;
  const int rows = level.d.x.rows - 1;
  constexpr int kNodeStages = 3;
  const int stages = kNodeStages + (level.d.p ? 2 : 0);
  const auto sweep = [&](int stage, int j, int) {
    if (stage < kNodeStages) {
      if (j > 0 && j % kNodeStages == stage) kernels.kaczmarz_nodes(system, reach, j);
    } else if (j % 2 == stage - kNodeStages) {
      for (const int parity : {0, 1}) kernels.kaczmarz_cells(system, reach, parity, j);
    }
  };
  if (reach == Reach::everywhere) {
    skewed_sweeps(rows, stages, level.d.x.columns, sweep);
  } else {
    if (cuts.count == 0) return;
    for (int stage = 0; stage < stages; ++stage)
      for (int j = 0; j < rows; ++j) sweep(stage, j, 0);
  }
  for (int j = 0; cuts.count > 0 && j < rows; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k) relax_curve_row(system, k, j);
}

#define DRUMHEAD_INSTANTIATE(T)                                                        \
  template class CurveNodes<T>;                                                        \
  template void balance_rows(const Membrane<T>&, const Cuts<T>&, const Plane<T>&, T*); \
  template void damped_kaczmarz(const KaczmarzSystem<T>&, const Unknowns<T>&, T*);     \
  template void coloured_kaczmarz(const KaczmarzSystem<T>&, Reach);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
