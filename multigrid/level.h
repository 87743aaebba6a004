// SPDX-License-Identifier: MIT
#pragma once
// One level of the hierarchy: its lattice, material, curve rows, state and the linear system of the
// current Newton step. mu is 1 throughout: pressures, weights and energies are in units of the
// scene's mu.
#include <memory>
#include <vector>

#include <drumhead/grid/cut_cells.h>
#include <drumhead/grid/field.h>
#include <drumhead/grid/material.h>
#include <drumhead/kernels/model.h>
#include <drumhead/kernels/relax.h>

#include "conforming.h"
#include "solid.h"

namespace drumhead::multigrid {

/// What of a scene decides which fields exist and how the rows are softened.
struct SceneTraits {
  bool pressure = true;    ///< crpm with kappa > 0 somewhere
  double stiffness = 0.0;  ///< largest kappa/mu of a cell
  kernels::Model model = kernels::Model::crpm;
  double jump = 0.0;           ///< qs of the equations: 0 for exact rows
  double jump_inside = 0.005;  ///< qs of the preconditioner
  double stiffest = 1.0;       ///< largest mu of a cell: no cell's P is smoothed too much
  friend bool operator==(const SceneTraits&, const SceneTraits&) = default;
};

/// The curve rows of a level in the solver's number type.
template <class T>
class CutRows {
 public:
  CutRows() = default;
  explicit CutRows(const grid::CutCells& cuts);
  kernels::Cuts<T> view(T jump) const;
  int size() const { return int(length_.size()); }
  std::size_t bytes() const;
  /// Takes the jump by the local stiffness, qs/mu with mu the mean over the two cells of a link:
  /// else it opens gaps where mu is large, and where mu is small the null modes are back. Null: 1.
  void divide_jump(const kernels::Plane<const T>& mu);

 private:
  std::vector<int> row_begin_, column_, link_begin_, link_;
  std::vector<T> weight_, compliance_, length_, link_diagonal_, strength_;
};

/// Transfer of q to the next coarser level: q_c = share·q_parent.
template <class T>
struct CutTransfer {
  std::vector<int> parent;
  std::vector<T> share;
};

template <class T>
struct Level {
  int nx = 0, ny = 0;
  T spacing = T(1);

  // Material: fields only where the scene has them.
  T compliance_value = T(1);
  grid::Field<T> mu, compliance, inverse_diagonal;

  // Curve rows.
  CutRows<T> cuts;
  CutTransfer<T> to_coarse;
  std::vector<grid::Point> wanted;  ///< b, in finest cells

  /// Where the lattice conforms to the curves; there are no curve rows then.
  std::unique_ptr<ConformingLevel<T>> conforming;

  kernels::Band band;  ///< cells beside curves

  // State: of the solution where Newton runs, restricted from it on coarser levels.
  grid::Field<T> ux, uy, pressure;
  std::vector<T> q;

  // Linear system of the cycle.
  grid::UnknownFields<T> d, f;
  std::vector<T> dq, fq;

  T clamp_centre = T(0), clamp_width = T(1);
  T pressure_jump = T(0);  ///< of the volume rows, on levels below the one that is solved

  Solid<T> solid;  ///< isotropic membranes only

  Level(int nx, int ny, T spacing, const SceneTraits& traits, grid::MemoryMeter& meter);
  /// Of the fields that it then has.
  static std::size_t bytes(int nx, int ny, const SceneTraits& traits);

  kernels::Membrane<T> membrane() const;
  /// Whether the membrane is more than the harmonic one.
  bool nonlinear() const { return pressure || kernels::isotropic(solid.law.model); }
  /// The membrane without pressures, for the harmonic start.
  kernels::Membrane<T> harmonic() const;
  /// State, linear system and what Newton's method has made of the law as they were at first.
  void clear(const kernels::Law<T>& law);
  /// Of the cells listed in these columns, row by row; not with isotropic membranes.
  void set_band(const std::vector<int>& row_begin, const std::vector<int>& column,
                grid::MemoryMeter& meter);
  /// Makes the level conform to curves.
  void conform(grid::ConformingCells cells, grid::MemoryMeter& meter);
  std::size_t nodes() const { return std::size_t(nx + 1) * std::size_t(ny + 1); }
};

}  // namespace drumhead::multigrid
