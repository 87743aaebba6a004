// SPDX-License-Identifier: MIT
#include <drumhead/kernels/cuts.h>

#include <initializer_list>
#include <type_traits>

namespace drumhead::kernels {
namespace {

/// Calls body(k, i, j) for every cut k, in cell (i, j).
template <class T, class F>
void for_cuts(const Cuts<T>& cuts, int rows, F&& body) {
  for (int j = 0; j < rows; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k) body(k, cuts.column[k], j);
}

constexpr int kAhead = 4;

/// A field's values at the corners 00, 10, 01, 11 of cell (i, j).
template <class T>
struct CellCorners {
  T* corner[4];
  CellCorners(const Plane<T>& f, int i, int j) {
    T* const west = f.half(j, i & 1) + (i >> 1);
    T* const east = f.half(j, (i + 1) & 1) + ((i + 1) >> 1);
    corner[0] = west;
    corner[1] = east;
    corner[2] = west + f.stride;
    corner[3] = east + f.stride;
  }
  auto average(const std::remove_const_t<T>* w) const {
    return (w[0] * *corner[0] + w[1] * *corner[1]) + (w[2] * *corner[2] + w[3] * *corner[3]);
  }
  void add(const T* w, T value) const {
    for (int c = 0; c < 4; ++c) *corner[c] += w[c] * value;
  }
};

template <class T>
T diagonal(const Cuts<T>& cuts, int k) {
  return cuts.compliance[k] + cuts.jump * cuts.link_diagonal[k];
}

template <class T>
[[gnu::always_inline]] inline Pair<T> compliance(const Cuts<T>& cuts, const T* q, int k) {
  T x = T(0), y = T(0);
  for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l) {
    const int other = cuts.link[l];
    x += cuts.link_strength[l] * q[2 * other];
    y += cuts.link_strength[l] * q[2 * other + 1];
  }
  const T own = diagonal(cuts, k);
  return {own * q[2 * k] - cuts.jump * x, own * q[2 * k + 1] - cuts.jump * y};
}

}  // namespace

template <class T>
T cut_compliance_diagonal(const Cuts<T>& cuts, int k) {
  return diagonal(cuts, k);
}

template <class T>
Pair<T> cut_compliance(const Cuts<T>& cuts, const T* q, int k) {
  return compliance(cuts, q, k);
}

template <class T>
void add_curve_force(const Cuts<T>& cuts, const T* q, T scale, const Unknowns<T>& f) {
  for_cuts(cuts, f.x.rows - 1, [&](int k, int i, int j) {
    CellCorners<T>(f.x, i, j).add(cuts.weight + 4 * k, scale * q[2 * k]);
    CellCorners<T>(f.y, i, j).add(cuts.weight + 4 * k, scale * q[2 * k + 1]);
  });
}

template <class T>
void apply_cuts(const Cuts<T>& cuts, const Unknowns<const T>& d, const T* q, T* out) {
  for_cuts(cuts, d.x.rows - 1, [&](int k, int i, int j) {
    const Pair<T> m = compliance(cuts, q, k);
    out[2 * k] = -(CellCorners<const T>(d.x, i, j).average(cuts.weight + 4 * k) + m.x);
    out[2 * k + 1] = -(CellCorners<const T>(d.y, i, j).average(cuts.weight + 4 * k) + m.y);
  });
}

template <class T>
void cuts_residual(const Cuts<T>& cuts, const T* f, const Unknowns<const T>& d, const T* q, T* r) {
  for_cuts(cuts, d.x.rows - 1, [&](int k, int i, int j) {
    const Pair<T> m = compliance(cuts, q, k);
    r[2 * k] = f[2 * k] + (CellCorners<const T>(d.x, i, j).average(cuts.weight + 4 * k) + m.x);
    r[2 * k + 1] =
        f[2 * k + 1] + (CellCorners<const T>(d.y, i, j).average(cuts.weight + 4 * k) + m.y);
  });
}

/// Asks for what cut k is going to read and write.
template <class T>
void prefetch(const Cuts<T>& cuts, const Unknowns<T>& d, const Unknowns<T>& f, int k, int j) {
  for (const Plane<T>* plane : {&d.x, &d.y, &f.x, &f.y})
    for (T* const at : CellCorners<T>(*plane, cuts.column[k], j).corner) __builtin_prefetch(at, 1);
}

