// SPDX-License-Identifier: MIT
#pragma once
// The row kernels of the isotropic membranes for one instruction set, filled by
// isotropic_table.cpp, chosen together with the table of kernel_table.h.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// F (by columns) and the parameters at one point.
template <class T>
struct PointState {
  T f11, f21, f12, f22;
  T mu, kappa, eps, shift, onset;
};
template <class T>
struct PointStress {
  T shape = T(0), volume = T(0);  ///< Ψ = the part with mu + the part with kappa
  T p11 = T(0), p21 = T(0), p12 = T(0), p22 = T(0);  ///< ∂Ψ/∂F
};
/// A density at single points, for lists of them (point_body.h); null: there is none.
template <class T>
struct PointLaw {
  PointStress<T> (*stress)(const PointState<T>&) = nullptr;
  /// The ten entries of the tangent, its eigenvalues raised as a clamp of this width leaves them in
  /// a cell of stiffness `mu`.
  void (*tangent)(const PointState<T>&, T mu, T width, T* entries) = nullptr;
};

/// One membrane (isotropic_body.h).
template <class T>
struct IsotropicRows {
  void (*product)(const Membrane<T>&, const Unknowns<const T>& d, const Unknowns<T>& out,
                  bool first, int j);
  void (*force)(const Membrane<T>&, const Unknowns<T>& out, bool first, int j);
  void (*diagonal)(const Membrane<T>&, const Plane<T>* block, bool first, int j);
  /// Row j of the ten entries of the cells' mean tangent (averaged_body.h).
  void (*tangent)(const Membrane<T>&, const SplitRow<T>* out, int j);
  void (*energy)(const Membrane<T>&, const Unknowns<const T>& d, T step, const Columns& left_out,
                 EnergySums&, int j);
  PointLaw<T> point, corner;
  /// `point` acts at a cell's centre, with a quarter of its area, and `corner` has all the rest;
  /// else `point` acts at the Gauss points.
  bool centred = false;
};

template <class T>
struct IsotropicTable {
  IsotropicRows<T> arap, fold_free, corotated, linear, neohookean, stvk;
  IsotropicRows<T> averaged;  ///< product and diagonal only
  void (*block_step)(const Plane<const T>* inverse_block, T omega, const Unknowns<const T>& f,
                     const Unknowns<const T>& product, const Unknowns<T>& d, int j);
  void (*invert_blocks)(T mu, const Plane<T>* block, int j);
  void (*corner_pressure)(const Membrane<T>&, const Plane<T>* shift, int j);
  T (*point_pressure)(const PointState<T>&);
};

/// The table of the instruction set in use.
template <class T>
const IsotropicTable<T>& isotropic_table();

#define DRUMHEAD_DECLARE_TABLES(isa)                     \
  namespace isa {                                        \
  extern const IsotropicTable<float> isotropic_floats;   \
  extern const IsotropicTable<double> isotropic_doubles; \
  }
DRUMHEAD_DECLARE_TABLES(scalar)
DRUMHEAD_DECLARE_TABLES(sse2)
DRUMHEAD_DECLARE_TABLES(avx2)
DRUMHEAD_DECLARE_TABLES(avx512)
#undef DRUMHEAD_DECLARE_TABLES

}  // namespace drumhead::kernels
