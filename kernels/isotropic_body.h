// SPDX-License-Identifier: MIT
#pragma once
// Rows of the kernels that all isotropic membranes share: a cell's energy is the sum of A/4 Ψ over
// four points of the cell, 2×2 Gauss points or its corners, or A Ψ at its centre. The columns of
// F at the point (s, t) are x̂'s differences along the cell's edges,
//   F e1 = (1−t) bottom + t top, F e2 = (1−s) left + s right.
// A cell row adds to two node rows: cells of even rows are done first, then those of odd rows.
#include "model_arap.h"
#include "model_corotated.h"
#include "model_fold_free.h"
#include "model_linear.h"
#include "model_neohookean.h"
#include "model_stvk.h"
#include "polar.h"
#include "stencil.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

/// One number per point: at s or t of the two lower and the two upper points.
struct GaussPoints {
  static constexpr double at[2] = {0.21132486540518711775, 0.78867513459481288225};
};
struct CornerPoints {
  static constexpr double at[2] = {0.0, 1.0};
};

/// Differences of a field along a cell's edges (x and y of bottom, top, left, right), and their
/// adjoint.
template <class B>
struct EdgeDifferences {
  B bx, by, tx, ty, lx, ly, rx, ry;
};
template <class L, class B, class T>
EdgeDifferences<B> edge_differences(L lane, B, const Corners<const T>& x, const Corners<const T>& y,
                                    int k) {
  const B x00 = lane.load(x.n00 + k), x10 = lane.load(x.n10 + k), x01 = lane.load(x.n01 + k),
          x11 = lane.load(x.n11 + k);
  const B y00 = lane.load(y.n00 + k), y10 = lane.load(y.n10 + k), y01 = lane.load(y.n01 + k),
          y11 = lane.load(y.n11 + k);
  return {x10 - x00, y10 - y00, x11 - x01, y11 - y01, x01 - x00, y01 - y00, x11 - x10, y11 - y10};
}

/// A cell's state: F at any of its points and the membrane's parameters there.
template <class T, class B>
struct CellState {
  EdgeDifferences<B> g;  ///< of x̂, in cells
  Parameters<B> c;
  B shift[4];

  /// F at (s, t), times √2 as (a, b).
  Split<B> at(T s, T t) const {
    const B s0(T(1) - s), s1(s), t0(T(1) - t), t1(t);
    return {t0 * g.bx + t1 * g.tx, t0 * g.by + t1 * g.ty, s0 * g.lx + s1 * g.rx,
            s0 * g.ly + s1 * g.ry};
  }
};

/// Reads the cells of columns 2k + parity in row j.
template <class T>
struct CellReader {
  T inverse_h, mu_value, kappa_value, eps, corner, relief, onset;
  Corners<const T> ux, uy;
  const T *mu, *kappa;
  const T* shift[4];

  CellReader(const Membrane<T>& m, int j, int parity)
      : inverse_h(T(1) / m.spacing),
        mu_value(m.mu.value),
        kappa_value(m.law.kappa.value),
        eps(m.law.eps),
        corner(m.law.corner),
        relief(m.law.relief),
        onset(m.law.onset > T(kLeastOnset) ? m.law.onset : T(kLeastOnset)),
        ux(m.ux, j, parity),
        uy(m.uy, j, parity),
        mu(m.mu.cells ? m.mu.cells.half(j, parity) : nullptr),
        kappa(m.law.kappa.cells ? m.law.kappa.cells.half(j, parity) : nullptr) {
    for (int n = 0; n < 4; ++n)
      shift[n] = m.law.shift[n] ? m.law.shift[n].half(j, parity) : nullptr;
  }

  template <class L, class B>
  CellState<T, B> read(L lane, B zero, int k) const {
    return with(lane, zero, edge_differences(lane, zero, ux, uy, k), k);
  }
  /// At u + step d.
  template <class L, class B>
  CellState<T, B> read(L lane, B zero, const Corners<const T>& dx, const Corners<const T>& dy,
                       B step, int k) const {
    EdgeDifferences<B> u = edge_differences(lane, zero, ux, uy, k);
    const EdgeDifferences<B> d = edge_differences(lane, zero, dx, dy, k);
    return with(lane, zero,
                {u.bx + step * d.bx, u.by + step * d.by, u.tx + step * d.tx, u.ty + step * d.ty,
                 u.lx + step * d.lx, u.ly + step * d.ly, u.rx + step * d.rx, u.ry + step * d.ry},
                k);
  }

