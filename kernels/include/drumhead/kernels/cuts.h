// SPDX-License-Identifier: MIT
#pragma once
// The averaged curve rows (Setaluri et al. 2014, Eq. 2 and 5): −W d − M dq = f for each of the two
// components of every cut cell. Their work is proportional to the length of the curves, so they are
// plain loops beside the vectorised lattice. Values per cut come in pairs: x at 2k, y at 2k+1.
//
// A right-hand side f of the nodes is said to *carry* the curve forces when it holds f + Wᵀ dq:
// whoever changes dq then adds Wᵀ of the change to f, and the elastic kernels need not know of
// curves.
//
// All fields of nodes that a function is given lie in memory alike: same stride, same distance of
// the odd half.
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// f.x, f.y += scale·Wᵀ q.
template <class T>
void add_curve_force(const Cuts<T>& cuts, const T* q, T scale, const Unknowns<T>& f);

/// out = −W d − M q (without f) for all cuts.
template <class T>
void apply_cuts(const Cuts<T>& cuts, const Unknowns<const T>& d, const T* q, T* out);

/// r = f − (−W d − M q).
template <class T>
void cuts_residual(const Cuts<T>& cuts, const T* f, const Unknowns<const T>& d, const T* q, T* r);

/// (M q)_k: compliance and jump term of one cut, both components.
template <class T>
struct Pair {
  T x, y;
};
template <class T>
Pair<T> cut_compliance(const Cuts<T>& cuts, const T* q, int k);
/// M_kk.
template <class T>
T cut_compliance_diagonal(const Cuts<T>& cuts, int k);

/// D-weighted Kaczmarz on the curve rows of cell row j, one after the other (backwards if
/// `reverse`): r = g + W d + M dq, s = Σ w_i²/K_ii + M_kk, d_i −= w_i r/(s K_ii), dq −= r/s, f −=
/// Wᵀ r/s (f carries the curve forces). g: right-hand side of the curve rows.
template <class T>
void relax_cuts_row(const Membrane<T>& membrane, const Cuts<T>& cuts, const T* g, T* dq,
                    const Unknowns<T>& d, const Unknowns<T>& f, bool reverse, int j);

}  // namespace drumhead::kernels
