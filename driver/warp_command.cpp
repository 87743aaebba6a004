// SPDX-License-Identifier: MIT
#include "warp_command.h"

#include <drumhead/kernels/isa.h>
#include <drumhead/multigrid/warp.h>
#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "atomic_file.h"
#include "command_line.h"
#include "curve_settings.h"
#include "image.h"
#include "interrupt.h"
#include "lattice_files.h"
#include "masks.h"
#include "page.h"
#include "pictures.h"
#include "plate.h"
#include "progress.h"
#include "render.h"
#include "report.h"
#include "start_lattice.h"
#include "stopwatch.h"
#include "svg_curves.h"
#include "svg_picture.h"

namespace drumhead::driver {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::weakly_canonical(fs::absolute(a), error) ==
             fs::weakly_canonical(fs::absolute(b), error) ||
         fs::equivalent(a, b, error);
}

std::vector<fs::path> outputs_of(const Options& options) {
  std::vector<fs::path> outputs;
  for (const auto file : kOutputFiles) {
    if (!(options.*file).empty()) outputs.push_back(options.*file);
  }
  return outputs;
}

void check_files(Options& options) {
  if (options.picture.empty())
    throw std::invalid_argument(options.scene.string() + ": the scene names no picture");
  if (options.curves.empty() && has_extension(options.picture, ".svg"))
    options.curves = options.picture;
  if (options.curves.empty()) {
    throw std::invalid_argument(options.picture.string() + ": no CURVES.svg was given for it");
  }
  const auto outputs = outputs_of(options);
  if (outputs.empty()) {
    throw std::invalid_argument(
        "no output: give -o OUT or another file to write (see drumhead --help)");
  }
  for (auto file = outputs.begin(); file != outputs.end(); ++file) {
    for (const fs::path& input : {options.picture, options.curves, options.plate, options.scene,
                                  options.mu_mask.file, options.kappa_mask.file, options.start}) {
      if (!input.empty() && same_file(*file, input)) {
        throw std::invalid_argument(file->string() + ": an output must not replace an input");
      }
    }
    if (std::any_of(outputs.begin(), file,
                    [&](const fs::path& f) { return same_file(f, *file); })) {
      throw std::invalid_argument(file->string() + ": two outputs must not be the same file");
    }
  }
  if (!options.output.empty()) check_writable_format(options.output);
}

multigrid::WarpProblem problem_of(const Options& options, const Image& picture,
                                  const std::vector<SvgCurve>& curves) {
  multigrid::WarpProblem problem;
  problem.lattice = grid::make_lattice(picture.width(), picture.height(), options.lattice);
  problem.material.mu = options.mu;
  problem.material.kappa = options.model == kernels::Model::harmonic ? 0.0 : options.kappa;
  problem.material.model = options.model;
  if (options.eps && options.model != kernels::Model::arap &&
      options.model != kernels::Model::fold_free)
    throw std::invalid_argument("eps: only the models arap and fold-free have one");
  problem.material.eps = options.eps.value_or(problem.material.eps);
  apply_masks(options, picture.width(), picture.height(), problem.lattice, problem.material);
  grid::check(problem.material, problem.lattice);
  check_inside(problem.lattice, curves);
  problem.curves = apply_settings(options, curves);
  return problem;
}

/// The solution to go on from, if one was named.
std::optional<multigrid::Solution> start_of(const Options& options, const grid::Lattice& lattice) {
  if (options.start.empty()) return {};
  if (options.exact) throw std::invalid_argument("start: not with exact curves");
  multigrid::Solution start = read_start(options.start, lattice);
  if (!(start.report.discretisation_rms_px > 0.0) && options.tolerance_px == 0.0)
    throw std::invalid_argument(options.start.string() +
                                ": its error is not known, so a tolerance must be given");
  return start;
}

/// The outputs that were asked for, as empty temporary files until `commit`.
class Outputs {
 public:
  explicit Outputs(const Options& options) {
    for (const fs::path& file : outputs_of(options)) files_.emplace(file, file);
  }
  /// Where to write what shall become `file`.
  const fs::path& operator[](const fs::path& file) const { return files_.at(file).temporary(); }
  /// The same, empty for a file that was not asked for.
  fs::path wanted(const fs::path& file) const { return file.empty() ? file : (*this)[file]; }
  void commit() {
    for (auto& [path, file] : files_) file.commit();
  }

 private:
  std::map<fs::path, AtomicFile> files_;
};

void write_lattice_files(const Options& options, const multigrid::Solution& solution,
                         const Outputs& outputs) {
  if (!options.lattice_file.empty()) write_lattice(solution, outputs[options.lattice_file]);
  if (!options.lattice_cells.empty()) write_lattice_cells(solution, outputs[options.lattice_cells]);
  if (const fs::path& file = options.lattice_vtk; !file.empty())
    has_extension(file, ".vtu") ? write_lattice_vtu(solution, outputs[file])
                                : write_lattice_vtk(solution, outputs[file]);
}