 private:
  template <class L, class B>
  CellState<T, B> with(L lane, B zero, const EdgeDifferences<B>& u, int k) const {
    const B h(inverse_h), one(T(1));
    CellState<T, B> cell;
    cell.g = {one + h * u.bx, h * u.by,       one + h * u.tx, h * u.ty,
              h * u.lx,       one + h * u.ly, h * u.rx,       one + h * u.ry};
    cell.c = {mu ? lane.load(mu + k) : B(mu_value),
              kappa ? lane.load(kappa + k) : B(kappa_value),
              B(eps),
              zero,
              zero,
              B(onset)};
    cell.c.corner = corner > T(0) ? B(corner) : cell.c.kappa;
    // w c/(w + c), in a form that takes w = 0.
    if (relief > T(0)) cell.c.corner = cell.c.corner / (cell.c.corner * B(T(1) / relief) + one);
    for (int n = 0; n < 4; ++n) cell.shift[n] = shift[n] ? lane.load(shift[n] + k) : zero;
    return cell;
  }
};

/// visit(Density, s, t, parameters) at all points of a model.
template <class T, class Model, class B, class F>
[[gnu::always_inline]] inline void for_points(const CellState<T, B>& cell, F&& visit) {
  if constexpr (requires { typename Model::Centre; }) {
    visit(typename Model::Centre{}, T(0.5), T(0.5), cell.c);
  } else {
    for (int n = 0; n < 2; ++n)
      for (int m = 0; m < 2; ++m)
        visit(Model{}, T(GaussPoints::at[m]), T(GaussPoints::at[n]), cell.c);
  }
  if constexpr (requires { typename Model::Corner; }) {
    for (int n = 0; n < 2; ++n)
      for (int m = 0; m < 2; ++m) {
        Parameters<B> c = cell.c;
        c.shift = cell.shift[2 * n + m];
        visit(typename Model::Corner{}, T(CornerPoints::at[m]), T(CornerPoints::at[n]), c);
      }
  }
}

/// Σ over points of a matrix of F's shape, gathered on the cell's edges: the adjoint of F.
template <class T, class B>
struct EdgeSums {
  B bx, by, tx, ty, lx, ly, rx, ry;
  explicit EdgeSums(B zero)
      : bx(zero), by(zero), tx(zero), ty(zero), lx(zero), ly(zero), rx(zero), ry(zero) {}
  /// Adds the matrix whose (a, b) times √2 are given.
  void add(T s, T t, B a1, B a2, B b1, B b2) {
    const B s0(T(1) - s), s1(s), t0(T(1) - t), t1(t);
    const B p11 = a1 + b1, p21 = a2 + b2, p12 = b2 - a2, p22 = a1 - b1;
    bx = bx + t0 * p11;
    by = by + t0 * p21;
    tx = tx + t1 * p11;
    ty = ty + t1 * p21;
    lx = lx + s0 * p12;
    ly = ly + s0 * p22;
    rx = rx + s1 * p12;
    ry = ry + s1 * p22;
  }
};

/// Upper triangle of a symmetric 4×4 tangent on (a₁, a₂, b₁, b₂) by rows: a₁a₁ a₁a₂ a₁b₁ a₁b₂ a₂a₂
/// a₂b₁ a₂b₂ b₁b₁ b₁b₂ b₂b₂.
constexpr int kTangentEntries = 10;

/// The least eigenvalue of a density's Hessian that a clamp of this width leaves.
template <class T, class Density, class B>
B least_eigenvalue(const Parameters<B>& c, B width) {
  if constexpr (requires { Density::template floor<T>(c, width); })
    return Density::template floor<T>(c, width);
  else
    return (B(T(1)) - width) * c.mu;
}

template <class B>
struct LeastEigenvalue {
  B value;
};

