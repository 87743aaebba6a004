// SPDX-License-Identifier: MIT
#include "report_tables.h"

#include <cmath>
#include <cstdio>

namespace drumhead::bench {
namespace {

Column number(std::string head, const char* key, double scale = 1.0) {
  return {std::move(head), [=](const Json& row) { return figure(scale * value(row, key)); }};
}
Column range(std::string head, const char* key) {
  return {std::move(head), [=](const Json& row) { return ranged(row, key); }};
}
Column word(std::string head, const char* key) {
  return {std::move(head), [=](const Json& row) { return text(row, key); }, false};
}
std::string lattice_of(const Json& row) { return figure(value(row, "n")) + "²"; }
const Column kLattice{"lattice", lattice_of};
const Column kScene{
    "scene",
    [](const Json& row) {
      const std::string scene = text(row, "scene");
      return row.contains("kappa") ? scene + ", kappa " + figure(value(row, "kappa")) : scene;
    },
    false};
const Column kSteps{"Newton steps (cycles)", [](const Json& row) {
                      return figure(value(row, "newton")) + " (" + figure(value(row, "cycles")) +
                             ")";
                    }};
const Column kStatus = word("status", "status");

/// "" for runs on several threads: no row of the table.
std::string on_one_thread(const Json& row) {
  return value(row, "threads") == 1 ? text(row, "method") : std::string();
}
/// Seconds, marked where they are not those of a solution.
std::string seconds_of(const Json& row) {
  const std::string status = text(row, "status");
  return figure(value(row, "seconds")) + (status.empty() || status == "converged" ? "" : "*");
}

/// Outcome of a hard case in a few words, marked where it is not what is expected.
std::string outcome(const Json& row) {
  return text(row, "ended") + (row.value("passed", false) ? ", " : "*, ") +
         figure(value(row, "newton")) + " steps, gap " +
         (value(row, "gap_max_px") < 1e-3 ? "0" : figure(value(row, "gap_max_px"))) + " px, " +
         figure(value(row, "folded")) + " folded";
}

std::string energy_of(const Json& row, const char* key) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.7f", value(row, key));
  return digits;
}
/// Outcome of a case of the study, marked where it is exact and not as expected.
std::string study_outcome(const Json& row) {
  const std::string note = text(row, "note");
  return text(row, "ended") + (row.value("passed", true) ? ", " : "*, ") +
         figure(value(row, "newton")) + " (" + figure(value(row, "newton_all")) + ") steps, " +
         energy_of(row, "energy") + (note.empty() ? "" : "; " + note);
}

/// A warp by its method and what it was asked for.
std::string warp_of(const Json& row) {
  return text(row, "method") + (row.contains("kappa")
                                    ? ", kappa " + figure(value(row, "kappa"))
                                    : ", points every " + figure(value(row, "spacing_px")) + " px");
}
std::string warp_outcome(const Json& row) {
  return figure(value(row, "gap_rms_px")) + " px, " + figure(100.0 * value(row, "folded_share")) +
         " %, " + figure(value(row, "rms_J")) + ", " + figure(1e3 * value(row, "seconds")) + " ms";
}

std::vector<Column> precision_columns() {
  return {kScene,
          word("method", "method"),
          kLattice,
          number("unknowns", "unknowns"),
          number("seconds", "seconds"),
          number("RMS error, px", "rms_px"),
          number("largest error, px", "max_px"),
          number("curve gap, RMS, px", "gap_rms_px"),
          number("largest gap, px", "gap_max_px"),
          number("folded cells", "folded"),
          kSteps,
          number("work units", "work_units"),
          kStatus};
}

std::vector<Column> solve_columns() {
  return {kScene,
          word("curves", "curves"),
          kLattice,
          kStatus,
          range("work units", "work_units"),
          number("a unit's product, of streaming", "product_of_streaming"),
          range("seconds", "seconds"),
          number("of them cutting", "cut_seconds"),
          kSteps,
          number("B/node", "bytes_per_node"),
          number("curve gap, px", "gap_rms_px"),
          number("discretisation error, px", "discretisation_px"),
          number("algebraic error, estimated share of it", "algebraic_share"),
          range("true share", "true_share"),
          number("gain of two threads", "threads_gain"),
          number("share of streaming's gain", "gain_share")};
}

}  // namespace