/// What the report says of the maps; nothing if none was asked for, or no report.
std::optional<MapReport> write_maps(const Options& options, const Image& picture,
                                    const Frame& frame, const multigrid::Solution& solution,
                                    const Outputs& outputs, Progress& progress) {
  const kernels::LatticeMapView map = map_of(solution);
  const int threads = options.threads;
  const MapFormat format{options.map_convention, picture.width(), picture.height(), frame};
  const auto in_phase = [&](const std::string& phase) -> MapProgress {
    progress.show(phase, 0.0);
    return [&progress, phase](double done) { progress.show(phase, done); };
  };
  if (const fs::path& file = options.backward_map; !file.empty()) {
    write_backward_map(map, format, threads, outputs[file], in_phase("writing " + file.string()));
  }
  if (const fs::path& file = options.forward_map; !file.empty()) {
    write_forward_map(map, format, threads, outputs[file], in_phase("writing " + file.string()));
  }
  const bool none = options.backward_map.empty() && options.forward_map.empty();
  if (none || options.report.empty()) return {};
  return MapReport{format, round_trip(map, format, threads, in_phase("map round trip"))};
}

Image read_picture(const Options& options, Progress& progress) {
  const std::string phase = "reading " + options.picture.string();
  progress.show(phase, 0.0);
  const ReadOptions read{.linear_light = options.linear_light,
                         .need_alpha = options.border == kernels::Border::transparent,
                         .progress = [&](double done) { progress.show(phase, done); }};
  return has_extension(options.picture, ".svg") ? rasterise(options.picture, read)
                                                : read_image(options.picture, read);
}

void replace_not_finite(Image& image, const fs::path& file, Progress& progress) {
  if (const std::size_t count = make_finite(image); count > 0)
    progress.warn(file.string() + ": " + std::to_string(count) +
                  " values are not finite: NaN was taken as 0, infinity as 65504");
}

multigrid::Solution solve(const Options& options, const multigrid::WarpProblem& problem,
                          const std::optional<multigrid::Solution>& start, Progress& progress) {
  multigrid::SolverOptions solver{.solver = options.solver,
                                  .curve_method = options.curve_method,
                                  .exact = options.exact,
                                  .tolerance_px = options.tolerance_px,
                                  .start = start ? &*start : nullptr,
                                  .threads = options.threads,
                                  .progress = {}};
  const SolveInterrupt interrupt;
  solver.progress = [&](const multigrid::Progress& at) {
    progress.show(at);
    return !interrupt.asked();
  };
  progress.show("cutting " + std::to_string(problem.curves.size()) + " curves");
  multigrid::Solution solution = multigrid::solve(problem, solver);
  if (start && solution.report.levels.size() > 1)
    progress.warn(options.start.string() +
                  ": no start for this scene, which was solved from the beginning");
  return solution;
}

}  // namespace

int run_warp(Options options) {
  Stopwatch watch, whole;
  Seconds seconds;
  Progress progress(options.quiet);
  if (const std::string_view error = kernels::forced_isa_error(); !error.empty())
    progress.warn(std::string(error));
  remove_temporaries_on_signals();
  check_files(options);
  Outputs outputs(options);

  Image picture = read_picture(options, progress);
  replace_not_finite(picture, options.picture, progress);
  std::optional<Image> plate;
  if (!options.plate.empty()) plate = read_plate(options.plate, picture);
  if (plate) replace_not_finite(*plate, options.plate, progress);
  const std::vector<SvgCurve> curves =
      read_curves(SvgDocument(options.curves), picture.width(), picture.height(),
                  [&](const std::string& warning) { progress.warn(warning); });
  const multigrid::WarpProblem problem = problem_of(options, picture, curves);
  const std::optional<multigrid::Solution> start = start_of(options, problem.lattice);
  const Frame frame = frame_of(picture, problem.lattice, options.expand);
  seconds.read = watch.lap();

  const multigrid::Solution solution = solve(options, problem, start, progress);
  seconds.cut = solution.report.cut_seconds;
  seconds.solve = solution.report.solve_seconds;
  watch.lap();

  PagePictures page;
  make_pictures({picture, solution, curves, frame, options.border, options.threads,
                 plate ? &*plate : nullptr},
                {.output = outputs.wanted(options.output),
                 .overlay = outputs.wanted(options.overlay),
                 .checkerboard = outputs.wanted(options.checkerboard),
                 .jacobian = outputs.wanted(options.jacobian)},
                options.page.empty() ? nullptr : &page, progress, seconds);
  watch.lap();

  progress.show("writing");
  write_lattice_files(options, solution, outputs);
  const auto maps = write_maps(options, picture, frame, solution, outputs, progress);
  seconds.write += watch.lap();
  seconds.total = whole.lap();
  const std::string report = report_json(solution, frame, seconds, maps);
  if (!options.report.empty()) write_text(report, outputs[options.report]);
  if (!options.page.empty()) {
    write_text(page_html(options.picture.filename(), report, page), outputs[options.page]);
  }
  outputs.commit();

  progress.summarise(solution, seconds);
  if (solution.report.status == multigrid::Status::converged) return kConverged;
  progress.warn(std::string(in_words(solution.report.status)) + "; the best result is written");
  return kNotConverged;
}

}  // namespace drumhead::driver