/// The Hessian of one point's energy, its eigenvalues raised to the least one.
template <class T, class B>
struct Tangent {
  B a1, a2, b1, b2, aa, ab, bb, twist, flip;
  template <class Density>
  Tangent(Density density, const Split<B>& f, const Parameters<B>& c, B width)
      : Tangent(density, f, c, LeastEigenvalue<B>{least_eigenvalue<T, Density>(c, width)}) {}
  template <class Density>
  Tangent(Density, const Split<B>& f, const Parameters<B>& c, LeastEigenvalue<B> least) {
    const Polar<T, Density, B> p(f);
    Moduli<B> m = Density::template at<T>(c, p.ra, p.rb);
    raise_eigenvalues<T>(m, least.value);
    a1 = p.a1, a2 = p.a2, b1 = p.b1, b2 = p.b2;
    aa = m.aa, ab = m.ab, bb = m.bb, twist = m.twist, flip = m.flip;
  }
  /// The product with (a, b) of a matrix.
  void apply(const Split<B>& f, B& pa1, B& pa2, B& pb1, B& pb2) const {
    const B along_a = a1 * f.a1 + a2 * f.a2, across_a = twist * (a1 * f.a2 - a2 * f.a1);
    const B along_b = b1 * f.b1 + b2 * f.b2, across_b = flip * (b1 * f.b2 - b2 * f.b1);
    const B pa = aa * along_a + ab * along_b, pb = ab * along_a + bb * along_b;
    pa1 = a1 * pa - a2 * across_a;
    pa2 = a2 * pa + a1 * across_a;
    pb1 = b1 * pb - b2 * across_b;
    pb2 = b2 * pb + b1 * across_b;
  }
  void entries(B* out) const {
    out[0] = aa * (a1 * a1) + twist * (a2 * a2);
    out[1] = (aa - twist) * (a1 * a2);
    out[2] = ab * (a1 * b1);
    out[3] = ab * (a1 * b2);
    out[4] = aa * (a2 * a2) + twist * (a1 * a1);
    out[5] = ab * (a2 * b1);
    out[6] = ab * (a2 * b2);
    out[7] = bb * (b1 * b1) + flip * (b2 * b2);
    out[8] = (bb - flip) * (b1 * b2);
    out[9] = bb * (b2 * b2) + flip * (b1 * b1);
  }
};

/// Node rows of one component that a cell row adds to; null on the fixed boundary.
template <class T>
struct TwoRows {
  T *n00, *n10, *n01, *n11;
  TwoRows(const Plane<T>& f, int j, int parity) {
    const Corners<T> all(f, j, parity);
    const bool lower = j > 0, upper = j + 2 < f.rows;
    n00 = lower ? all.n00 : nullptr;
    n10 = lower ? all.n10 : nullptr;
    n01 = upper ? all.n01 : nullptr;
    n11 = upper ? all.n11 : nullptr;
  }
  /// Sets the nodes (fresh) or adds to them.
  template <class L, class B>
  void put(L lane, bool fresh, B at00, B at10, B at01, B at11, int k) const {
    auto one = [&](T* node, B value) {
      if (!node) return;
      lane.store(fresh ? value : lane.load(node + k) + value, node + k);
    };
    one(n00, at00);
    one(n10, at10);
    one(n01, at01);
    one(n11, at11);
  }
};

/// The fixed boundary's columns of the node rows beside cell row j hold 0.
template <class T>
void clear_edges(const Plane<T>& f, int j) {
  for (int row = j; row <= j + 1; ++row)
    if (row > 0 && row + 1 < f.rows) f.at(0, row) = f.at(f.columns - 1, row) = T(0);
}

/// Runs cells(parity, fresh) for both column parities of cell row j; `first`: the node rows beside
/// it have not been written yet.
template <class T, class F>
void two_parities(std::initializer_list<Plane<T>> out, bool first, int j, F&& cells) {
  if (first)
    for (const Plane<T>& f : out) clear_edges(f, j);
  cells(0, first);
  cells(1, false);
  for (const Plane<T>& f : out) clear_edges(f, j);
}

template <class L, class B, class T>
void scatter_edges(L lane, const EdgeSums<T, B>& g, B scale, const TwoRows<T>& x,
                   const TwoRows<T>& y, bool fresh, int k) {
  const B zero = scale - scale;
  x.put(lane, fresh, scale * (zero - g.bx - g.lx), scale * (g.bx - g.rx), scale * (g.lx - g.tx),
        scale * (g.tx + g.rx), k);
  y.put(lane, fresh, scale * (zero - g.by - g.ly), scale * (g.by - g.ry), scale * (g.ly - g.ty),
        scale * (g.ty + g.ry), k);
}

/// Adds cell row j of H d to out; `first`: sets its nodes.
template <class Model, class T>
[[gnu::flatten]] void isotropic_product_row(const Membrane<T>& m, const Unknowns<const T>& d,
                                            const Unknowns<T>& out, bool first, int j) {
  two_parities<T>({out.x, out.y}, first, j, [&](int parity, bool fresh) {
    const CellReader<T> reader(m, j, parity);
    const Corners<const T> dx(d.x, j, parity), dy(d.y, j, parity);
    const TwoRows<T> x(out.x, j, parity), y(out.y, j, parity);
    for_lanes<T>(0, half_count(d.x.columns - 1, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const CellState<T, B> cell = reader.read(lane, zero, k);
      const CellState<T, B> change{edge_differences(lane, zero, dx, dy, k), cell.c, {}};
      EdgeSums<T, B> sum(zero);
      for_points<T, Model>(cell, [&](auto density, T s, T t, const Parameters<B>& c) {
        const Tangent<T, B> tangent(density, cell.at(s, t), c, B(m.clamp_width));
        B a1, a2, b1, b2;
        tangent.apply(change.at(s, t), a1, a2, b1, b2);
        sum.add(s, t, a1, a2, b1, b2);
      });
      // A/4 · 1/h² · (1/√2)²
      scatter_edges(lane, sum, B(T(0.125)), x, y, fresh, k);
    });
  });
}

