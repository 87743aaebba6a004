// SPDX-License-Identifier: MIT
#pragma once
// The relaxation of one level, fused with the transfers around it into one skewed pass over the
// rows:
//   [clear d or add the prolonged coarse correction] → nodes red → nodes black → near nodes of
//   even, then of odd rows → volume rows, 2×2 colours → curve rows → curve rows and volume rows in
//   reverse → [the same in the band beside the curves] → [residual, restricted to the coarser
//   level].
// Nodes: Gauss–Seidel, u_i += (f_i − (H d)_i)/K_ii. Volume and curve rows: Kaczmarz in the D = diag
// K inner product, invariant to the scaling of the multipliers (the α, β of Setaluri et al. 2014,
// Eq. 4).
// Isotropic membranes (model.h), whose Hessian products are not done node by node: nodes by two
// steps of Chebyshev iteration with the 2×2 blocks D of the Hessian's diagonal, then curve rows in
// the inner product of D, forwards and in reverse.
#include <cassert>
#include <cstddef>
#include <vector>

#include <drumhead/kernels/band.h>
#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/special.h>
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// One level of a Newton system: operator, correction and right-hand side. f.x, f.y carry the curve
/// forces Wᵀ dq (see cuts.h) and change with dq.
template <class T>
struct LevelSystem {
  Membrane<T> membrane;
  Cuts<T> cuts;
  Unknowns<T> d, f;
  T* dq = nullptr;        ///< two per cut
  const T* fq = nullptr;  ///< right-hand side of the curve rows
  /// With special cells: to the coarser level, and that level's rows.
  const SpecialTransfer<T>* transfer = nullptr;
  const SpecialRows<T>* coarse_special = nullptr;
  /// Cells beside the curves, without special ones; only RelaxStages::band asks for it.
  const Band* band = nullptr;
  Unknowns<T> product;  ///< isotropic membranes: room for H d
  T largest = T(2);     ///< isotropic membranes: largest eigenvalue of D⁻¹ H
};

/// Row buffers for the fused restriction, one set a thread; make once, reuse.
template <class T>
class RowScratch {
 public:
  /// For lattices of up to `columns` columns of nodes, nx + 1, while thread_limit() is at most
  /// `threads` (1 will do on lattices that are never shared out, see kernels/parallel.h).
  RowScratch(int columns, int threads);
  struct Rows {
    T* x[4];
    T* y[4];
    T* p[2];
    T* kept;            ///< values of near nodes while a vectorised sweep passes over them
    SplitRow<T> share;  ///< 1 for every cell of a row, between sweeps
    int held[4];        ///< which residual row x[r], y[r] hold, −1: none
    int next;           ///< the residual row that follows the last one made, −1: none
  };
  Rows& rows(int thread) {
    assert(std::size_t(thread) < rows_.size());
    return rows_[std::size_t(thread)];
  }
  std::ptrdiff_t odd() const { return odd_; }
  void forget();
  /// One value per part of special cells.
  T* parts(int count);
  /// Room for what lattice nodes have for the curve nodes of the coarser level.
  T* curves(int count);
  std::size_t bytes() const {
    return (storage_.size() + parts_.size() + curves_.size()) * sizeof(T);
  }

 private:
  std::ptrdiff_t odd_;
  std::vector<T> storage_, parts_, curves_;
  std::vector<Rows> rows_;
};

/// Σ (f − H d)² over momentum rows plus that over volume rows per spacing² (so that rows are of one
/// size on every level); curve rows are the caller's. Nothing is stored.
template <class T>
double residual_norm2(const LevelSystem<T>& level, RowScratch<T>& scratch);

/// Which sweeps a relaxation makes between its transfers.
enum class Sweeps {
  all,
  none,
  nodes,          ///< nodes red, nodes black alone
  nodes_reversed  ///< nodes black, nodes red: the adjoint of `nodes`
};

/// Sweeps of the volume rows.
enum class VolumeSweeps {
  twice,     ///< before the curve rows and, in reverse, after them
  forwards,  ///< before the curve rows alone
  reverse    ///< after the curve rows alone, in reverse
};

struct RelaxStages {
  bool from_zero = false;  ///< d.x, d.y, d.p are cleared first (dq must be 0 already)
  Sweeps sweeps = Sweeps::all;
  VolumeSweeps volume = VolumeSweeps::twice;
  /// Relaxations (at most 2) of the band beside the curves (LevelSystem::band) at the end, whatever
  /// `sweeps` says: its nodes, its volume rows, as often as all are swept, and all curve rows; with
  /// special cells also all near nodes and parts, and volume rows in reverse alone. 0 where the
  /// level has no band.
  int band = 0;
};

/// One relaxation of `level`. `coarse_d`: if not null, its bilinear (x, y) and constant (p)
/// prolongation is added first. `coarse_f`: if not null, receives the adjoint restriction of the
/// elastic residual f − H d afterwards (curve rows: the caller's). Isotropic membranes take of
/// `stages` from_zero alone. Throws std::invalid_argument for a `band` that is none.
template <class T>
void relax(const LevelSystem<T>& level, const RelaxStages& stages,
           const Unknowns<const T>* coarse_d, const Unknowns<T>* coarse_f, RowScratch<T>& scratch);

}  // namespace drumhead::kernels
