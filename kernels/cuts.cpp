// SPDX-License-Identifier: MIT
#include <drumhead/kernels/cuts.h>

namespace drumhead::kernels {
namespace {

/// Calls body(k, i, j) for every cut k, in cell (i, j).
template <class T, class F>
void for_cuts(const Cuts<T>& cuts, int rows, F&& body) {
  for (int j = 0; j < rows; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k) body(k, cuts.column[k], j);
}

template <class T>
T average(const Cuts<T>& cuts, const Plane<const T>& d, int k, int i, int j) {
  const T* w = cuts.weight + 4 * k;
  return (w[0] * d.at(i, j) + w[1] * d.at(i + 1, j)) +
         (w[2] * d.at(i, j + 1) + w[3] * d.at(i + 1, j + 1));
}

template <class T>
void scatter(const T* w, T value, const Plane<T>& f, int i, int j) {
  f.at(i, j) += w[0] * value;
  f.at(i + 1, j) += w[1] * value;
  f.at(i, j + 1) += w[2] * value;
  f.at(i + 1, j + 1) += w[3] * value;
}

}  // namespace

template <class T>
T cut_compliance_diagonal(const Cuts<T>& cuts, int k) {
  T sum = T(0);
  for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l) sum += cuts.link_strength[l];
  return cuts.compliance[k] + cuts.jump * sum / (cuts.length[k] * cuts.length[k]);
}

template <class T>
Pair<T> cut_compliance(const Cuts<T>& cuts, const T* q, int k) {
  T x = T(0), y = T(0);
  const T own = T(1) / cuts.length[k];
  for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l) {
    const int other = cuts.link[l];
    const T theirs = T(1) / cuts.length[other];
    x += cuts.link_strength[l] * (q[2 * k] * own - q[2 * other] * theirs);
    y += cuts.link_strength[l] * (q[2 * k + 1] * own - q[2 * other + 1] * theirs);
  }
  return {cuts.compliance[k] * q[2 * k] + cuts.jump * own * x,
          cuts.compliance[k] * q[2 * k + 1] + cuts.jump * own * y};
}

template <class T>
void add_curve_force(const Cuts<T>& cuts, const T* q, T scale, const Unknowns<T>& f) {
  for_cuts(cuts, f.x.rows - 1, [&](int k, int i, int j) {
    scatter(cuts.weight + 4 * k, scale * q[2 * k], f.x, i, j);
    scatter(cuts.weight + 4 * k, scale * q[2 * k + 1], f.y, i, j);
  });
}

template <class T>
void apply_cuts(const Cuts<T>& cuts, const Unknowns<const T>& d, const T* q, T* out) {
  for_cuts(cuts, d.x.rows - 1, [&](int k, int i, int j) {
    const Pair<T> m = cut_compliance(cuts, q, k);
    out[2 * k] = -(average(cuts, d.x, k, i, j) + m.x);
    out[2 * k + 1] = -(average(cuts, d.y, k, i, j) + m.y);
  });
}

template <class T>
void cuts_residual(const Cuts<T>& cuts, const T* f, const Unknowns<const T>& d, const T* q, T* r) {
  for_cuts(cuts, d.x.rows - 1, [&](int k, int i, int j) {
    const Pair<T> m = cut_compliance(cuts, q, k);
    r[2 * k] = f[2 * k] + (average(cuts, d.x, k, i, j) + m.x);
    r[2 * k + 1] = f[2 * k + 1] + (average(cuts, d.y, k, i, j) + m.y);
  });
}

template <class T>
void relax_cuts_row(const Membrane<T>& membrane, const Cuts<T>& cuts, const T* g, T* dq,
                    const Unknowns<T>& d, const Unknowns<T>& f, bool reverse, int j) {
  const int begin = cuts.row_begin[j], end = cuts.row_begin[j + 1];
  for (int n = 0; n < end - begin; ++n) {
    const int k = reverse ? end - 1 - n : begin + n, i = cuts.column[k];
    const T* w = cuts.weight + 4 * k;
    T inverse[4];
    if (membrane.inverse_diagonal) {
      const Plane<const T>& plane = membrane.inverse_diagonal;
      inverse[0] = plane.at(i, j);
      inverse[1] = plane.at(i + 1, j);
      inverse[2] = plane.at(i, j + 1);
      inverse[3] = plane.at(i + 1, j + 1);
    } else {
      // Weights on the fixed boundary are 0, so its diagonal does not matter.
      for (T& value : inverse) value = T(1) / (T(4) * membrane.mu.value);
    }
    const T s = (w[0] * w[0] * inverse[0] + w[1] * w[1] * inverse[1]) +
                (w[2] * w[2] * inverse[2] + w[3] * w[3] * inverse[3]) +
                cut_compliance_diagonal(cuts, k);
    const T move[4] = {w[0] * inverse[0], w[1] * inverse[1], w[2] * inverse[2], w[3] * inverse[3]};
    const Pair<T> m = cut_compliance(cuts, dq, k);
    const T tx = -(g[2 * k] + (average<T>(cuts, d.x, k, i, j) + m.x)) / s;
    const T ty = -(g[2 * k + 1] + (average<T>(cuts, d.y, k, i, j) + m.y)) / s;
    scatter(move, tx, d.x, i, j);
    scatter(move, ty, d.y, i, j);
    dq[2 * k] += tx;
    dq[2 * k + 1] += ty;
    scatter(w, tx, f.x, i, j);
    scatter(w, ty, f.y, i, j);
  }
}

#define DRUMHEAD_INSTANTIATE(T)                                                                  \
  template T cut_compliance_diagonal(const Cuts<T>&, int);                                       \
  template Pair<T> cut_compliance(const Cuts<T>&, const T*, int);                                \
  template void add_curve_force(const Cuts<T>&, const T*, T, const Unknowns<T>&);                \
  template void apply_cuts(const Cuts<T>&, const Unknowns<const T>&, const T*, T*);              \
  template void cuts_residual(const Cuts<T>&, const T*, const Unknowns<const T>&, const T*, T*); \
  template void relax_cuts_row(const Membrane<T>&, const Cuts<T>&, const T*, T*,                 \
                               const Unknowns<T>&, const Unknowns<T>&, bool, int);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
