// SPDX-License-Identifier: MIT
#pragma once
// Everything a run of `drumhead warp` can be told, and the one table of keys from which the command
// line, the scene file, the help text and the error messages are all made: a flag --cell-size and a
// scene's key cell_size are the same entry, with the same bound.
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <drumhead/grid/lattice.h>
#include <drumhead/grid/mask.h>
#include <drumhead/grid/material.h>
#include <drumhead/kernels/resample.h>
#include <drumhead/multigrid/warp.h>

#include "maps.h"

namespace drumhead::driver {

/// What a scene says about single curves ([[curve]]).
struct CurveOverride {
  std::string name;              ///< as in the drawing
  std::optional<double> weight;  ///< in units of mu per longer picture side, > 0, infinity allowed
  std::optional<double> turn_degrees;  ///< clockwise on the screen
  std::string place;                   ///< file and line, for errors
};

/// A grey picture for a coefficient; nothing: as its key's fallback says.
struct MaskOptions {
  std::filesystem::path file;          ///< empty: the coefficient is constant
  std::optional<double> black, white;  ///< factors of mu; kappa in units of mu
  std::optional<grid::MaskScale> scale;
};

struct Options {
  std::filesystem::path scene;    ///< the scene file, where there is one
  std::filesystem::path picture;  ///< read by OpenImageIO, or .svg, which is rasterised
  std::filesystem::path curves;  ///< SVG; the picture itself where that is an SVG and this is empty
  std::filesystem::path plate;   ///< under the warped picture; empty: nothing
  std::filesystem::path start;   ///< a lattice to go on from; empty: from the beginning
  std::filesystem::path output, report;  ///< empty: not written, as the next
  std::filesystem::path overlay, checkerboard, jacobian, page;
  kernels::Border border = kernels::Border::clamp;  ///< beyond the picture
  bool expand = false;        ///< the whole padded domain is rendered, not only the picture
  bool linear_light = false;  ///< integer pictures are decoded from sRGB before they are filtered
  std::filesystem::path backward_map, forward_map, lattice_file, lattice_cells, lattice_vtk;
  MapConvention map_convention = MapConvention::st;
  grid::LatticeOptions lattice;
  kernels::Model model = kernels::Model::crpm;
  double mu = grid::Material{}.mu;
  std::optional<double> eps;              ///< arap, fold-free
  double kappa = grid::Material{}.kappa;  ///< in units of mu
  MaskOptions mu_mask, kappa_mask;
  double weight = std::numeric_limits<double>::infinity();  ///< of every curve without its own
  bool exact = false;
  multigrid::Solver solver = multigrid::Solver::gcr;
  multigrid::CurveMethod curve_method = multigrid::CurveMethod::automatic;
  double tolerance_px = 0.0;  ///< 0: a tenth of the estimated discretisation error
  int threads = 0;            ///< 0: as OpenMP decides
  bool quiet = false;
  std::vector<CurveOverride> overrides;
};

/// Every file that a run may write.
inline constexpr std::array kOutputFiles = {
    &Options::output,       &Options::report,        &Options::overlay,      &Options::checkerboard,
    &Options::jacobian,     &Options::page,          &Options::backward_map, &Options::forward_map,
    &Options::lattice_file, &Options::lattice_cells, &Options::lattice_vtk};

/// A key's value as the scene's or the command line's syntax gives it.
using Value = std::variant<bool, std::int64_t, double, std::string>;

struct Key {
  std::string_view name;   ///< in a scene; its flag is --name with - for _
  std::string_view value;  ///< what follows the flag, for the help; empty: a switch
  std::string_view bound;  ///< completes "must be …" in errors and stands in the help
  std::string_view help;
  std::string_view fallback = {};                     ///< as the help names it
  bool (*set)(const Value& value, Options& options);  ///< false: outside the bound
  bool flag = true;                                   ///< false: positional on the command line
  bool path = false;  ///< a scene's value is relative to the scene file
};

/// All keys, in the order of the help.
std::span<const Key> keys();

/// nullptr if there is no such key.
const Key* find_key(std::string_view name);

/// Whether a file's name ends in `extension` (".svg"), in small letters or capitals.
bool has_extension(const std::filesystem::path& file, std::string_view extension);

/// "--cell-size" for cell_size.
std::string flag_name(const Key& key);

/// The text after a flag as the value that the key may take: a number where it is one (inf and nan
/// count), else the text itself.
Value value_of(const Key& key, const std::string& text);

/// Sets a key. Throws std::invalid_argument "`place`: must be `bound`".
void set(const Key& key, const Value& value, const std::string& place, Options& options);

/// A weight as the scene's curve tables take it; nothing if it is outside the bound.
std::optional<double> weight_of(const Value& value);

/// A finite number; nothing otherwise.
std::optional<double> finite_number(const Value& value);

}  // namespace drumhead::driver
