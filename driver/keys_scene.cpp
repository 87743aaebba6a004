// SPDX-License-Identifier: MIT
#include <array>

#include "keys.h"

namespace drumhead::driver {
namespace {

constexpr int kMostCells = 16384;
constexpr int kMostThreads = 4096;

bool set_cells(const Value& value, Options& o) {
  if (!set_whole(value, kMostCells, o.lattice.cells)) return false;
  o.lattice.cell_px = 0.0;  // a flag --cells overrules the scene's cell_size
  return true;
}

bool set_margin(const Value& value, Options& o) {
  const auto x = finite_number(value);
  if (!x || *x < 0) return false;
  o.lattice.margin = *x;
  return true;
}

bool set_model(const Value& value, Options& o) {
  const auto* text = std::get_if<std::string>(&value);
  for (const kernels::ModelInfo& info : kernels::kModels) {
    if (!text || *text != info.name) continue;
    o.model = info.model;
    return true;
  }
  return false;
}

bool set_eps(const Value& value, Options& o) {
  const auto x = finite_number(value);
  if (!x || *x < 0 || *x >= 1) return false;
  o.eps = *x;
  return true;
}

bool set_kappa(const Value& value, Options& o) {
  const auto x = number(value);
  if (!x || *x < 0) return false;
  o.kappa = *x;
  return true;
}

bool set_weight(const Value& value, Options& o) {
  const auto x = weight_of(value);
  if (x) o.weight = *x;
  return x.has_value();
}

bool set_solver(const Value& value, Options& o) {
  const auto* text = std::get_if<std::string>(&value);
  const auto solver = text ? multigrid::solver_named(*text) : std::nullopt;
  if (solver) o.solver = *solver;
  return solver.has_value();
}

bool set_tolerance(const Value& value, Options& o) {
  if (const auto* text = std::get_if<std::string>(&value); text && *text == "auto") {
    o.tolerance_px = 0.0;
    return true;
  }
  return set_positive(value, o.tolerance_px);
}

bool set_curve_method(const Value& value, Options& o) {
  const auto* text = std::get_if<std::string>(&value);
  const auto method = text ? multigrid::curve_method_named(*text) : std::nullopt;
  if (method) o.curve_method = *method;
  return method.has_value();
}

const std::array kKeys = {
    Key{.name = "picture",
        .value = "",
        .bound = kAnyPath,
        .help = "PNG, JPEG, TIFF, EXR …, turned upright as its EXIF says; .svg is rasterised",
        .set = set_file<&Options::picture>,
        .flag = false,
        .path = true},
    Key{.name = "curves",
        .value = "",
        .bound = kAnyPath,
        .help = "SVG with the layers source, target and pin",
        .set = set_file<&Options::curves>,
        .flag = false,
        .path = true},
    Key{.name = "plate",
        .value = "FILE",
        .bound = kAnyPath,
        .help = "a clean plate: a picture of the same size that stands still under the warped one, "
                "which is a cut-out with alpha",
        .set = set_file<&Options::plate>,
        .path = true},
    Key{.name = "cells",
        .value = "N",
        .bound = "a whole number from 1 to 16384",
        .help = "cells across the longer side of the picture",
        .fallback = "256",
        .set = set_cells},
    Key{.name = "cell_size",
        .value = "PX",
        .bound = "a finite number above 0",
        .help = "side of a cell in picture pixels, instead of --cells",
        .set = [](const Value& v, Options& o) { return set_positive(v, o.lattice.cell_px); }},
    Key{.name = "margin",
        .value = "FRACTION",
        .bound = "a finite number, 0 or above",
        .help =
            "margin on every side, as a fraction of the longer side; 0 holds the picture's edge",
        .fallback = "0.1",
        .set = set_margin},
    Key{.name = "model",
        .value = "M",
        .bound = "one of: crpm, harmonic, arap, fold-free, corotated, linear, neohookean, stvk",
        .help = "membrane: crpm; harmonic, which is crpm with kappa 0; arap (as rigid as possible, "
                "kappa resists folds only); fold-free (crpm without folded cells); or an elastic "
                "body with mu and kappa as Lamé's moduli",
        .fallback = "crpm",
        .set = set_model},
    Key{.name = "mu",
        .value = "V",
        .bound = "a finite number above 0",
        .help = "stiffness, the unit of --kappa and --weight",
        .fallback = "1",
        .set = set_positive<&Options::mu>},
    Key{.name = "kappa",
        .value = "V",
        .bound = "a number, 0 or above, or inf",
        .help = "resistance to change of area, in units of mu; inf: incompressible (crpm; other "
                "models: at most 1e6, fold-free 100)",
        .fallback = "1",
        .set = set_kappa},
    Key{.name = "eps",
        .value = "V",
        .bound = "a number from 0 to below 1",
        .help = "arap, fold-free: the share of its area below which a cell resists",
        .fallback = "0.2",
        .set = set_eps},
    Key{.name = "weight",
        .value = "D",
        .bound = "a number above 0, or inf",
        .help =
            "stiffness of the curves per length, in units of mu per longer side of the picture; "
            "inf: they are met exactly, as pins always are",
        .fallback = "inf",
        .set = set_weight},
    Key{.name = "curve_method",
        .value = "NAME",
        .bound = "one of: auto, averaged, conforming",
        .help = "averaged: curves are met on average in each cell, an error of first order in the "
                "cell size; conforming: cells are divided along them, second order; "
                "auto: conforming for all models but stvk, those beside crpm up to kappa/mu 300, "
                "crpm with a weight other than inf up to 200",
        .fallback = "auto",
        .set = set_curve_method},
    Key{.name = "exact",
        .value = "",
        .bound = "true or false",
        .help = "no bound on kappa and weights, hard curves met to rounding, nodes settled to 1e-7 "
                "cells, in double precision; slower; auto means averaged curves then",
        .set = set_switch<&Options::exact>},
    Key{.name = "tolerance",
        .value = "PX",
        .bound = "a finite number above 0, or auto",
        .help = "error that the solver may leave, RMS in picture pixels; auto: a tenth of the "
                "lattice's own error",
        .fallback = "auto",
        .set = set_tolerance},
    Key{.name = "solver",
        .value = "NAME",
        .bound = "one of: gcr, kaczmarz, coloured-kaczmarz, minres, minres-multigrid",
        .help = "of the linear systems; all but gcr are there for comparison, and slower",
        .fallback = "gcr",
        .set = set_solver},
    Key{.name = "start",
        .value = "EXR",
        .bound = "the path of an .exr file",
        .help = "the file that --lattice wrote in an earlier run on the same lattice, to go on "
                "from where a curve was dragged a little or let go",
        .set = [](const Value& v, Options& o) { return set_path(v, ".exr", o.start); },
        .path = true},
    Key{.name = "threads",
        .value = "N",
        .bound = "a whole number from 1 to 4096",
        .help = "processor threads",
        .fallback = "as OpenMP decides",
        .set = [](const Value& v, Options& o) { return set_whole(v, kMostThreads, o.threads); }},
};

}  // namespace

std::span<const Key> scene_keys() { return kKeys; }

}  // namespace drumhead::driver