/// Adds cell row j of the force −∂E/∂x̂ to out; `first`: sets its nodes.
template <class Model, class T>
[[gnu::flatten]] void isotropic_force_row(const Membrane<T>& m, const Unknowns<T>& out, bool first,
                                          int j) {
  two_parities<T>({out.x, out.y}, first, j, [&](int parity, bool fresh) {
    const CellReader<T> reader(m, j, parity);
    const TwoRows<T> x(out.x, j, parity), y(out.y, j, parity);
    const T scale = T(-0.125 * kRootTwo) * m.spacing;  // A/4 · 1/h · 1/√2
    for_lanes<T>(0, half_count(m.ux.columns - 1, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      const CellState<T, B> cell = reader.read(lane, zero, k);
      EdgeSums<T, B> sum(zero);
      for_points<T, Model>(cell, [&](auto density, T s, T t, const Parameters<B>& c) {
        const Polar<T, decltype(density), B> p(cell.at(s, t));
        const Moduli<B> psi = decltype(density)::template at<T>(c, p.ra, p.rb);
        sum.add(s, t, psi.a * p.a1, psi.a * p.a2, psi.b * p.b1, psi.b * p.b2);
      });
      scatter_edges(lane, sum, B(scale), x, y, fresh, k);
    });
  });
}

/// Adds cell row j to the 2×2 blocks (xx, xy, yy) of the Hessian's diagonal; `first`: sets them.
/// points(parity) gives a function (lane, zero, k, add) that calls add(tangent, s, t) for all
/// points of the cells at k.
template <class T, class F>
[[gnu::always_inline]] inline void diagonal_row(const Plane<T>* block, bool first, int j,
                                                F&& points) {
  two_parities<T>({block[0], block[1], block[2]}, first, j, [&](int parity, bool fresh) {
    const auto at_points = points(parity);
    const TwoRows<T> rows[3] = {
        {block[0], j, parity}, {block[1], j, parity}, {block[2], j, parity}};
    for_lanes<T>(0, half_count(block[0].columns - 1, parity), [&](auto lane, auto zero, int k) {
      using B = decltype(zero);
      B sum[3][4];
      for (auto& entry : sum)
        for (B& node : entry) node = zero;
      at_points(lane, zero, k, [&](const auto& tangent, T s, T t) {
        for (int n = 0; n < 4; ++n) {
          const B gx((n & 1) ? ((n >> 1) ? t : T(1) - t) : ((n >> 1) ? -t : t - T(1)));
          const B gy((n >> 1) ? ((n & 1) ? s : T(1) - s) : ((n & 1) ? -s : s - T(1)));
          const Split<B> x(gx, zero, gy, zero), y(zero, gx, zero, gy);
          auto product = [](const Split<B>& f, B a1, B a2, B b1, B b2) {
            return (f.a1 * a1 + f.a2 * a2) + (f.b1 * b1 + f.b2 * b2);
          };
          B a1, a2, b1, b2;
          tangent.apply(x, a1, a2, b1, b2);
          sum[0][n] = sum[0][n] + product(x, a1, a2, b1, b2);
          sum[1][n] = sum[1][n] + product(y, a1, a2, b1, b2);
          tangent.apply(y, a1, a2, b1, b2);
          sum[2][n] = sum[2][n] + product(y, a1, a2, b1, b2);
        }
      });
      const B scale(T(0.125));
      for (int e = 0; e < 3; ++e)
        rows[e].put(lane, fresh, scale * sum[e][0], scale * sum[e][1], scale * sum[e][2],
                    scale * sum[e][3], k);
    });
  });
}

template <class Model, class T>
[[gnu::flatten]] void isotropic_diagonal_row(const Membrane<T>& m, const Plane<T>* block,
                                             bool first, int j) {
  diagonal_row<T>(block, first, j, [&](int parity) {
    return [&m, reader = CellReader<T>(m, j, parity)](auto lane, auto zero, int k, auto&& add) {
      using B = decltype(zero);
      const CellState<T, B> cell = reader.read(lane, zero, k);
      for_points<T, Model>(cell, [&](auto density, T s, T t, const Parameters<B>& c) {
        add(Tangent<T, B>(density, cell.at(s, t), c, B(m.clamp_width)), s, t);
      });
    };
  });
}

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
