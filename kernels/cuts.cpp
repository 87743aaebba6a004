// SPDX-License-Identifier: MIT
#include <drumhead/kernels/cuts.h>

#include <cstddef>

namespace drumhead::kernels {
namespace {

/// Calls body(k, i, j) for every cut k, in cell (i, j).
template <class T, class F>
void for_cuts(const Cuts<T>& cuts, int rows, F&& body) {
  for (int j = 0; j < rows; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k) body(k, cuts.column[k], j);
}

/// Where the corners 00, 10, 01, 11 of cell (i, j) lie in every field of nodes of a lattice: those
/// that the functions of this file are given together have one shape.
struct CellCorners {
  std::ptrdiff_t at[4];
  template <class T>
  CellCorners(const Plane<T>& shape, int i, int j) {
    const std::ptrdiff_t row = j * shape.stride;
    at[0] = row + (i & 1) * shape.odd + (i >> 1);
    at[1] = row + ((i + 1) & 1) * shape.odd + ((i + 1) >> 1);
    at[2] = at[0] + shape.stride;
    at[3] = at[1] + shape.stride;
  }
};

/// Four numbers, one per corner.
template <class T>
struct Weights {
  T at[4];
  explicit Weights(const T* w) : at{w[0], w[1], w[2], w[3]} {}
  Weights(const Weights& w, const T* factor)
      : at{w.at[0] * factor[0], w.at[1] * factor[1], w.at[2] * factor[2], w.at[3] * factor[3]} {}

