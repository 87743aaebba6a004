// SPDX-License-Identifier: MIT
// The rival of the paper's Table 1: the same membrane on a triangle mesh along the curves, by a
// sparse direct solver (mesh_membrane.h), beside drumhead with averaged and with conforming curves.
// Same energy, curves, start and stopping rule; one thread. Rows of the table "mesh":
//
//     scene, kappa, n          n² is about the number of vertices
//     method                   "triangle mesh, CHOLMOD", "drumhead, averaged", "…, conforming"
//     nodes, newton, newton_all            vertices; Newton steps on the finest mesh and on all
//     seconds                  all of it; of the mesh: mesh_seconds (CGAL), assemble_seconds,
//                              solve_seconds (analyse once a mesh, factorise, solve)
//     bytes                    of the solver at its peak; of the mesh CHOLMOD's
//     rms_px, max_px           over vertices or nodes; S2 against its exact radial solution, S1
//                              against drumhead, conforming (truth.h)
//     folded                   triangles, cells
//
//   mesh_bench [--truth FOLDER] [N…]     default 100 200 400; even, at least 32
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string_view>

#include "mesh_membrane.h"
#include "nested_newton.h"
#include "solution_values.h"
#include "support/radial_reference.h"
#include "support/scene_problem.h"
#include "truth.h"

namespace drumhead::bench {
namespace {

using Eigen::Vector2d;
using Exact = std::function<Vector2d(Vector2d)>;

constexpr double kLeastOrder = 1.6;  // of the mesh's error on S2

struct Case {
  scenes::Scene scene;
  double kappa;
  Exact exact;
  bool closed_form;
};

Exact radial(double kappa) {
  const double offset = scenes::kStudyOffset;
  const std::complex<double> centre(.5 + offset, .5 + .7 * offset);
  return [centre, exact = oracle::RadialReference(.22, .40, std::acos(0.0), kappa)](Vector2d p) {
    const std::complex<double> to = centre + exact.at(std::complex<double>(p.x(), p.y()) - centre);
    return Vector2d(to.real(), to.imag());
  };
}

Exact solved(const scenes::Scene& scene, double kappa, const std::string& folder) {
  return [truth = std::make_shared<Truth>(scene, kappa, folder)](Vector2d p) {
    const auto [x, y] = truth->at(p.x(), p.y());
    return Vector2d(x, y);
  };
}

struct Error {
  double rms = 0.0, max = 0.0;  // px
};
Error error_of(const std::vector<Vector2d>& rest, const std::vector<Vector2d>& moved,
               const Exact& exact) {
  Error error;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const double miss = kPicture * (moved[k] - exact(rest[k])).norm();
    error.rms += miss * miss;
    error.max = std::max(error.max, miss);
  }
  error.rms = std::sqrt(error.rms / double(rest.size()));
  return error;
}

Json row_of(const Case& c, int n, const char* method, std::size_t nodes, const Error& error) {
  return {{"scene", c.scene.name}, {"kappa", c.kappa},     {"n", n},
          {"method", method},      {"nodes", nodes},       {"rms_px", error.rms},
          {"max_px", error.max},   {"status", "converged"}};
}

/// RMS error, px; NaN where it could not be solved.
double run_mesh(const Case& c, int n, Results& results) {
  const MeshWarp warp = solve_on_mesh(c.scene, n, c.kappa);
  const Error error = error_of(warp.mesh.rest, warp.moved, c.exact);
  Json row = row_of(c, n, "triangle mesh, CHOLMOD", warp.moved.size(), error);
  if (!warp.solved) row["status"] = "matrix not positive definite";
  row["seconds"] = warp.mesh_seconds + warp.assemble_seconds + warp.solve_seconds;
  row["mesh_seconds"] = warp.mesh_seconds;
  row["assemble_seconds"] = warp.assemble_seconds;
  row["solve_seconds"] = warp.solve_seconds;
  row["newton"] = warp.newton_finest;
  row["newton_all"] = warp.newton;
  row["factorisations"] = warp.factorisations;
  row["bytes"] = warp.solver_bytes;
  row["bytes_per_node"] = double(warp.solver_bytes) / double(warp.moved.size());
  row["folded"] = warp.folded;
  results.row("mesh", row);
  return warp.solved ? error.rms : std::nan("");
}

void run_lattice(const Case& c, int n, multigrid::CurveMethod method, Results& results) {
  multigrid::SolverOptions options;
  options.threads = 1;
  options.curve_method = method;
  const multigrid::Solution solution =
      multigrid::solve(scenes::problem(c.scene, n, c.kappa), options);
  std::vector<Vector2d> rest, moved;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = rest.size();
      rest.emplace_back(double(i) / n, double(j) / n);
      moved.emplace_back(rest.back() + Vector2d(solution.u_px[k], solution.v_px[k]));
    }
  const std::string name = std::string("drumhead, ") + multigrid::name(method);
  results.row("mesh",
              joined(row_of(c, n, name.c_str(), rest.size(), error_of(rest, moved, c.exact)),
                     values_of(solution)));
}

/// Whether the mesh's error on the scene with a closed form falls as it shall.
bool run(const Case& c, const std::vector<int>& sizes, Results& results) {
  std::map<int, double> error;
  bool right = true;
  for (const int n : sizes) {
    error[n] = run_mesh(c, n, results);
    run_lattice(c, n, multigrid::CurveMethod::averaged, results);
    run_lattice(c, n, multigrid::CurveMethod::conforming, results);
    const auto coarser = error.find(n / 2);
    if (!c.closed_form || coarser == error.end()) continue;
    const double order = std::log2(coarser->second / error[n]);
    if (order >= kLeastOrder) continue;
    right = false;
    std::fprintf(stderr, "mesh_bench: %s kappa %g, %d²: order %g\n", c.scene.name.c_str(), c.kappa,
                 n, order);
  }
  return right;
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  using namespace drumhead;
  std::vector<int> sizes;
  for (int k = 1; k < argc; ++k) {
    if (std::string_view(argv[k]) == "--truth") {
      ++k;
      continue;
    }
    sizes.push_back(std::atoi(argv[k]));
    if (sizes.back() < 32 || sizes.back() % 2) {
      std::fprintf(stderr, "mesh_bench: %s: must be even and at least 32\n", argv[k]);
      return 2;
    }
  }
  if (sizes.empty()) sizes = {100, 200, 400};
  bench::Results results(argc, argv);
  const std::string folder = bench::truth_folder(argc, argv);
  const scenes::Scene s1 = scenes::sponge(scenes::kStudyOffset);
  const scenes::Scene s2 = scenes::roundabout(90.0, scenes::kStudyOffset);
  bool right = true;
  for (const bench::Case& c : {bench::Case{s1, 1.0, bench::solved(s1, 1.0, folder), false},
                               bench::Case{s2, 1.0, bench::radial(1.0), true},
                               bench::Case{s2, 10.0, bench::radial(10.0), true}})
    right &= bench::run(c, sizes, results);
  return right ? 0 : 1;
}
