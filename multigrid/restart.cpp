// SPDX-License-Identifier: MIT
#include "restart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "conforming_visits.h"
#include "volume_gap.h"

namespace drumhead::multigrid {
namespace {

// A change that takes more steps than this is not a small one.
constexpr int kMostSteps = 15;
constexpr double kShare = 0.1;
// Residual that ends the cycles of one step: the first one has most of the change to carry.
constexpr double kContent = 0.5;
// Distance inside a triangle, in cells.
constexpr double kClearly = 1e-6;
// A small change is nearly linear: what the first step leaves is what its linear solution leaves.
constexpr double kFirstRate = 0.35;

[[noreturn]] void refuse(const std::string& what, const std::string& bound) {
  throw std::invalid_argument("the solution to start from: " + what + ": must be " + bound);
}

void check_values(const char* what, const std::vector<double>& values, std::size_t wanted) {
  if (values.size() != wanted)
    refuse(std::to_string(values.size()) + " values of " + what, std::to_string(wanted));
  const auto wrong = std::ranges::find_if_not(values, [](double x) { return std::isfinite(x); });
  if (wrong != values.end())
    refuse(std::string(what) + "[" + std::to_string(wrong - values.begin()) +
               "] = " + std::to_string(*wrong),
           "finite");
}

/// `begin` are indices into a list of `count`, from 0 on, ascending.
void check_ranges(const char* what, const std::vector<int>& begin, std::size_t lists,
                  std::size_t count) {
  if (begin.size() != lists + 1 || begin.front() != 0 || std::size_t(begin.back()) != count ||
      !std::ranges::is_sorted(begin))
    refuse(std::string("split.") + what + " of " + std::to_string(begin.size()) + " indices",
           std::to_string(lists + 1) + ", ascending from 0 to " + std::to_string(count));
}

template <class T>
void set_state(Hierarchy<T>& hierarchy, const grid::CutCells& cuts, const Solution& start) {
  Level<T>& level = hierarchy[0];
  const double h = start.lattice.cell_px;
  std::size_t node = 0, cell = 0;
  for (int j = 0; j <= level.ny; ++j)
    for (int i = 0; i <= level.nx; ++i, ++node) {
      level.ux.view().at(i, j) = T(start.u_px[node] / h);
      level.uy.view().at(i, j) = T(start.v_px[node] / h);
    }
  if (level.pressure && !start.pressure.empty())
    for (int j = 0; j < level.ny; ++j)
      for (int i = 0; i < level.nx; ++i) level.pressure.view().at(i, j) = T(start.pressure[cell++]);
  // Both lists are sorted by row, then column.
  std::size_t n = 0;
  auto before = [](const CurveForce& f, int i, int j) { return f.j < j || (f.j == j && f.i < i); };
  for (int j = 0; j < level.ny; ++j)
    for (int k = cuts.row_begin[std::size_t(j)]; k < cuts.row_begin[std::size_t(j) + 1]; ++k) {
      const int i = cuts.column[std::size_t(k)];
      while (n < start.forces.size() && before(start.forces[n], i, j)) ++n;
      const bool same = n < start.forces.size() && start.forces[n].i == i && start.forces[n].j == j;
      level.q[2 * std::size_t(k)] = same ? T(start.forces[n].q.x) : T(0);
      level.q[2 * std::size_t(k) + 1] = same ? T(start.forces[n].q.y) : T(0);
    }
}

/// P of an earlier solution at a point of cell (i, j): of the triangle there, the nearest of a
/// split cell if none is.
double pressure_at(const Solution& start, int i, int j, grid::Point at_px) {
  const kernels::SplitCellsView split = start.split.view();
  const int c = split.find(i, j);
  if (c < 0 || start.split.pressure.empty())
    return start.pressure[std::size_t(j) * std::size_t(start.lattice.nx) + std::size_t(i)];
  int nearest = split.triangle_begin[c];
  double most = -std::numeric_limits<double>::infinity();
  for (int t = nearest; t < split.triangle_begin[c + 1]; ++t) {
    double least = std::numeric_limits<double>::infinity();  // distance inside the three sides
    for (std::size_t k = 0; k < 3; ++k) {
      const kernels::Position a = split.triangle[t].rest[k],
                              b = split.triangle[t].rest[(k + 1) % 3];
      const grid::Point side{b.x - a.x, b.y - a.y};
      least = std::min(least, grid::cross(side, at_px - grid::Point{a.x, a.y}) / length(side));
      if (least <= most) break;
    }
    if (least <= most) continue;
    most = least;
    nearest = t;
    if (least > kClearly * start.lattice.cell_px) break;  // in no other one then
  }
  return start.split.pressure[std::size_t(nearest)];
}

/// Nodes of soft curves where the earlier solution has their rest positions, but closer to their
/// targets the stiffer their springs are beside the membrane, as one Gauss–Seidel step would have
/// it.
template <class T>
void set_soft(const Solution& start, ConformingLevel<T>& level) {
  constexpr double kMembrane = 4.0;  // K_ii of a lattice node
  const grid::Lattice& lattice = start.lattice;
  const kernels::LatticeMapView map = map_of(start);
  auto set = [&](const grid::HeldNode& node, kernels::HeldNode<T>& held) {
    if (held.known()) return;
    const grid::Point rest = lattice.origin_px + lattice.cell_px * node.rest;
    const kernels::Position at = kernels::forward_position(map, {rest.x, rest.y});
    const double share = kMembrane / (kMembrane + node.stiffness);
    held.off_x = T(share * ((at.x - rest.x) / lattice.cell_px - double(held.wanted_x)));
    held.off_y = T(share * ((at.y - rest.y) / lattice.cell_px - double(held.wanted_y)));
  };
  for (std::size_t n = 0; n < level.cells.held.size(); ++n)
    set(level.geometry.node[n], level.cells.held[n]);
  for (std::size_t n = 0; n < level.cells.crossing.size(); ++n)
    set(level.geometry.curve_node[n], level.cells.crossing[n]);
}

/// Held nodes in their places and pressures of the parts.
template <class T>
void set_conforming_state(Level<T>& level, const Solution& start) {
  ConformingLevel<T>& conforming = *level.conforming;
  set_soft(start, conforming);
  set_held<T>(conforming, level.ux.view(), level.uy.view());
  if (start.pressure.empty()) return;
  const grid::Lattice& lattice = start.lattice;
  for_special(conforming.geometry, [&](int c, int i, int j) {
    for_parts(conforming.geometry, c, [&](int p) {
      const grid::Point centre = conforming.geometry.part_centre[std::size_t(p)];
      conforming.pressure[std::size_t(p)] =
          T(pressure_at(start, i, j, lattice.origin_px + lattice.cell_px * centre));
    });
  });
}

}  // namespace

void check_start(const Solution& start, const grid::Lattice& lattice) {
  const grid::Lattice& own = start.lattice;
  const auto cells = [](const grid::Lattice& l) {
    return std::to_string(l.nx) + " × " + std::to_string(l.ny) + " cells of " +
           std::to_string(l.cell_px) + " px from (" + std::to_string(l.origin_px.x) + ", " +
           std::to_string(l.origin_px.y) + ")";
  };
  if (own.nx != lattice.nx || own.ny != lattice.ny || own.cell_px != lattice.cell_px ||
      !(own.origin_px == lattice.origin_px))
    refuse(cells(own), "on the problem's own lattice, " + cells(lattice));
  check_values("u_px", start.u_px, lattice.nodes());
  check_values("v_px", start.v_px, lattice.nodes());
  if (!start.pressure.empty()) check_values("pressure", start.pressure, lattice.cells());
  for (const CurveForce& force : start.forces)
    if (!std::isfinite(force.q.x) || !std::isfinite(force.q.y))
      refuse("q of cell (" + std::to_string(force.i) + ", " + std::to_string(force.j) + ") = (" +
                 std::to_string(force.q.x) + ", " + std::to_string(force.q.y) + ")",
             "finite");
  const SplitCells& split = start.split;
  if (split.column.empty()) return;
  check_ranges("row_begin", split.row_begin, std::size_t(lattice.ny), split.column.size());
  check_ranges("triangle_begin", split.triangle_begin, split.column.size(), split.triangle.size());
  if (!split.pressure.empty())
    check_values("split.pressure", split.pressure, split.triangle.size());
}

template <class T>
std::vector<CurveForce> curve_forces(const Hierarchy<T>& hierarchy, const grid::CutCells& cuts) {
  const Level<T>& level = hierarchy[0];
  std::vector<CurveForce> forces;
  for (int j = 0; j < level.ny; ++j)
    for (int k = cuts.row_begin[std::size_t(j)]; k < cuts.row_begin[std::size_t(j) + 1]; ++k) {
      const std::size_t x = 2 * std::size_t(k);
      forces.push_back(
          {cuts.column[std::size_t(k)], j, {double(level.q[x]), double(level.q[x + 1])}});
    }
  return forces;
}

template <class T>
bool continue_iteration(Hierarchy<T>& hierarchy, const grid::CutCells& cuts, const Solution& start,
                        const NestedOptions& options, grid::MemoryMeter& meter,
                        SolveReport& report) {
  set_state(hierarchy, cuts, start);
  Level<T>& level = hierarchy[0];
  if (level.conforming) set_conforming_state(level, start);
  const double cell_px = start.lattice.cell_px;
  NewtonOptions newton;
  newton.most_steps = kMostSteps;
  newton.most_volume_gap = kMostVolumeGap;
  newton.linear.content = kContent;
  newton.expected = {{.rate = kFirstRate}};
  const SolveReport& before = start.report;
  newton.tolerance_rms = options.tolerance_cells > 0.0
                             ? options.tolerance_cells
                             : kShare * before.discretisation_rms_px / cell_px;
  ClampSchedule clamp;
  const LevelProgress progress = level_progress(options.progress, level.nx, level.ny, 0, 0);
  NewtonReport done = Newton<T>(hierarchy, 0, meter).run(newton, clamp, progress);
  if (done.status != Status::converged && done.status != Status::cancelled) {
    hierarchy.clear();  // coarser levels, too: isotropic ones have no forces while averaged
    return false;
  }
  report.status = done.status;
  report.algebraic_rms_px = done.error_rms * cell_px;
  report.algebraic_max_px = done.error_max * cell_px;
  report.volume_gap = done.volume_gap;
  note_areas(report);
  report.discretisation_rms_px = before.discretisation_rms_px;
  report.discretisation_max_px = before.discretisation_max_px;
  report.levels.push_back(in_pixels(level.nx, level.ny, std::move(done.steps), cell_px));
  if (report.status == Status::cancelled) forget_errors(report);
  return true;
}

#define DRUMHEAD_INSTANTIATE(T)                                                              \
  template std::vector<CurveForce> curve_forces(const Hierarchy<T>&, const grid::CutCells&); \
  template bool continue_iteration(Hierarchy<T>&, const grid::CutCells&, const Solution&,    \
                                   const NestedOptions&, grid::MemoryMeter&, SolveReport&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::multigrid