std::vector<Across> tables_across() {
  return {
      {"table1", "Table 1 again: the whole nonlinear solve of the stretchy sponge, seconds",
       "speed_bench table1, direct_bench, mesh_bench, amg_bench",
       "kappa/mu 1. Energy, curves, start and stopping rule (a tenth of the discretisation error "
       "in px) are the same in all runs of this machine, and cutting or meshing counts. The "
       "paper's figures are from its six-core processor of 2014, without a stated tolerance; its "
       "rival ran on a triangle mesh along the curves with about as many unknowns, as our "
       "triangle mesh does, the direct solvers named “same lattice” on drumhead's own equations. "
       "Assembling the matrix, which is not tuned, is left out of the seconds of direct solvers "
       "and algebraic multigrid on the same lattice, and counts for the triangle mesh. *: did not "
       "converge.",
       "table1", "seconds", with_threads, lattice_of, seconds_of},
      {"table1_memory", "Table 1 again: memory of the solver, MB",
       "speed_bench table1, direct_bench, mesh_bench, amg_bench",
       "One thread; more take hardly more. 1 MB is 10⁶ bytes. Of direct solvers their own count of "
       "the factorisation's peak; the "
       "matrix that is handed to them comes on top.",
       "table1", "MB", on_one_thread, lattice_of,
       [](const Json& row) { return figure(1e-6 * value(row, "bytes")); }},
      {"rates", "Work units for a factor of ten, one Newton system", "rates_bench",
       "Processor time in Hessian–vector products that each linear solver takes to reduce the "
       "residual by ten, over a reduction by 1000; in brackets cycles or iterations. *: given up "
       "after 60 cycles (iterations of MINRES: 1200 at 128², as many more as the lattice has cells "
       "a side; 300 with a preconditioner), or because the residual had grown tenfold; –: less "
       "than "
       "an eighth gained. Curves are hard (d 1e6, with q-jump) where no d is named; exact: 1/d = 0 "
       "without the jump, in double precision. On more than 128² all but gcr are asked for hard "
       "curves alone, on more than 512² gcr alone, to kappa/mu 100: the rest would take an hour.",
       "rates", "scene",
       [](const Json& row) {
         std::string name = lattice_of(row) + " " + kScene.cell(row);
         if (std::isfinite(value(row, "weight"))) name += ", d " + figure(value(row, "weight"));
         if (row.value("exact", false)) name += ", exact";
         return name;
       },
       [](const Json& row) { return text(row, "solver"); },
       [](const Json& row) {
         return figure(value(row, "work_units_per_digit")) +
                (row.value("converged", true) ? "" : "*") + " (" + figure(value(row, "cycles")) +
                ")";
       },
       true},
      {"stability", "Hard cases, by both ways to meet curves", "stability_bench",
       "The 31 cases of the study at 128² and constraints that are degenerate: status, Newton "
       "steps "
       "on the finest lattice, largest distance of a curve from its target in px (of 1000 for the "
       "study's; 0: less than 0.001), cells with a folded corner. *: not as expected, or more "
       "steps "
       "than the bound of the tests (ctest label stability).",
       "stability", "case (expected)",
       [](const Json& row) {
         return text(row, "group") + ": " + text(row, "case") + " (" + text(row, "expected") + ")";
       },
       [](const Json& row) { return text(row, "method"); }, outcome, true, true},
      {"study", "The 31 cases of the study: status, Newton steps, energy", "stability_bench",
       "Per mu and lattice area; steps on the finest lattice, in brackets those of all lattices "
       "and "
       "of the paths that lead to the first state. Beside each case the least energy that is known "
       "at 32² with exact rows: !: the only minimum that was found, elsewhere there are several. A "
       "finer lattice has less, rows that are not exact have less. *: exact rows that did not "
       "converge, or at 32² took a larger energy than that of the only minimum.",
       "study", "case (least energy known at 32²)",
       [](const Json& row) {
         return text(row, "case") + " (" + energy_of(row, "known") +
                (row.value("unique", false) ? "!)" : ")");
       },
       [](const Json& row) { return lattice_of(row) + " " + text(row, "method"); }, study_outcome,
       false, true},
      {"warps_short", "What people use instead, on the same scenes", "warps_bench",
       "Gap along the curves, RMS, px of 1000; share of the picture whose area is turned over; RMS "
       "of J − 1, how far areas are from being kept; time on one thread. All evaluated on 250² "
       "cells.",
       "warps", "gap, folded, RMS(J−1), time", warp_of,
       [](const Json& row) { return text(row, "scene"); }, warp_outcome, false, true},
  };
}

