// SPDX-License-Identifier: MIT
#include <drumhead/grid/material.h>

#include <drumhead/kernels/refuse.h>
#include <cmath>
#include <stdexcept>
#include <string>

namespace drumhead::grid {
namespace {

// Bounds of the isotropic membranes. fold-free: up to 100 the study's scenes converge on all
// lattices to 200²; at 300 S1 stalls with folds (128²), at 1000 steps take hundreds of cycles.
constexpr double kMostKappa = 1e6, kMostFoldFreeKappa = 100.0;

using kernels::refuse;

void check_size(const char* what, std::size_t size, const Lattice& lattice) {
  if (size != 0 && size != lattice.cells())
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(size) +
                                " values: must be empty or " + std::to_string(lattice.cells()) +
                                ", one per cell");
}

std::string cell_name(const char* what, std::size_t c, const Lattice& lattice) {
  const std::size_t nx = std::size_t(lattice.nx);
  return std::string(what) + " of cell (" + std::to_string(c % nx) + ", " + std::to_string(c / nx) +
         ")";
}

}  // namespace

void check(const Material& material, const Lattice& lattice) {
  if (!(material.mu > 0.0) || !std::isfinite(material.mu))
    refuse("mu", material.mu, "positive and finite");
  if (!(material.kappa >= 0.0)) refuse("kappa", material.kappa, "at least 0 (infinity allowed)");
  // The isotropic membranes have no pressures in which kappa could be infinite.
  const double most_kappa =
      material.model == kernels::Model::fold_free ? kMostFoldFreeKappa : kMostKappa;
  const char* const most =
      material.model == kernels::Model::fold_free ? "at most 100" : "at most 1e6";
  const bool bounded = kernels::isotropic(material.model);
  const std::string of = " of model " + std::string(kernels::name(material.model));
  if (bounded && !(material.kappa <= most_kappa)) refuse("kappa" + of, material.kappa, most);
  if (!(material.eps >= 0.0) || !(material.eps < 1.0))
    refuse("eps", material.eps, "at least 0 and below 1");
  check_size("mu_cells", material.mu_cells.size(), lattice);
  check_size("kappa_cells", material.kappa_cells.size(), lattice);
  for (std::size_t c = 0; c < material.mu_cells.size(); ++c) {
    const double mu = material.mu_cells[c];
    if (!(mu > 0.0) || !std::isfinite(mu))
      refuse(cell_name("mu factor", c, lattice), mu, "positive and finite");
  }
  for (std::size_t c = 0; c < material.kappa_cells.size(); ++c) {
    const double kappa = material.kappa_cells[c];
    if (!(kappa >= 0.0))
      refuse(cell_name("kappa", c, lattice), kappa, "at least 0 (infinity allowed)");
    if (bounded && !(kappa <= most_kappa)) refuse(cell_name("kappa", c, lattice) + of, kappa, most);
  }
}

double largest_stiffness(const Material& material) {
  const std::vector<float>&mu = material.mu_cells, &kappa = material.kappa_cells;
  if (mu.empty() && kappa.empty()) return material.kappa;
  double largest = 0.0;
  for (std::size_t c = 0; c < std::max(mu.size(), kappa.size()); ++c)
    largest = std::max(largest, (kappa.empty() ? material.kappa : double(kappa[c])) /
                                    (mu.empty() ? 1.0 : double(mu[c])));
  return largest;
}

}  // namespace drumhead::grid
