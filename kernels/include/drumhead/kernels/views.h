// SPDX-License-Identifier: MIT
#pragma once
// Windows on fields of a lattice. They own nothing. A row is stored split by parity: its even
// columns lie side by side, its odd columns follow at the distance `odd`, so that red and black
// nodes, the column colours of cells and the nodes that a coarser lattice keeps are each
// contiguous, and a vector of one colour has no idle lane. Column i of row j is data[j·stride + (i
// mod 2)·odd + i/2].
#include <cstddef>
#include <type_traits>

namespace drumhead::kernels {

/// One row: half[0] holds its even columns, half[1] its odd ones.
template <class T>
struct SplitRow {
  T* half[2];
};

/// One scalar per node or cell: columns × rows values. `data` null: the scene has no such field.
template <class T>
struct Plane {
  T* data = nullptr;
  std::ptrdiff_t stride = 0;  ///< distance between rows, ≥ odd + columns/2
  std::ptrdiff_t odd = 0;  ///< distance from a row's even half to its odd half, ≥ (columns+1)/2
  int columns = 0, rows = 0;

  /// Values of the columns parity, parity + 2, … of row j.
  T* half(int j, int parity) const { return data + j * stride + parity * odd; }
  SplitRow<T> row(int j) const { return {{half(j, 0), half(j, 1)}}; }
  T& at(int i, int j) const { return half(j, i & 1)[i >> 1]; }
  explicit operator bool() const { return data != nullptr; }
  operator Plane<const T>() const requires(!std::is_const_v<T>) {
    return {data, stride, odd, columns, rows};
  }
};

/// Columns of one parity among `columns`.
constexpr int half_count(int columns, int parity) { return (columns + 1 - parity) / 2; }

/// The columns begin … end − 1 of a row, as far as it has them.
struct Span {
  int begin = 0, end = 1 << 30;
};
inline constexpr Span kWholeRow{};
/// Spans of a row, ascending and disjoint.
struct Spans {
  const Span *first = &kWholeRow, *last = &kWholeRow + 1;  ///< [first, last)
  const Span* begin() const { return first; }
  const Span* end() const { return last; }
};

/// Some columns of a row, ascending.
struct Columns {
  const int *first = nullptr, *last = nullptr;  ///< [first, last)
  const int* begin() const { return first; }
  const int* end() const { return last; }
};

/// What a Newton system has per node (x, y) and per cell (p; null where no pressures exist): a
/// correction, a right-hand side or a residual. (nx+1) × (ny+1) nodes, nx × ny cells.
template <class T>
struct Unknowns {
  Plane<T> x, y, p;
  T* listed = nullptr;  ///< one per part of the special cells (see special.h)
  int listed_count = 0;
  T* curve = nullptr;  ///< x and y of every curve node (see soft_nodes.h); null: no curve is soft
  int curve_count = 0;
  operator Unknowns<const T>() const requires(!std::is_const_v<T>) {
    return {x, y, p, listed, listed_count, curve, curve_count};
  }
};

/// A material value, constant or per cell.
template <class T>
struct Coefficient {
  T value = T(1);
  Plane<const T> cells;  ///< null: `value` everywhere
};

template <class T>
class SpecialRows;

/// See model.h.
enum class Model { crpm, harmonic, arap, fold_free, corotated, linear, neohookean, stvk };

/// What the isotropic membranes have in place of pressures. kappa is the second modulus: of the
/// one-sided term for arap, as in crpm for fold-free, Lamé's λ for the others.
template <class T>
struct Law {
  Model model = Model::crpm;
  Coefficient<T> kappa;
  /// arap, fold-free: the J below which the one-sided term of Eq. 8 acts. neohookean: the J below
  /// which ln J goes on as a parabola.
  T eps = T(0.2);
  /// fold-free: stiffness w of that term; 0: kappa.
  T corner = T(0);
  /// Of that term: the corner pressures P ≤ 0 of earlier steps over `relief`, per corner 00, 10,
  /// 01, 11 of a cell; null: none (isotropic.h).
  Plane<const T> shift[4];
  T relief = T(0);
  const T* listed_shift = nullptr;  ///< the same, one per triangle of special cells; null: none
  /// It begins gradually, from this far above eps to as far below (at least 1e-6).
  T onset = T(0);
};

/// The membrane linearised at a state: all that its operators read (Eq. 5, 6, 7 of Setaluri et al.
/// 2014). Displacements u = x̂ − X of every level are in cells of the finest lattice; a level's own
/// cell side in this unit is `spacing`.
template <class T>
struct Membrane {
  Plane<const T> ux, uy;      ///< state: displacement of the nodes
  Plane<const T> pressure;    ///< state: P per cell, null where kappa = 0 in the whole scene
  T spacing = T(1);           ///< h of this level in finest cells
  Coefficient<T> mu;          ///< stiffness
  Coefficient<T> compliance;  ///< 1/kappa; 0: incompressible
  /// 1/K_ii per node, 0 on the fixed boundary; needed only with mu per cell, null otherwise (K_ii =
  /// 4 mu).
  Plane<const T> inverse_diagonal;
  /// Pressure in the Hessian: P_H = clamp(P − clamp_centre, ±clamp_width·mu).
  T clamp_centre = T(0);
  T clamp_width = T(1);
  /// sigma: the volume rows of the linear system read B d − A/kappa dP − sigma Σ_edges L²/(8 (mu_a
  /// + mu_b)) (dP_a − dP_b), L the deformed length of the edge between cells a and b. 0 where the
  /// equations are solved; on coarser levels it stands for the nodes in the middle of the edges
  /// that they lack, without which volume and curve rows contradict one another there.
  T pressure_jump = T(0);
  /// gamma: the volume rows of parts (special.h), in the equations and on every level, have the
  /// term −gamma Σ_neighbours h²/(mu_a + mu_b) (P − P_neighbour).
  T part_jump = T(0);
  /// Cells that conform to curves (see special.h), null: all cells are regular. Their rows,
  /// linearised at this state (force and energy do without that), and the pressures of their parts.
  const SpecialRows<T>* special = nullptr;
  const T* listed = nullptr;
  Law<T> law;
  /// Isotropic membranes: the inverse 2×2 blocks of the Hessian's diagonal, xx, xy, yy; needed by
  /// the relaxation only.
  Plane<const T> inverse_block[3];
  /// Their coarse operators: the ten entries of each cell's mean tangent, entry e of cell row j in
  /// row e·ny + j (blocks.h); null: the Hessian at the state.
  Plane<const T> tangent;
};

/// The averaged curve rows of one level (Eq. 2): one pair of rows a cut cell, sorted by row, then
/// column. Row k reads −W_k du − (M dq)_k for each component, with M q = compliance·q plus the jump
/// term jump·Σ_links min(len_k, len_l)² (q_k/len_k − q_l/len_l)/len_k. Weights of nodes on the
/// fixed boundary are 0.
template <class T>
struct Cuts {
  int count = 0;
  const int* row_begin =
      nullptr;  ///< ny+1 indices: cuts of cell row j are [row_begin[j], row_begin[j+1])
  const int* column = nullptr;       ///< cell column of each cut
  const T* weight = nullptr;         ///< four per cut: nodes 00, 10, 01, 11
  const T* compliance = nullptr;     ///< 1/(d len), 0: hard
  const T* length = nullptr;         ///< len, in finest cells
  const T* link_diagonal = nullptr;  ///< one per cut: Σ_links min(len_k, len_l)²/len_k²
  const int* link_begin = nullptr;   ///< count+1 indices into link, link_strength
  const int* link = nullptr;         ///< cuts that follow or precede along a curve
  const T* link_strength = nullptr;  ///< min(len_k, len_l)²/(len_k len_l)
  T jump = T(0);                     ///< qs/mu; 0: exact rows
};

}  // namespace drumhead::kernels
