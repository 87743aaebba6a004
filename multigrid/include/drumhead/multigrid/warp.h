// SPDX-License-Identifier: MIT
#pragma once
// The façade: a picture's lattice, its material and its curve pairs go in, node displacements and a
// report come out. Minimises the energy of the membrane (kernels/model.h; crpm: Eq. 5 of Setaluri
// et al. 2014, in cells along conforming curves that of grid/conforming.h) by Newton's method in
// nested iteration over a matrix-free multigrid solver. All lengths in picture pixels; a caller who
// has no picture may take any unit.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <drumhead/grid/curve.h>
#include <drumhead/grid/lattice.h>
#include <drumhead/grid/material.h>
#include <drumhead/multigrid/split_cells.h>

namespace drumhead::multigrid {

struct WarpProblem {
  grid::Lattice lattice;
  grid::Material material;
  std::vector<grid::CurvePair> curves;
};

/// What the solver is about to do, for a progress line.
struct Progress {
  int nx = 0, ny = 0;   ///< the level
  int newton_step = 0;  ///< on that level, from 1
  /// Rough share of the whole solve that is done: 0 at first, never less than before, below 1.
  double fraction = 0.0;
};

/// How the linear system of a Newton step is solved.
enum class Solver {
  /// Multigrid cycles of Gauss–Seidel on x̂ and weighted Kaczmarz on the other rows, under flexible
  /// GCR where they alone do not suffice. The others are for comparison.
  gcr,
  /// As Setaluri et al. 2014, section 3.5: V-cycles of damped-Jacobi Kaczmarz on all rows, with
  /// Gauss–Seidel Kaczmarz near the curves before and after.
  kaczmarz,
  coloured_kaczmarz,  ///< V-cycles of over-relaxed Gauss–Seidel Kaczmarz on all rows in colours
  minres,             ///< MINRES on the whole system, rows balanced
  minres_multigrid  ///< MINRES, preconditioned by a multigrid cycle on x̂ and diagonals on P and q
};
const char* name(Solver solver);
/// Nothing for a name that is none of these.
std::optional<Solver> solver_named(std::string_view name);

/// How the lattice meets the curves.
enum class CurveMethod {
  /// Conforming where that is possible (Solver::gcr), not exact, the membrane is not stvk, kappa/mu
  /// is at most 300 for the others but crpm and harmonic, and at most 200 for crpm where a curve is
  /// soft; else averaged; averaged, too, where conforming cells do not converge.
  automatic,
  averaged,   ///< mean rows per cut cell (Setaluri et al. 2014, Eq. 2): first order, soft or hard
  conforming  ///< cells divided along the curves (grid/conforming.h): second order, soft or hard
};
const char* name(CurveMethod method);
/// Nothing for a name that is none of these.
std::optional<CurveMethod> curve_method_named(std::string_view name);

struct Solution;

/// What a solve cuts and builds besides its solution, kept for the next one by SolverOptions::kept:
/// about the memory that the report calls solver_bytes, and what the curves are on each lattice.
class KeptLevels {
 public:
  KeptLevels();
  ~KeptLevels();
  KeptLevels(KeptLevels&&) noexcept;
  KeptLevels& operator=(KeptLevels&&) noexcept;

  struct Contents;  ///< the solver's own
  Contents& contents();