/// The step of cut k in the inner product of 2×2 blocks, which couples the two rows of a pair.
/// Scalar weights were tried and lost: the nodes' relaxation and the curve rows then undo one
/// another where the blocks are far from isotropic (neohookean, S2 by 45°, kappa 1, 64²: 300 cycles
/// instead of 4).
template <class T>
void relax_cut_in_blocks(const Membrane<T>& membrane, const Cuts<T>& cuts, const T* g, T* dq,
                         const Unknowns<T>& d, const Unknowns<T>& f, int k, int j) {
  const T* w = cuts.weight + 4 * k;
  const int i = cuts.column[k];
  const CellCorners<const T> block[3] = {{membrane.inverse_block[0], i, j},
                                         {membrane.inverse_block[1], i, j},
                                         {membrane.inverse_block[2], i, j}};
  const CellCorners<T> x(d.x, i, j), y(d.y, i, j);
  T s[3] = {diagonal(cuts, k), T(0), T(0)}, move[3][4];
  s[2] = s[0];
  for (int e = 0; e < 3; ++e)
    for (int n = 0; n < 4; ++n) {
      move[e][n] = w[n] * *block[e].corner[n];
      s[e] += w[n] * move[e][n];
    }
  const Pair<T> m = compliance(cuts, dq, k);
  const T rx = g[2 * k] + (x.average(w) + m.x), ry = g[2 * k + 1] + (y.average(w) + m.y);
  const T step = T(-1) / (s[0] * s[2] - s[1] * s[1]);
  const T tx = step * (s[2] * rx - s[1] * ry), ty = step * (s[0] * ry - s[1] * rx);
  x.add(move[0], tx);
  x.add(move[1], ty);
  y.add(move[1], tx);
  y.add(move[2], ty);
  dq[2 * k] += tx;
  dq[2 * k + 1] += ty;
  CellCorners<T>(f.x, i, j).add(w, tx);
  CellCorners<T>(f.y, i, j).add(w, ty);
}

template <class T>
void relax_cuts_row(const Membrane<T>& membrane, const Cuts<T>& cuts, const T* g, T* dq,
                    const Unknowns<T>& d, const Unknowns<T>& f, bool reverse, int j) {
  const int begin = cuts.row_begin[j], end = cuts.row_begin[j + 1];
  // Weights on the fixed boundary are 0, so its diagonal does not matter.
  const T everywhere = T(1) / (T(4) * membrane.mu.value);
  T inverse[4] = {everywhere, everywhere, everywhere, everywhere};
  // Curves wander over rows that are no longer in the nearest cache.
  for (int n = 0; n < end - begin && n < kAhead; ++n)
    prefetch(cuts, d, f, reverse ? end - 1 - n : begin + n, j);
  for (int n = 0; n < end - begin; ++n) {
    const int k = reverse ? end - 1 - n : begin + n, i = cuts.column[k];
    if (n + kAhead < end - begin) prefetch(cuts, d, f, reverse ? k - kAhead : k + kAhead, j);
    if (membrane.inverse_block[0]) {
      relax_cut_in_blocks(membrane, cuts, g, dq, d, f, k, j);
      continue;
    }
    const T* w = cuts.weight + 4 * k;
    if (membrane.inverse_diagonal) {
      const CellCorners<const T> at(membrane.inverse_diagonal, i, j);
      for (int c = 0; c < 4; ++c) inverse[c] = *at.corner[c];
    }
    const T move[4] = {w[0] * inverse[0], w[1] * inverse[1], w[2] * inverse[2], w[3] * inverse[3]};
    const T s =
        (w[0] * move[0] + w[1] * move[1]) + (w[2] * move[2] + w[3] * move[3]) + diagonal(cuts, k);
    const T step = T(-1) / s;
    const CellCorners<T> x(d.x, i, j), y(d.y, i, j);
    const Pair<T> m = compliance(cuts, dq, k);
    const T tx = step * (g[2 * k] + (x.average(w) + m.x));
    const T ty = step * (g[2 * k + 1] + (y.average(w) + m.y));
    x.add(move, tx);
    y.add(move, ty);
    dq[2 * k] += tx;
    dq[2 * k + 1] += ty;
    CellCorners<T>(f.x, i, j).add(w, tx);
    CellCorners<T>(f.y, i, j).add(w, ty);
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
