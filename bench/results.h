// SPDX-License-Identifier: MIT
#pragma once
// What the benchmarks measure, as JSON on standard output, which `report` reads:
//
//     {"program", "command", "date", "commit", "compiler", "processor", "processors", "load",
//      "rows": [{"table": "…", keys…, values…}, …]}
//
// A row is one flat object: first what was run (the keys), then what came out (the values). A name
// means the same in every table, and carries its unit. Infinity is the string "inf", a number that
// does not exist (NaN) null. Names that several programs share:
//
//     scene            "S1", "S2", "S4", … (tests/support/scenes.h); "S3 mask"
//     kappa            kappa/mu; left out where a mask gives it
//     n                cells across the picture's side
//     method           who solves: "drumhead, averaged", "drumhead, conforming", "MUMPS", …
//     solver           drumhead's linear solver by its name: "gcr", "kaczmarz", …
//     threads          of the run
//     status           "converged", …; a reason in words where nothing came out
//     seconds          of the whole solve, cutting or meshing included, wall clock
//     work_units       the same in Hessian–vector products of the finest lattice
//     …_least, …_most  of a value that is a mean, the range
//     bytes            the solver's memory at its peak;  bytes_per_node
//     unknowns         of the linear systems, where n does not tell
//     newton, cycles   Newton steps on the finest lattice, cycles (iterations) there
//     rms_px, max_px   error of the displacement, px of a picture of 1000 px, at the lattice's
//     nodes gap_rms_px, gap_max_px     between warped sources and targets discretisation_px error
//     that the report estimates, RMS algebraic_share            algebraic error left, as a share of
//     discretisation_px folded           cells (triangles, pixels) with J < 0 at a corner;
//     folded_share of all rms_J            RMS(J − 1) over the picture
//
// Tables and who writes them: bench/report_tables.cpp.
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace drumhead::bench {

using Json = nlohmann::ordered_json;

class Results {
 public:
  /// Prints the document's head: the program's name, its command line, the machine.
  Results(int argc, char** argv);
  /// Prints the document's end.
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// Prints a row, {{"scene", "S1"}, {"n", 100}, {"seconds", .25}}; on standard error also as one
  /// line in words where standard output is a file, to see how far the run is.
  void row(std::string_view table, const Json& values);

 private:
  std::string program_;
  bool first_ = true, progress_;
};

/// A row's value as people read it: numbers with three digits, "inf", "–" for null.
std::string words(const Json& value);

}  // namespace drumhead::bench
