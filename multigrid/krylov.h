// SPDX-License-Identifier: MIT
#pragma once
// Flexible GCR around the cycles: minimises the residual over the last few directions, so that a cycle that
// amplifies a few error components (strong stretch, indefinite systems far from a solution) still converges.
#include "cycle.h"

namespace drumhead::multigrid {

/// Unknowns of a level with its curve forces.
template <class T>
struct Vector {
  grid::UnknownFields<T> fields;
  std::vector<T> q;
};

struct KrylovOptions {
  double reduction = 0.1;   ///< of the residual norm
  int most_cycles = 20;
  int directions = 2;       ///< stored pairs, each 6 values a node
  CycleKind kind = CycleKind::f;
};

struct KrylovReport {
  int cycles = 0;
  double residual = 1.0;    ///< relative to the right-hand side
};

template <class T>
class Krylov {
 public:
  /// Vectors for level `top`. The system solved has the jump term of the equations, the cycle the one inside.
  Krylov(Hierarchy<T>& hierarchy, int top, bool pressure, grid::MemoryMeter& meter);

  /// x := approximate solution of H x = b from zero. b is overwritten with the residual.
  KrylovReport solve(Vector<T>& b, Vector<T>& x, const KrylovOptions& options);

  Vector<T> make_vector();

 private:
  struct Direction {
    Vector<T> z, image;
    double norm2 = 0.0;
  };
  void apply(const Vector<T>& d, Vector<T>& out);
  double dot(const Vector<T>& a, const Vector<T>& b) const;
  void combine(double a, const Vector<T>& x, double b, Vector<T>& y) const;

  Hierarchy<T>& hierarchy_;
  Level<T>& level_;
  bool pressure_;
  grid::MemoryMeter& meter_;
  std::vector<Direction> directions_;
};

}  // namespace drumhead::multigrid
