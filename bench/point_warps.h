// SPDX-License-Identifier: MIT
#pragma once
// Warps that people make from pairs of points, without any lattice: rivals of the membrane on the
// same curves, from which the points are taken. Each returns q for a pair (p, q): they interpolate.
// Points are complex numbers here, so that a turn with a change of size is one factor.
#include <complex>
#include <functional>
#include <vector>

#include <drumhead/grid/curve.h>
#include <drumhead/grid/lattice.h>

namespace drumhead::bench {

using Complex = std::complex<double>;

struct PointPairs {
  std::vector<Complex> from, to;  ///< picture pixels; no two of `from` in the same place
};

/// Points of the curves at equal arc length, at most `spacing` apart, a closed curve's first point
/// once. A point nearer than a thousandth of `spacing` to one before is left out.
PointPairs points_on(const std::vector<grid::CurvePair>& curves, double spacing);
/// The same, and points of the lattice's outer edge, which does not move.
PointPairs points_on(const std::vector<grid::CurvePair>& curves, const grid::Lattice& lattice,
                     double spacing);

using PointWarp = std::function<Complex(Complex)>;

/// Bookstein 1989: f(v) = a + b v + c v̄ + Σ w_k r² ln r, r = |v − p_k|, Σ w = Σ w p = Σ w p̄ = 0, by
/// a dense LU of N + 3 unknowns. (a, b, c complex: the affine maps of the plane.)
PointWarp thin_plate_spline(const PointPairs& points);

/// Schaefer, McPhail and Warren 2006, weights 1/r²: f(v) = q* + (v − p*) a/|a| with p*, q* the
/// weighted means and a = Σ w (q − q*) conj(p − p*); a similarity has a / Σ w |p − p*|² instead.
enum class Fit { rigid, similarity };
PointWarp moving_least_squares(const PointPairs& points, Fit fit);

/// Shepard 1968: displacements averaged with weights 1/r², as ImageMagick's -distort Shepards.
PointWarp shepard(const PointPairs& points);

/// Displacements of the lattice's nodes, as a solution has them.
void evaluate(const PointWarp& warp, const grid::Lattice& lattice, std::vector<double>& u,
              std::vector<double>& v);

}  // namespace drumhead::bench
