// SPDX-License-Identifier: MIT
// What solvers and ends are called, in flags, reports and messages.
#include <drumhead/multigrid/warp.h>

namespace drumhead::multigrid {

const char* name(Solver solver) {
  switch (solver) {
    case Solver::gcr:
      return "gcr";
    case Solver::kaczmarz:
      return "kaczmarz";
    case Solver::coloured_kaczmarz:
      return "coloured-kaczmarz";
    case Solver::minres:
      return "minres";
    case Solver::minres_multigrid:
      return "minres-multigrid";
  }
  return "";
}

std::optional<Solver> solver_named(std::string_view wanted) {
  for (const Solver solver : {Solver::gcr, Solver::kaczmarz, Solver::coloured_kaczmarz,
                              Solver::minres, Solver::minres_multigrid})
    if (wanted == name(solver)) return solver;
  return std::nullopt;
}

const char* name(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::stalled:
      return "stalled";
    case Status::infeasible:
      return "infeasible";
    case Status::limit:
      return "limit";
    case Status::cancelled:
      return "cancelled";
    case Status::not_finite:
      return "not_finite";
  }
  return "";
}

}  // namespace drumhead::multigrid
