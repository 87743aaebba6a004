// SPDX-License-Identifier: MIT
#include <drumhead/multigrid/warp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/isa.h>
#include <drumhead/kernels/refuse.h>
#include <drumhead/kernels/threads.h>

#include "analysis.h"
#include "conforming_notes.h"
#include "curve_method.h"
#include "load_path.h"
#include "nested.h"
#include "progress_line.h"
#include "restart.h"
#include "scene.h"
#include "scene_levels.h"
#include "solve_notes.h"
#include "split_cells.h"

namespace drumhead::multigrid {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// On the default path d is capped where a further increase changes nothing that is seen.
constexpr double kMostWeight = 1e6;
// Beyond this turn of a curve (100 degrees) the harmonic start collapses.
constexpr double kLoadPathTurn = 100.0 / 180.0 * std::numbers::pi;
// Single precision is good to about that many cells; below, and for exact rows, all is double.
constexpr double kSinglePrecision = 1e-3;
constexpr double kJump = 0.005;  // on q: of the default path and of its preconditioner

void check(const WarpProblem& problem, const SolverOptions& options) {
  const grid::Lattice& lattice = problem.lattice;
  if (lattice.nx < 1 || lattice.ny < 1)
    throw std::invalid_argument("lattice of " + std::to_string(lattice.nx) + " × " +
                                std::to_string(lattice.ny) + " cells: must be at least 1 × 1");
  const auto positive = [](const char* what, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
      kernels::refuse(what, value, "positive and finite");
  };
  positive("cell_px of the lattice", lattice.cell_px);
  positive("side_px of the lattice", lattice.side_px);
  if (!std::isfinite(lattice.origin_px.x) || !std::isfinite(lattice.origin_px.y))
    throw std::invalid_argument("origin_px of the lattice = (" +
                                std::to_string(lattice.origin_px.x) + ", " +
                                std::to_string(lattice.origin_px.y) + "): must be finite");
  grid::check(problem.material, lattice);
  for (const grid::CurvePair& curve : problem.curves) grid::check(curve);
  if (!(options.tolerance_px >= 0.0) || !std::isfinite(options.tolerance_px))
    kernels::refuse("tolerance", options.tolerance_px, "at least 0 and finite");
  if (options.start) check_start(*options.start, lattice);
  const kernels::Model model = problem.material.model;
  if (kernels::isotropic(model) && options.solver != Solver::gcr)
    throw std::invalid_argument("solver " + std::string(name(options.solver)) + ": must be " +
                                name(Solver::gcr) + " for model " +
                                std::string(kernels::name(model)));
  if (options.threads < 0) kernels::refuse("threads", options.threads, "at least 0");
}

/// Appends the rows of a plane, `scale` times.
template <class T>
void append(const kernels::Plane<const T>& plane, double scale, std::vector<double>& values) {
  const std::size_t count = std::size_t(plane.columns) * std::size_t(plane.rows);
  values.reserve(count);
  grid::prefer_huge_pages(values.data(), count * sizeof(double));
  std::vector<double> row(std::size_t(plane.columns));
  for (int j = 0; j < plane.rows; ++j) {
    for (int parity = 0; parity < 2; ++parity) {
      const T* half = plane.half(j, parity);
      double* to = row.data() + parity;
      for (int k = 0; k < kernels::half_count(plane.columns, parity); ++k)
        to[2 * k] = scale * double(half[k]);
    }
    values.insert(values.end(), row.begin(), row.end());
  }
}

template <class T>
void export_state(const Hierarchy<T>& hierarchy, Solution& solution) {
  const Level<T>& level = hierarchy[0];
  append<T>(level.ux.view(), solution.lattice.cell_px, solution.u_px);
  append<T>(level.uy.view(), solution.lattice.cell_px, solution.v_px);
  if (level.pressure) append<T>(level.pressure.view(), 1.0, solution.pressure);
}

template <class T>
void export_split_cells(const Hierarchy<T>& hierarchy, Solution& solution) {
  const ConformingLevel<T>& level = *hierarchy[0].conforming;
  std::vector<grid::Point> displacement;
  for (const kernels::HeldNode<T>& node : level.cells.crossing)
    displacement.push_back(solution.lattice.cell_px *
                           grid::Point{double(node.ux()), double(node.uy())});
  set_split_cells(level.geometry, displacement, solution);
  if (solution.pressure.empty()) return;
  for (std::size_t p = 0; p < level.pressure.size(); ++p)
    solution.split.pressure.resize(std::size_t(level.geometry.part_triangle_begin[p + 1]),
                                   double(level.pressure[p]));
}

template <class T>
EnergyReport energies(const Hierarchy<T>& hierarchy, const grid::CutCells& cuts) {
  const Level<T>& level = hierarchy[0];
  kernels::Membrane<T> membrane = level.membrane();
  membrane.law.relief = membrane.law.onset = T(0);  // the energy of Eq. 8 itself
  for (auto& shift : membrane.law.shift) shift = {};
  const kernels::EnergySums sums = kernels::energy<T>(membrane, {}, T(0));
  const double area = double(level.nx) * double(level.ny);
  EnergyReport energy{.elastic = sums.elastic / area,
                      .volume = sums.volume / area,
                      .constraint = sums.constraint / area};
  // |q|²/(2 d len): the energy of a soft row's spring; the gap that the q-jump opens is not
  // counted.
  for (std::size_t k = 0; k < cuts.compliance.size(); ++k) {
    const double x = double(level.q[2 * k]), y = double(level.q[2 * k + 1]);
    energy.constraint += 0.5 * cuts.compliance[k] * (x * x + y * y) / area;
  }
  energy.total = energy.elastic + energy.volume + energy.constraint;
  return energy;
}

/// Median seconds of a Hessian–vector product on the finest lattice.
template <class T>
double time_work_unit(Hierarchy<T>& hierarchy) {
  Level<T>& level = hierarchy[0];
  // A solve that ended on a coarser lattice left these rows without a state.
  if (level.conforming) level.conforming->rows.linearise(level.membrane());
  std::array<double, 5> seconds{};
  for (double& s : seconds) {
    const Clock::time_point start = Clock::now();
    kernels::apply_hessian<T>(level.membrane(), level.d.view(), level.f.view());
    s = seconds_since(start);
  }
  std::ranges::sort(seconds);
  return seconds[seconds.size() / 2];
}

/// What the nested iteration is asked for, but for the ways to large turns and large kappa.
NestedOptions nested_options(const WarpProblem& problem, const SolverOptions& options,
                             const grid::Material& material) {
  const bool conforming = options.curve_method == CurveMethod::conforming;
  const bool tips = conforming && has_tips(problem);
  return {.solver = options.solver,
          .exact = options.exact,
          .tolerance_cells = options.tolerance_px / problem.lattice.cell_px,
          .smallest_feature = smallest_feature(problem),
          .discretisation_share = tips         ? kErrorWithTips
                                  : conforming ? kErrorOfSecondOrder
                                               : kErrorOfChange,
          .tips = tips,
          .set_targets = {},
          .limit_kappa = {},
          .largest_kappa = largest_kappa(material),
          .progress = options.progress};
}

/// What decides the levels, but for the curves.
LevelsKey levels_key(const WarpProblem& problem, const SolverOptions& options,
                     SolveReport& report) {
  LevelsKey key{.lattice = problem.lattice,
                .material = options.exact ? problem.material : capped(problem.material, report),
                .most_weight = options.exact ? std::numeric_limits<double>::infinity()
                                             : kMostWeight * largest_mu(problem.material),
                .conforming = options.curve_method == CurveMethod::conforming,
                .threads = kernels::thread_limit()};
  key.traits = {.pressure = has_pressure(key.material),
                .stiffness = grid::largest_stiffness(key.material),
                .model = key.material.model,
                .jump = kJump,
                .jump_inside = kJump,
                .stiffest = largest_mu(key.material)};
  return key;
}

template <class T>
void solve_in(const WarpProblem& problem, const SolverOptions& options, Solution& solution) {
  SolveReport& report = solution.report;
  const Clock::time_point start = Clock::now();
  LevelsKey key = levels_key(problem, options, report);
  std::optional<SceneLevels<T>> own;
  const bool keep = options.kept != nullptr && !options.exact;
  SceneLevels<T>& levels =
      keep ? options.kept->contents().levels<T>(std::move(key)) : own.emplace(std::move(key));
  std::optional<LoadPath> path;
  if (largest_turn(problem.curves) > kLoadPathTurn) path.emplace(problem.curves);
  // Conforming cells take other targets where their sources are the same to the last bit.
  const bool retargets = path && levels.key().conforming;
  const std::vector<grid::CurvePair>& curves = retargets ? path->at(1.0) : problem.curves;
  if (keep || retargets)
    levels.lay_out_again(curves);
  else
    levels.lay_out(curves);
  Hierarchy<T>& hierarchy = levels.hierarchy();
  const grid::CutCells& cuts = levels.cuts();
  const grid::Material& material = levels.key().material;
  const bool conforming = levels.key().conforming;
  grid::MemoryMeter& meter = levels.meter();
  report.lattice_levels = hierarchy.size();
  report.cut_seconds = seconds_since(start);

  const Clock::time_point solving = Clock::now();
  NestedOptions nested = nested_options(problem, options, material);
  if (options.exact && levels.key().traits.pressure)
    nested.limit_kappa = [&](double most) { hierarchy.set_compliance(material, most); };
  if (path) nested.set_targets = [&](int top, double t) { levels.set_targets(path->at(t), top); };
  if (!options.start || options.exact ||
      options.start->report.curve_method != options.curve_method ||
      !continue_iteration(hierarchy, cuts, *options.start, nested, meter, report))
    nested_iteration(hierarchy, nested, problem.lattice.cell_px, meter, report);
  report.solve_seconds = seconds_since(solving);

  report.solver_bytes = meter.peak() + hierarchy.scratch().bytes();
  report.energy = energies(hierarchy, cuts);
  if (conforming && hierarchy[0].pressure)
    set_part_means<T>(*hierarchy[0].conforming, hierarchy[0].pressure.view());
  export_state(hierarchy, solution);
  solution.forces = curve_forces(hierarchy, cuts);
  if (conforming) {
    export_split_cells(hierarchy, solution);
    std::ranges::move(conforming_notes(hierarchy[0].conforming->geometry, problem),
                      std::back_inserter(report.notes));
  }
  report.work_unit_seconds = time_work_unit(hierarchy);
  report.work_units = (report.cut_seconds + report.solve_seconds) / report.work_unit_seconds;
}

/// By `options.curve_method`, which is not automatic.
Solution solve_by(const WarpProblem& problem, const SolverOptions& options) {
  Solution solution{.lattice = problem.lattice};
  solution.report.exact = options.exact;
  solution.report.solver = options.solver;
  solution.report.curve_method = options.curve_method;
  solution.report.isa = kernels::name(kernels::current_isa());
  solution.report.threads = kernels::thread_limit();
  const double tolerance_cells = options.tolerance_px / problem.lattice.cell_px;
  if (options.exact || (tolerance_cells > 0.0 && tolerance_cells < kSinglePrecision))
    solve_in<double>(problem, options, solution);
  else
    solve_in<float>(problem, options, solution);
  return solution;
}

/// The same scene with averaged rows, where conforming cells did not converge. The one of both that
/// did is the solution; what the other took is counted.
Solution solve_averaged_instead(const WarpProblem& problem, SolverOptions options,
                                Solution conforming) {
  options.curve_method = CurveMethod::averaged;
  options.start = nullptr;
  Solution averaged = solve_by(problem, options);
  const bool better = averaged.report.status == Status::converged;
  const std::string ended =
      std::string("conforming cells ended with '") + name(conforming.report.status) + "'";
  if (better) std::swap(averaged, conforming);
  SolveReport &report = conforming.report, &other = averaged.report;
  report.cut_seconds += other.cut_seconds;
  report.solve_seconds += other.solve_seconds;
  report.work_units = (report.cut_seconds + report.solve_seconds) / report.work_unit_seconds;
  report.solver_bytes = std::max(report.solver_bytes, other.solver_bytes);
  report.notes.push_back(better ? ended + "; the curves are met on average in each cell instead"
                                : ended + ", and so did averaged rows");
  return conforming;
}

}  // namespace

Solution solve(const WarpProblem& problem, const SolverOptions& options) {
  check(problem, options);
  SolverOptions chosen = options;
  chosen.curve_method = chosen_method(problem, options);
  ProgressLine line(options.progress);
  if (options.progress) chosen.progress = std::ref(line);
  const kernels::ThreadLimit threads(options.threads);
  Solution solution = solve_by(problem, chosen);
  if (options.curve_method == CurveMethod::automatic &&
      chosen.curve_method == CurveMethod::conforming &&
      solution.report.status != Status::converged && solution.report.status != Status::cancelled)
    solution = solve_averaged_instead(problem, chosen, std::move(solution));
  solution.report.curves = curve_gaps(solution, problem.curves);
  note_gaps(problem, solution.report);
  solution.report.folds = find_folds(solution);
  note_changed_area(problem, solution.report);
  note_folds(problem.material, solution.report);
  const kernels::Model model = problem.material.model;
  solution.report.model = kernels::isotropic(model)   ? model
                          : solution.pressure.empty() ? kernels::Model::harmonic
                                                      : kernels::Model::crpm;
  return solution;
}

}  // namespace drumhead::multigrid
