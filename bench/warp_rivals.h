// SPDX-License-Identifier: MIT
#pragma once
// The membrane and the warps of point_warps.h on one scene, all judged alike. Rows of the table
// "warps":
//
//     scene, width, height     px
//     method, kappa            "drumhead, averaged", "drumhead, conforming" with kappa;
//                              "thin-plate spline", "moving least squares, rigid", "…, similarity",
//                              "Shepard", "OpenCV thin-plate spline" without
//     points                   pairs that the rivals take from the curves and from the fixed edge
//     n                        cells across the longer side of the lattice that all are evaluated
//     on status, seconds          one thread; cutting or sampling, solving and evaluating the
//     lattice gap_rms_px, gap_max_px   warped sources less targets every half pixel along all
//     curves; a
//                              rival's own formula there, not its lattice
//     folded_share, rms_J      of squares between the centres of the picture's pixels, through the
//                              lattice: those with J <= 0; RMS(J − 1)
#include <functional>
#include <string>

#include <drumhead/multigrid/warp.h>

#include "point_warps.h"
#include "results.h"

namespace drumhead::bench {

struct WarpScene {
  std::string name;
  multigrid::WarpProblem problem;  ///< in picture pixels
  std::vector<double> kappas;      ///< the membrane's, one solve each
  int width = 0, height = 0;
};

struct WarpQuality {
  double gap_rms_px = 0.0, gap_max_px = 0.0, folded_share = 0.0, rms_J = 0.0;
};
WarpQuality quality(const WarpScene& scene, const multigrid::Solution& solution,
                    const PointWarp& warp);

/// The name as a file's ("thin-plate-spline").
using Show = std::function<void(const std::string& file_name, const multigrid::Solution&)>;

/// The membrane with averaged and with conforming curves: a row each, and each solution to `show`.
void compare_membranes(const WarpScene& scene, Results& results, const Show& show = {});
/// The others with points at most `spacing` px apart, likewise. False where a method misses a point
/// of its own.
bool compare_rivals(const WarpScene& scene, double spacing, Results& results,
                    const Show& show = {});

}  // namespace drumhead::bench
