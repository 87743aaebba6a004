// SPDX-License-Identifier: MIT
#pragma once
// Kaczmarz's method on all rows of a Newton system L d = f (elastic.h, cuts.h), as Setaluri et al.
// 2014, section 3.5, relax with it: for the row a_i of the scaled matrix S L S, S = diag(1, α, β),
//   δ = (f − L d)_i / |a_i|²,   S⁻¹ d += δ a_i,
// with all δ from the same d, then damped (Jacobi), or one colour of rows after the other
// (Gauss–Seidel). The paper does not give its α and β; equal row norms are best: α = √20 mu/(h|F|)
// per cell, β = √20 mu/|w| per cut cell, where √20 mu is the norm of the five-point row. Row norms
// are computed on the fly.
//
// Colours of the momentum rows: two rows of a component share no unknown if their nodes are three
// lattice edges apart. Rows modulo 3 and columns modulo 3 do (18 colours), but in split rows (see
// views.h) a column modulo 3 leaves a third of the lanes to work, a column modulo 4 half of them:
// hence 24. Volume rows take 2×2 colours. Curve rows are linked to their neighbours along a curve
// by the jump term, so they are taken one after the other.
#include <vector>

#include <drumhead/kernels/relax.h>

namespace drumhead::kernels {

/// Free nodes whose momentum rows are not like those around them, row by row: those that curve rows
/// touch, with their entries of W, and the first and last free column, which have fixed neighbours.
template <class T>
struct SingleNodes {
  const int* row_begin = nullptr;    ///< nodes of row j are [row_begin[j], row_begin[j+1])
  const int* column = nullptr;       ///< ascending in a row
  const int* entry_begin = nullptr;  ///< entries of node n are [entry_begin[n], entry_begin[n+1])
  const int* cut = nullptr;          ///< per entry: the cut cell,
  const int* corner = nullptr;       ///< and which of its nodes this is: 00, 10, 01, 11
};

/// The same with its memory; made once for the curve rows of a level of nx × ny cells, nx, ny ≥ 2.
template <class T>
class CurveNodes {
 public:
  CurveNodes(int nx, int ny, const Cuts<T>& cuts);
  SingleNodes<T> view() const;
  std::size_t bytes() const;

 private:
  std::vector<int> row_begin_, column_, entry_begin_, cut_, corner_;
};

template <class T>
struct KaczmarzSystem {
  LevelSystem<T> level;  ///< without a jump term in the volume rows: pressure_jump 0
  SingleNodes<T> nodes;
  Plane<const T> alpha2;     ///< α² per cell; null where the membrane has no pressures
  const T* beta2 = nullptr;  ///< β² per cut
  T omega = T(1);            ///< damping (Jacobi) or over-relaxation (Gauss–Seidel) of every row
};

/// Balanced α² (cells; not written where null) and β² (cuts) at the membrane's state.
template <class T>
void balance_rows(const Membrane<T>& membrane, const Cuts<T>& cuts, const Plane<T>& alpha2,
                  T* beta2);

/// Damped Jacobi: d += omega S² L e with e = residual/|row|² of all rows at the d given. e: fields
/// like d, 0 on the fixed boundary, and eq, four values a cut, are overwritten.
template <class T>
void damped_kaczmarz(const KaczmarzSystem<T>& system, const Unknowns<T>& e, T* eq);

/// Which rows of the lattice a sweep visits.
enum class Reach {
  everywhere,
  near_curves  ///< momentum rows of the cut cells' nodes, volume rows of the cut cells
};

/// Gauss–Seidel: one sweep over the momentum rows in colours, the volume rows in colours, all curve
/// rows in order.
template <class T>
void coloured_kaczmarz(const KaczmarzSystem<T>& system, Reach reach);

}  // namespace drumhead::kernels
