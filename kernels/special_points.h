// SPDX-License-Identifier: MIT
#pragma once
// The points of special cells and of the regular cells around them at which isotropic membranes
// have their densities.
#include <array>

#include "isotropic.h"
#include "special_state.h"

namespace drumhead::kernels {

constexpr int kMostVertices = 8;

/// F = 1 + Σ u_a g_a over some nodes of a cell, and the area for which it stands.
template <class T>
struct Point {
  T weight = T(0);
  int count = 0;
  std::array<int, kMostVertices> vertex{};
  std::array<T, kMostVertices> gx{}, gy{};

  void add(int a, T x, T y) {
    const std::size_t n = std::size_t(count++);
    vertex[n] = a;
    gx[n] = x;
    gy[n] = y;
  }
};

/// What of the density a point has. In special cells kappa acts on the mean of a part: RMS errors
/// of S2 turned by 45° on 64², in px of a picture of 1000, at kappa 1, 10, 100: corotated .032 .046
/// .068 (in every triangle: .038 .064 .087), neohookean .11 .26 1.3 (.16 .56 2.9).
/// `corner`: arap's one-sided term; all of fold-free's density but the volume's.
enum class Share { all, shape, volume, corner };

template <class T>
Point<T> point_of(const Triangle<T>& triangle) {
  Point<T> point;
  point.weight = triangle.area;
  for (std::size_t a = 0; a < 3; ++a) point.add(triangle.vertex[a], triangle.gx[a], triangle.gy[a]);
  return point;
}

/// The mean of F over a part, from its boundary.
template <class T>
Point<T> point_of(const SpecialCells<T>& cells, int part) {
  Point<T> point;
  point.weight = cells.area[std::size_t(part)];
  const int begin = cells.vertex_begin[std::size_t(part)],
            end = cells.vertex_begin[std::size_t(part) + 1];
  const T half = T(0.5) / point.weight;
  for (int v = begin; v < end; ++v) {
    const PartVertex<T>& next = cells.vertex[std::size_t(v + 1 < end ? v + 1 : begin)];
    const PartVertex<T>& previous = cells.vertex[std::size_t(v > begin ? v - 1 : end - 1)];
    point.add(cells.vertex[std::size_t(v)].vertex, half * (next.y - previous.y),
              half * (previous.x - next.x));
  }
  return point;
}

/// The place (s, t) of a regular cell of side h, a quarter of its area.
template <class T>
Point<T> point_of(T h, T s, T t) {
  Point<T> point;
  point.weight = T(0.25) * h * h;
  const T w = T(1) / h;
  point.add(0, w * (t - T(1)), w * (s - T(1)));
  point.add(1, w * (T(1) - t), -w * s);
  point.add(2, -w * t, w * (T(1) - s));
  point.add(3, w * t, w * s);
  return point;
}

/// The ten entries of a tangent on (a, b) as ∂²Ψ/∂F², F11 F21 F12 F22.
template <class T>
struct Stiffness {
  T at[4][4];
  explicit Stiffness(const T* entries) {
    constexpr int kIndex[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
    // a₁ = F11 + F22, a₂ = F21 − F12, b₁ = F11 − F22, b₂ = F21 + F12, all over √2
    constexpr int kOne[4] = {0, 1, 3, 0}, kOther[4] = {2, 3, 1, 2};
    constexpr T kSign[4] = {T(1), T(1), T(-1), T(-1)};
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q < 4; ++q) {
        auto entry = [&](int u, int v) { return entries[kIndex[u][v]]; };
        at[p][q] = T(0.5) *
                   ((entry(kOne[p], kOne[q]) + kSign[p] * kSign[q] * entry(kOther[p], kOther[q])) +
                    (kSign[q] * entry(kOne[p], kOther[q]) + kSign[p] * entry(kOther[p], kOne[q])));
      }
  }
};

/// ∂²/∂x̂_a∂x̂_b of a point's energy for one a of its nodes.
template <class T>
class PointRow {
 public:
  PointRow(const Stiffness<T>& k, const Point<T>& point, std::size_t a) {
    const T x = point.weight * point.gx[a], y = point.weight * point.gy[a];
    for (int p = 0; p < 4; ++p) {
      along_[p][0] = x * k.at[p][0] + y * k.at[p][2];
      along_[p][1] = x * k.at[p][1] + y * k.at[p][3];
    }
  }
  NodeBlock<T> block(const Point<T>& point, std::size_t b) const {
    const T gx = point.gx[b], gy = point.gy[b];
    return {along_[0][0] * gx + along_[2][0] * gy, along_[1][0] * gx + along_[3][0] * gy,
            along_[0][1] * gx + along_[2][1] * gy, along_[1][1] * gx + along_[3][1] * gy};
  }

