// SPDX-License-Identifier: MIT
#include "start_lattice.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

#include "image.h"
#include "lattice_files.h"

namespace drumhead::driver {

multigrid::Solution read_start(const std::filesystem::path& file, const grid::Lattice& lattice) {
  const auto refuse = [&](const std::string& reason) {
    throw std::invalid_argument(file.string() + ": " + reason);
  };
  const auto size = [](int columns, int rows) {
    return std::to_string(columns) + " x " + std::to_string(rows);
  };
  const Image image = read_image(file);
  const int u = image.spec.channelindex("u"), v = image.spec.channelindex("v");
  if (u < 0 || v < 0) refuse("must have the channels u and v of a file that --lattice wrote");
  if (image.width() != lattice.nx + 1 || image.height() != lattice.ny + 1)
    refuse(size(image.width(), image.height()) + " nodes: must be those of the scene's lattice, " +
           size(lattice.nx + 1, lattice.ny + 1));
  multigrid::Solution start{.lattice = lattice};
  for (std::size_t node = 0; node < lattice.nodes(); ++node) {
    const float* const value = &image.pixels[node * std::size_t(image.channels())];
    if (!std::isfinite(value[u]) || !std::isfinite(value[v])) refuse("a value is not finite");
    start.u_px.push_back(double(value[u]));
    start.v_px.push_back(double(value[v]));
  }
  start.report.discretisation_rms_px =
      std::atof(std::string(image.spec.get_string_attribute(kLatticeError, "nan")).c_str());
  start.report.discretisation_max_px = std::numeric_limits<double>::quiet_NaN();
  const auto method =
      multigrid::curve_method_named(std::string(image.spec.get_string_attribute(kLatticeCurves)));
  start.report.curve_method = method.value_or(multigrid::CurveMethod::averaged);
  return start;
}

}  // namespace drumhead::driver