  /// Σ of the corners' values, weighted.
  T average(const T* field, const CellCorners& corner) const {
    return (at[0] * field[corner.at[0]] + at[1] * field[corner.at[1]]) +
           (at[2] * field[corner.at[2]] + at[3] * field[corner.at[3]]);
  }
  void add(T value, T* field, const CellCorners& corner) const {
    for (int c = 0; c < 4; ++c) field[corner.at[c]] += at[c] * value;
  }
  T dot(const Weights& other) const {
    return (at[0] * other.at[0] + at[1] * other.at[1]) +
           (at[2] * other.at[2] + at[3] * other.at[3]);
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
  T *const x = f.x.data, *const y = f.y.data;
  for_cuts(cuts, f.x.rows - 1, [&](int k, int i, int j) {
    const CellCorners corner(f.x, i, j);
    const Weights<T> weight(cuts.weight + 4 * k);
    const T qx = scale * q[2 * k], qy = scale * q[2 * k + 1];
    weight.add(qx, x, corner);
    weight.add(qy, y, corner);
  });
}

template <class T>
void apply_cuts(const Cuts<T>& cuts, const Unknowns<const T>& d, const T* q, T* out) {
  for_cuts(cuts, d.x.rows - 1, [&](int k, int i, int j) {
    const CellCorners corner(d.x, i, j);
    const Weights<T> weight(cuts.weight + 4 * k);
    const Pair<T> m = compliance(cuts, q, k);
    out[2 * k] = -(weight.average(d.x.data, corner) + m.x);
    out[2 * k + 1] = -(weight.average(d.y.data, corner) + m.y);
  });
}

template <class T>
void cuts_residual(const Cuts<T>& cuts, const T* f, const Unknowns<const T>& d, const T* q, T* r) {
  for_cuts(cuts, d.x.rows - 1, [&](int k, int i, int j) {
    const CellCorners corner(d.x, i, j);
    const Weights<T> weight(cuts.weight + 4 * k);
    const Pair<T> m = compliance(cuts, q, k);
    r[2 * k] = f[2 * k] + (weight.average(d.x.data, corner) + m.x);
    r[2 * k + 1] = f[2 * k + 1] + (weight.average(d.y.data, corner) + m.y);
  });
}

/// The fields of nodes that a relaxation of curve rows reads and writes.
template <class T>
struct NodeFields {
  T* __restrict dx;
  T* __restrict dy;
  T* __restrict fx;
  T* __restrict fy;
};

/// The step of cut k in the inner product of 2×2 blocks, which couples the two rows of a pair.
/// Scalar weights were tried and lost: the nodes' relaxation and the curve rows then undo one
/// another where the blocks are far from isotropic (neohookean, S2 by 45°, kappa 1, 64²: 300 cycles
/// instead of 4).
template <class T>
void relax_cut_in_blocks(const Membrane<T>& membrane, const Cuts<T>& cuts, const T* g, T* dq,
                         const NodeFields<T>& nodes, const CellCorners& corner, int k) {
  const Weights<T> w(cuts.weight + 4 * k);
  T s[3] = {diagonal(cuts, k), T(0), T(0)}, move[3][4];
  s[2] = s[0];
  for (int e = 0; e < 3; ++e)
    for (int n = 0; n < 4; ++n) {
      move[e][n] = w.at[n] * membrane.inverse_block[e].data[corner.at[n]];
      s[e] += w.at[n] * move[e][n];
    }
  const Pair<T> m = compliance(cuts, dq, k);
  const T rx = g[2 * k] + (w.average(nodes.dx, corner) + m.x);
  const T ry = g[2 * k + 1] + (w.average(nodes.dy, corner) + m.y);
  const T step = T(-1) / (s[0] * s[2] - s[1] * s[1]);
  const T tx = step * (s[2] * rx - s[1] * ry), ty = step * (s[0] * ry - s[1] * rx);
  const Weights<T> xx(move[0]), xy(move[1]), yy(move[2]);
  xx.add(tx, nodes.dx, corner);
  xy.add(ty, nodes.dx, corner);
  xy.add(tx, nodes.dy, corner);
  yy.add(ty, nodes.dy, corner);
  dq[2 * k] += tx;
  dq[2 * k + 1] += ty;
  w.add(tx, nodes.fx, corner);
  w.add(ty, nodes.fy, corner);
}

/// The same with K_ii: `inverse` are 1/K_ii at the corners.
template <class T>
[[gnu::always_inline]] inline void relax_cut(const Cuts<T>& cuts, const T* inverse, const T* g,
                                             T* __restrict dq, const NodeFields<T>& nodes,
                                             const CellCorners& corner, int k) {
  const Weights<T> w(cuts.weight + 4 * k), move(w, inverse);
  const T step = T(-1) / (w.dot(move) + diagonal(cuts, k));
  const Pair<T> m = compliance<T>(cuts, dq, k);
  const T tx = step * (g[2 * k] + (w.average(nodes.dx, corner) + m.x));
  const T ty = step * (g[2 * k + 1] + (w.average(nodes.dy, corner) + m.y));
  move.add(tx, nodes.dx, corner);
  move.add(ty, nodes.dy, corner);
  dq[2 * k] += tx;
  dq[2 * k + 1] += ty;
  w.add(tx, nodes.fx, corner);
  w.add(ty, nodes.fy, corner);
}

template <class T>
void relax_cuts_row(const Membrane<T>& membrane, const Cuts<T>& all, const T* g, T* dq,
                    const Unknowns<T>& d, const Unknowns<T>& f, bool reverse, int j) {
  const Cuts<T> cuts = all;  // here no store can change it
  const int begin = cuts.row_begin[j], end = cuts.row_begin[j + 1];
  // Asking for what the next cuts of the row read and write gained nothing at 800², and cost 3 % of
  // S2 at 100².
  const NodeFields<T> nodes{d.x.data, d.y.data, f.x.data, f.y.data};
  const Plane<T> shape = d.x;
  const int first = reverse ? end - 1 : begin, by = reverse ? -1 : 1;
  // Weights on the fixed boundary are 0, so its diagonal does not matter.
  const T everywhere = T(1) / (T(4) * membrane.mu.value);
  T inverse[4] = {everywhere, everywhere, everywhere, everywhere};
  const bool blocks = bool(membrane.inverse_block[0]);
  const T* const diagonals = membrane.inverse_diagonal.data;
  for (int n = 0; n < end - begin; ++n) {
    const int k = first + by * n;
    const CellCorners corner(shape, cuts.column[k], j);
    if (blocks) {
      relax_cut_in_blocks(membrane, cuts, g, dq, nodes, corner, k);
      continue;
    }
    for (int c = 0; diagonals && c < 4; ++c) inverse[c] = diagonals[corner.at[c]];
    relax_cut(cuts, inverse, g, dq, nodes, corner, k);
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