 private:
  T along_[4][2];  ///< of F, for the node's x and y
};

constexpr double kGauss[2] = {0.21132486540518711775, 0.78867513459481288225};

/// The law at points of cell (i, j).
template <class T>
class CellLaw {
 public:
  CellLaw(const Membrane<T>& m, int i, int j) : m_(m), rows_(isotropic_rows(m)), i_(i), j_(j) {
    mu_ = mu_at(m, i, j);
    kappa_ = m.law.kappa.cells ? m.law.kappa.cells.at(i, j) : m.law.kappa.value;
    corner_ = m.law.corner > T(0) ? m.law.corner : kappa_;
    if (m.law.relief > T(0)) corner_ /= corner_ * (T(1) / m.law.relief) + T(1);
  }

  /// visit(point, share, shift of its corner) at all points of special cell n.
  template <class F>
  void for_points(int n, F&& visit) const {
    const SpecialCells<T>& cells = m_.special->cells();
    for (int t = cells.triangle_begin[std::size_t(n)]; t < cells.triangle_begin[std::size_t(n) + 1];
         ++t) {
      const Point<T> point = point_of(cells.triangle[std::size_t(t)]);
      if (!rows_.centred) visit(point, Share::shape, T(0));
      if (has_corners())
        visit(point, Share::corner, m_.law.listed_shift ? m_.law.listed_shift[t] : T(0));
    }
    if (has_corners() && !rows_.centred) return;
    for_parts(cells, n, [&](int p) {
      Point<T> point = point_of(cells, p);
      if (rows_.centred) point.weight *= T(0.25);
      visit(point, Share::volume, T(0));
    });
  }
  /// And of the regular cell.
  template <class F>
  void for_points(F&& visit) const {
    if (rows_.centred)
      visit(point_of(m_.spacing, T(0.5), T(0.5)), Share::volume, T(0));
    else
      for (const double t : kGauss)
        for (const double s : kGauss) visit(point_of(m_.spacing, T(s), T(t)), Share::all, T(0));
    for (int n = 0; n < 4 && has_corners(); ++n)
      visit(point_of(m_.spacing, T(n & 1), T(n >> 1)), Share::corner,
            m_.law.shift[n] ? m_.law.shift[n].at(i_, j_) : T(0));
  }

  /// `displacement`: of a vertex.
  template <class F>
  PointState<T> state(const Point<T>& point, Share share, T shift, F&& displacement) const {
    PointState<T> at{T(1), T(0), T(0), T(1), mu_, kappa_, m_.law.eps, shift, m_.law.onset};
    if (share == Share::shape) at.kappa = T(0);
    if (share == Share::corner) at.kappa = corner_;
    if (share == Share::volume) at.mu = T(0);
    const Gradient<T> g = gradient<T>(point, point.count, displacement);
    at.f11 += g.xx;
    at.f21 = g.yx;
    at.f12 = g.xy;
    at.f22 += g.yy;
    return at;
  }
  PointState<T> state(const Point<T>& point, Share share, T shift) const {
    return state(point, share, shift, [&](int vertex) {
      return at_vertex(m_.special->cells(), m_.ux, m_.uy, i_, j_, vertex);
    });
  }
  const PointLaw<T>& law(Share share) const {
    return share == Share::corner ? rows_.corner : rows_.point;
  }
  /// The ten entries of a point's tangent.
  void tangent(const Point<T>& point, Share share, T shift, T* entries) const {
    law(share).tangent(state(point, share, shift), mu_, m_.clamp_width, entries);
  }

 private:
  bool has_corners() const { return rows_.corner.stress != nullptr; }

  const Membrane<T>& m_;
  const IsotropicRows<T>& rows_;
  int i_, j_;
  T mu_, kappa_, corner_;
};

}  // namespace drumhead::kernels