 private:
  std::unique_ptr<Contents> contents_;
};

struct SolverOptions {
  Solver solver = Solver::gcr;
  /// Conforming curves need Solver::gcr.
  CurveMethod curve_method = CurveMethod::automatic;
  /// No cap on kappa or weights, averaged rows met to rounding with no q-jump in the equations,
  /// double precision throughout, and Newton's method until no node moves by more than 1e-7 cells.
  bool exact = false;
  /// Algebraic error asked for, RMS over the nodes in picture pixels; 0: a tenth of the estimated
  /// discretisation error. Areas have their own bound, SolveReport::volume_gap.
  double tolerance_px = 0.0;
  /// A solution on the same lattice to go on from, where curves or material have changed a little
  /// or curves were taken away: Newton on the finest lattice alone, to a tenth of the
  /// discretisation error that this solution was estimated to have if no tolerance is given. Where
  /// that does not converge, with `exact`, and where the curves were met in another way, the
  /// scene is solved from the beginning. Automatic goes on as the start did.
  const Solution* start = nullptr;
  /// Optional: takes over what the last solve left here and leaves its own. Only curves that have
  /// changed are cut; where only targets have, nothing is built anew. The solution is the same to
  /// the last bit. Not for two solves at a time; exact solves, which no start helps, neither use
  /// nor change it.
  KeptLevels* kept = nullptr;
  int threads = 0;  ///< OpenMP threads; 0: as OpenMP decides
  /// Optional. Called by the calling thread before each Newton step; false: stop
  /// (Status::cancelled; it is not called again).
  std::function<bool(const Progress&)> progress;
};

enum class Status {
  converged,   ///< the tolerance was reached
  stalled,     ///< no further decrease was possible before it was reached
  infeasible,  ///< the hard curve rows contradict one another
  limit,       ///< the step limit came first
  /// Progress was answered with false; the last iterate is returned, of a coarser lattice if it
  /// came to no finer one. Its errors and volume_gap are not numbers.
  cancelled,
  not_finite,  ///< a number that is not finite appeared; the last finite iterate is returned
};
const char* name(Status status);

struct NewtonStep {
  double theta =
      1.0;  ///< clamp of the pressure in the Hessian, in units of mu; infinity: exact Hessian
  double step = 1.0;  ///< accepted step length t
  int krylov = 0;     ///< cycles of the linear solver, or iterations of MINRES
  /// Relative residual left by the linear solver; where that is not looked at (one cycle, after a
  /// step that left at most half of them), the norm of all equations after the step by that before.
  double residual = 0.0;
  double dx_rms_px = 0.0, dx_max_px = 0.0;
  int inverted_cells = 0;  ///< after the step
};
struct LevelReport {
  int nx = 0, ny = 0;
  std::vector<NewtonStep> newton;
};
struct CurveReport {
  std::string name;
  double length_px = 0.0;                     ///< of the source
  double gap_rms_px = 0.0, gap_max_px = 0.0;  ///< distance warped source – target along the curve
  grid::Point worst_px;                       ///< where on the source the gap is largest
};
struct FoldReport {
  // Of split cells: the mean of J and the least of its triangles.
  int inverted_cells = 0;  ///< J* < 0 at the centre
  int folded_cells = 0;    ///< J < 0 at any corner
  double min_J = 1.0, min_corner_J = 1.0;
  /// Rest centres of at most 20 folded cells, of split ones those of their most inverted triangles.
  std::vector<grid::Point> places_px;
};
/// Primal values per mu and per lattice area: elastic is 1 at rest.
struct EnergyReport {
  double total = 0.0, elastic = 0.0, volume = 0.0, constraint = 0.0;
};
/// What volume rows may leave at the end, SolveReport::volume_gap. The moves of nodes do not see
/// areas: at kappa/mu 1e4 areas that are wrong by 2 % are twice the membrane's energy at rest (S1,
/// 128²: energy 12.6 without this bound, 2.65 with it).
inline constexpr double kMostVolumeGap = 0.02;

struct SolveReport {
  Status status = Status::converged;
  kernels::Model model = kernels::Model::crpm;  ///< crpm without any kappa is harmonic
  Solver solver = Solver::gcr;
  CurveMethod curve_method = CurveMethod::averaged;  ///< the way that was taken: not automatic
  bool exact = false;
  int lattice_levels = 0;
  std::vector<LevelReport> levels;  ///< coarsest first, also a start that was given up
  double work_units = 0.0;          ///< (cut + solve seconds) / work_unit_seconds
  double work_unit_seconds =
      0.0;  ///< one Hessian–vector product on the finest lattice, timed in this run
  double algebraic_rms_px = 0.0, algebraic_max_px = 0.0;
  double discretisation_rms_px = 0.0, discretisation_max_px = 0.0;
  /// The algebraic error of areas: share of the membrane's energy by which that exceeds Eq. 5 at
  /// the same state, Σ A kappa/2 (J* − 1 − P/kappa)², or an upper bound of the share. At most
  /// kMostVolumeGap where `converged`, or a note says that curves and areas contradict one another.
  double volume_gap = 0.0;
  std::vector<CurveReport> curves;
  FoldReport folds;
  EnergyReport energy;
  double cut_seconds = 0.0, solve_seconds = 0.0;
  std::size_t solver_bytes = 0;  ///< peak of the memory that the solver allocated
  std::string isa;               ///< instruction set of the kernels
  int threads = 1;
  std::vector<std::string> notes;  ///< what the solver changed or could not do, in words
};

/// q of Eq. 5, of averaged curves: the force, in units of mu·cell_px, that they exert in cell (i,
/// j) which they cut.
struct CurveForce {
  int i = 0, j = 0;
  grid::Point q;
};

/// The deformed lattice: displacement of the point that rests at node (i, j) at index j·(nx+1)+i,
/// pressure of cell (i, j) at j·nx+i (of a split cell, the mean).
struct Solution {
  grid::Lattice lattice;
  std::vector<double> u_px, v_px;
  std::vector<double> pressure;    ///< P in units of mu; empty where no pressures exist
  SplitCells split;                ///< where the lattice conforms to the curves; else empty
  std::vector<CurveForce> forces;  ///< empty where the lattice conforms to the curves
  SolveReport report;
};

/// The solution as the resampler reads it: a window, which must not outlive it.
kernels::LatticeMapView map_of(const Solution& solution);

/// J of a cell: at its centre (J*, which is its mean) and the least of its four corners; of a split
/// cell, the mean and the least over its triangles.
struct CellJ {
  double centre = 1.0, least_corner = 1.0;
};
/// Of cell (i, j).
CellJ cell_J(const Solution& solution, int i, int j);

/// Solves a scene. Throws std::invalid_argument, naming value and bound, for bad input only;
/// numerical outcomes are in `report.status`, and the best iterate is always returned.
[[nodiscard]] Solution solve(const WarpProblem& problem, const SolverOptions& options = {});

}  // namespace drumhead::multigrid
