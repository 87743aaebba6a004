// SPDX-License-Identifier: MIT
#pragma once
// The Newton system of one level as an operator on vectors, for the methods that work on the whole
// of it at once.
#include <optional>

#include "hierarchy.h"

namespace drumhead::multigrid {

/// Unknowns of a level with its curve forces.
template <class T>
struct Vector {
  grid::UnknownFields<T> fields;
  std::vector<T> q;
};

template <class T>
class NewtonSystem {
 public:
  /// Whose linearisation of the special cells it takes.
  enum class Rows {
    own,     ///< its own, at the level's clamp
    levels,  ///< the level's, which a cycle has linearised at the same clamp
  };
  /// Of level `top` at its state; `pressure` false: the harmonic system, kappa = 0.
  NewtonSystem(Hierarchy<T>& hierarchy, int top, bool pressure, grid::MemoryMeter& meter,
               Rows rows = Rows::own);

  Hierarchy<T>& hierarchy() const { return hierarchy_; }
  Level<T>& level() const { return hierarchy_[top_]; }
  int top() const { return top_; }
  bool pressure() const { return pressure_; }
  kernels::Membrane<T> membrane() const;
  kernels::Cuts<T> cuts() const;
  grid::MemoryMeter& meter() const { return meter_; }

  /// All zero.
  Vector<T> make_vector() const;
  /// The level's right-hand side, which does not carry curve forces, and its correction.
  Vector<T> right_hand_side() const;
  void set_correction(const Vector<T>& x) const;
  /// The level's d, dq as they are and as a copy.
  kernels::Unknowns<T> correction() const;

  /// out = L d, curve forces included.
  void apply(const Vector<T>& d, Vector<T>& out) const;
  /// r = f − L d.
  void residual(const Vector<T>& f, const Vector<T>& d, Vector<T>& r) const;
  /// y = a x + b y; with b = 0, y is not read.
  void combine(double a, const Vector<T>& x, double b, Vector<T>& y) const;
  /// Σ a b over all unknowns.
  double dot(const Vector<T>& a, const Vector<T>& b) const;
  /// Σ a b with volume rows per cell side, so that rows are of one size on every level; and the
  /// norm of it, by which residuals are judged.
  double product_of_residuals(const Vector<T>& a, const Vector<T>& b) const;
  double norm(const Vector<T>& r) const;

 private:
  double dot(const Vector<T>& a, const Vector<T>& b, double volume_weight) const;

  Hierarchy<T>& hierarchy_;
  int top_;
  bool pressure_;
  grid::MemoryMeter& meter_;
  /// Where the lattice conforms to curves and cycles have another clamp.
  std::optional<kernels::SpecialRows<T>> special_;
};

}  // namespace drumhead::multigrid