std::vector<List> lists() {
  return {
      {"precision", "Error against time, one thread", "speed_bench precision, speed_bench solvers",
       "Error at the lattice's nodes, in px of a picture of 1000 px: S2 against its exact radial "
       "solution, S1 and S4 against conforming solutions, on 1600² for lattices up to 400², with "
       "--large on 6400² (S1) and 3200² (S4) for lattices up to 1600². These are themselves wrong "
       "by "
       "some .02 px (S1) and .003 px (S4), of which the least errors may consist.",
       "work_precision", precision_columns()},
      {"tolerances",
       "Error against time over tolerances, roundabout at 400², kappa/mu 10",
       "speed_bench tolerances",
       "The tolerance bounds the algebraic error alone; what remains is the lattice's own.",
       "tolerances",
       {word("method", "method"), number("tolerance, px", "tolerance_px"),
        number("seconds", "seconds"), number("RMS error, px", "rms_px"),
        number("largest error, px", "max_px"), kSteps, kStatus}},
      {"solve", "Whole solves", "solve_bench",
       "To a tenth of the estimated discretisation error. Scenes moved by several offsets: work "
       "units, seconds (least–most), steps, cycles, true share (≤ its largest) are means over "
       "them, the rest is of one. The true share compares with a solve to a hundredth of the "
       "tolerance. A unit's product, of streaming: the Hessian–vector product beside a loop that "
       "moves its bytes alone, in turns; 1 is the speed of memory. Gains at 800² alone: seconds on "
       "one thread by those on two, of the solve, and that by the same of the streaming loop.",
       "solve", solve_columns()},
      {"growth",
       "Growth of a solve's work units from 800² to 3200²",
       "solve_bench --large",
       "Work units on 3200² by those on 800² at the same offset of the scene: mean (least–most).",
       "growth",
       {kScene, word("curves", "curves"), range("growth", "growth"), number("offsets", "offsets")}},
      {"direct",
       "The same Newton's method with sparse direct solvers, same lattice and equations",
       "direct_bench",
       "The ratio is the direct solver's analysis, factorisation and solution by drumhead's whole "
       "solve; the assembly, which is not tuned, is left out of it.",
       "direct",
       {kScene, word("method", "method"), kLattice, number("threads", "threads"),
        number("factorisations", "newton_all"),
        number("analyse, factorise, solve, s", "linear_seconds"),
        number("assemble, s", "assemble_seconds"), number("peak, MB", "bytes", 1e-6),
        number("B/node", "bytes_per_node"), number("drumhead, s", "our_seconds"),
        number("direct by drumhead", "ratio")}},
      {"mesh",
       "The same membrane on triangles along the curves, by a sparse direct solver",
       "mesh_bench",
       "A Delaunay mesh (CGAL) with about as many vertices as the lattice has nodes, pressures on "
       "the "
       "vertices' shares of either side, the same Newton's method. Seconds hold meshing, assembly "
       "and "
       "the solver.",
       "mesh",
       {kScene, word("method", "method"), kLattice, number("vertices, nodes", "nodes"),
        number("seconds", "seconds"), number("meshing", "mesh_seconds"),
        number("assembling", "assemble_seconds"), number("solver", "solve_seconds"),
        number("MB", "bytes", 1e-6), number("RMS error, px", "rms_px"),
        number("largest error, px", "max_px"), number("folded", "folded"), kStatus}},
      {"amg",
       "The lattice's systems by algebraic multigrid",
       "amg_bench",
       "MINRES with a V-cycle of PETSc's GAMG or hypre's BoomerAMG as preconditioner, in the same "
       "nested Newton iteration; assembly, which is not tuned, is left out of the seconds. At "
       "kappa/mu 100 GAMG stops at 200² and BoomerAMG at 100², the next lattice takes minutes.",
       "amg",
       {kScene, word("method", "method"), kLattice, number("seconds", "seconds"),
        number("set-up", "setup_seconds"), number("iterations", "iterate_seconds"),
        number("Newton steps, all lattices", "newton_all"), kSteps, number("MB", "bytes", 1e-6),
        number("B/node", "bytes_per_node"), number("from drumhead's solution, px", "difference_px"),
        number("RMS error, px", "rms_px"), kStatus}},
      {"curves",
       "Two ways to meet curves",
       "curves_bench",
       "Errors as in the table of error against time, S4 always against 1600². Default tolerance, "
       "one "
       "thread. "
       "A lattice on which the iteration starts has no estimate of its error.",
       "curves",
       {kScene, word("curves", "curves"), kLattice, number("RMS error, px", "rms_px"),
        number("largest, px", "max_px"), number("reported RMS, px", "discretisation_px"),
        number("folded cells", "folded"), kSteps, number("work units", "work_units"),
        number("ms", "seconds", 1e3), number("of them cutting", "cut_seconds", 1e3), kStatus}},
      {"reach",
       "Time to an error, two ways to meet curves",
       "curves_bench",
       "The fastest of the lattices of 32² to 800² (S4, without --large S1, too: 400²) that reach "
       "it, "
       "one "
       "thread.",
       "curves_reach",
       {kScene, word("curves", "curves"), number("RMS error, px", "target_px"),
        number("ms", "seconds", 1e3), number("on a lattice of", "n")}},
      {"share",
       "What the cells along curves add to a Hessian–vector product",
       "curves_bench",
       "Conforming curves, processor time.",
       "curves_share",
       {kScene, kLattice, number("special cells", "special_cells"),
        number("share, %", "share", 100.0)}},
      {"drag",
       "Going on from a solution: one control point moves by 5 px",
       "drag_bench",
       "256², kappa/mu 10, one thread, to half a pixel: circles of four segments, all cut anew or "
       "with what the solve before has kept, in turns. The whole call also looks for folds and "
       "measures curve gaps and a work unit.",
       "drag",
       {number("circles", "circles"),
        word("curves", "curves"),
        word("what moves", "moved"),
        {"kept", [](const Json& row) { return row.value("kept", false) ? "yes" : "no"; }, false},
        kStatus,
        kSteps,
        number("cutting, ms", "cut_seconds", 1e3),
        number("cutting and solving, ms", "seconds", 1e3),
        number("share of cutting, %", "cut_share", 100.0),
        number("whole call, ms", "call_seconds", 1e3),
        number("left, px", "left_px")},
       false},
      {"warps",
       "What people use instead, all that was measured",
       "warps_bench",
       "The gap is measured along the curves; folded: share of the picture whose area is turned "
       "over; RMS(J−1): how far areas are from being kept.",
       "warps",
       {kScene, word("method", "method"), number("points", "points"), number("cells", "n"),
        number("seconds", "seconds"), number("curve gap, RMS, px", "gap_rms_px"),
        number("largest gap, px", "gap_max_px"), number("folded, %", "folded_share", 100.0),
        number("RMS(J−1)", "rms_J")}},
      {"stability_all",
       "Hard cases, all that was measured",
       "stability_bench",
       "",
       "stability",
       {word("group", "group"),
        word("case", "case"),
        word("method", "method"),
        word("expected", "expected"),
        word("ended", "ended"),
        number("Newton steps", "newton"),
        number("bound", "bound"),
        number("energy", "energy"),
        number("largest gap, px", "gap_max_px"),
        number("inverted cells", "inverted"),
        number("folded cells", "folded"),
        {"as expected", [](const Json& row) { return words(row.value("passed", Json())); },
         false}}},
      {"masks",
       "Masked scenes: kappa and mu in a disc and outside",
       "masks_bench",
       "",
       "masks",
       {word("scene", "scene"), kLattice, number("kappa inside", "kappa_in"),
        number("outside", "kappa_out"), number("mu inside", "mu_in"), number("outside", "mu_out"),
        number("work units per digit", "work_units_per_digit"), kStatus, kSteps,
        number("work units", "work_units"), number("curve gap, px", "gap_rms_px")}},
      {"membranes",
       "Every membrane, 128², kappa 1",
       "membranes_bench",
       "",
       "membranes",
       {word("model", "model"), word("scene", "scene"), word("curves", "curves"), kStatus,
        number("Newton steps, all levels", "newton_all"), kSteps,
        number("work units", "work_units"), number("seconds", "seconds"),
        number("product, ns per node", "product_ns"), number("B/node", "bytes_per_node"),
        number("discretisation error, px", "discretisation_px"),
        number("inverted cells", "inverted"), number("folded cells", "folded")}},
      {"eq8",
       "Eq. 8 as an inequality: scenes of many discs, eps .2",
       "membranes_bench",
       "",
       "eq8",
       {word("scene", "scene"), number("kappa", "kappa"), kLattice, word("curves", "curves"),
        kStatus, number("Newton steps, all levels", "newton_all"), kSteps,
        number("work units", "work_units"), number("seconds", "seconds"),
        number("B/node", "bytes_per_node"), number("most inverted on the way", "most_inverted"),
        number("folded at the end", "folded"), number("least corner J", "least_corner_J"),
        word("inverted cells after each Newton step", "inverted_after_steps")}},
      {"fold_free",
       "Folded cells of crpm and two remedies, eps .2",
       "membranes_bench",
       "The change is that of the nodes against crpm with averaged rows, in px of a picture of "
       "1000 px.",
       "fold_free",
       {kScene, word("model", "model"), word("curves", "curves"), kLattice, kStatus,
        number("folded cells", "folded"), number("least corner J", "least_corner_J"),
        number("curve gap, RMS, px", "gap_rms_px"), number("largest gap, px", "gap_max_px"),
        number("RMS change, px", "change_px"), kSteps, number("work units", "work_units"),
        number("seconds", "seconds"), number("B/node", "bytes_per_node")}},
      {"kernels",
       "Kernels beside streaming loops",
       "kernels_bench",
       "Of streaming: the time of a loop that moves the same bytes by the kernel's time, in turns "
       "with it, median of pairs; 1 is the speed of memory.",
       "kernels",
       {word("kernel", "kernel"), kLattice, word("memory", "memory"), word("instructions", "isa"),
        number("threads", "threads"), number("ns/node", "ns"), number("B/node", "bytes_per_node"),
        number("of streaming", "ratio"), number("products", "work_units"),
        number("gain of threads", "gain"), number("streaming's gain", "stream_gain"),
        number("by our product", "against")}},
      {"resample",
       "Resampler beside other samplers, one thread",
       "resample_bench",
       "PSNR against 16 × 16 samples a pixel.",
       "resample",
       {word("warp", "warp"), word("sampler", "sampler"), word("filter", "filter"),
        number("PSNR, dB", "psnr_db"), number("Mpixel/s", "megapixels_per_second"),
        number("time by ours", "by_ours")}},
  };
}

}  // namespace drumhead::bench
