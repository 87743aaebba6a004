// SPDX-License-Identifier: MIT
#include "truth.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "solution_values.h"
#include "support/radial_reference.h"
#include "support/scene_problem.h"

namespace drumhead::bench {
namespace {

constexpr double kInner = .22, kOuter = .40;  // the roundabout's circles

/// Displacements of the exact roundabout, turned by 90°, at the nodes of the n × n lattice.
void fill_exact(double kappa, int n, std::vector<double>& u, std::vector<double>& v) {
  const double offset = scenes::kStudyOffset;
  const std::complex<double> centre(.5 + offset, .5 + .7 * offset);
  const oracle::RadialReference exact(kInner, kOuter, std::acos(0.0), kappa);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const std::complex<double> rest(double(i) / n, double(j) / n);
      const std::complex<double> moved = centre + exact.at(rest - centre) - rest;
      u.push_back(moved.real());
      v.push_back(moved.imag());
    }
}

constexpr std::size_t kNodes = std::size_t(Truth::kFinest + 1) * (Truth::kFinest + 1);

/// Whether the file was there.
bool read(const std::string& file, std::vector<double>& u, std::vector<double>& v) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return false;
  for (std::vector<double>* field : {&u, &v}) {
    field->resize(kNodes);
    stream.read(reinterpret_cast<char*>(field->data()), std::streamsize(8 * kNodes));
  }
  if (!stream || stream.peek() != std::ifstream::traits_type::eof())
    throw std::runtime_error(file + ": not a reference, remove it");
  return true;
}

void write(const std::string& file, const std::vector<double>& u, const std::vector<double>& v) {
  std::ofstream stream(file + ".part", std::ios::binary);
  for (const std::vector<double>* field : {&u, &v})
    stream.write(reinterpret_cast<const char*>(field->data()), std::streamsize(8 * kNodes));
  stream.close();
  if (!stream) throw std::runtime_error(file + ": cannot be written");
  std::filesystem::rename(file + ".part", file);
}

}  // namespace

/// The algebraic error as a share of the picture: single precision does not hold much less there.
struct Truth::Reference {
  int cells;
  double tolerance;
};

std::string truth_folder(int argc, char** argv) {
  for (int k = 1; k + 1 < argc; ++k)
    if (std::string_view(argv[k]) == "--truth") return argv[k + 1];
  return {};
}

Truth::Truth(const scenes::Scene& scene, double kappa, const std::string& folder)
    : most_cells_(kFinest) {
  if (scene.name.starts_with("S2")) {
    fill_exact(kappa, kFinest, u_, v_);
    return;
  }
  if (folder.empty()) {
    solve(scene, kappa, {kFinest, 3e-6});
    most_cells_ = kFinest / 4;
    return;
  }
  char name[64];
  std::snprintf(name, sizeof name, "/%s_kappa_%g", scene.name.c_str(), kappa);
  if (read(folder + name, u_, v_)) return;
  solve(scene, kappa, scene.name.starts_with("S1") ? Reference{6400, 2e-5} : Reference{3200, 3e-6});
  write(folder + name, u_, v_);
}

void Truth::solve(const scenes::Scene& scene, double kappa, const Reference& reference) {
  const multigrid::Solution solution = multigrid::solve(
      scenes::problem(scene, reference.cells, kappa),
      {.curve_method = multigrid::CurveMethod::conforming, .tolerance_px = reference.tolerance});
  if (solution.report.status != multigrid::Status::converged)
    throw std::runtime_error("the reference of " + scene.name + " ends with " +
                             multigrid::name(solution.report.status));
  const std::size_t row = std::size_t(reference.cells) + 1;
  const auto stride = std::size_t(reference.cells / kFinest);
  for (std::size_t j = 0; j <= kFinest; ++j)
    for (std::size_t i = 0; i <= kFinest; ++i) {
      u_.push_back(solution.u_px[stride * (j * row + i)]);
      v_.push_back(solution.v_px[stride * (j * row + i)]);
    }
}

Truth::Error Truth::error(int n, std::span<const double> u, std::span<const double> v) const {
  if (n < 1 || kFinest % n != 0)
    throw std::invalid_argument("n " + std::to_string(n) + ": must divide " +
                                std::to_string(kFinest));
  const std::size_t stride = kFinest / n;
  Error error;
  double squares = 0.0;
  for (std::size_t j = 0; j <= std::size_t(n); ++j)
    for (std::size_t i = 0; i <= std::size_t(n); ++i) {
      const std::size_t here = j * std::size_t(n + 1) + i;
      const std::size_t fine = (j * (kFinest + 1) + i) * stride;
      const double miss = kPicture * std::hypot(u[here] - u_[fine], v[here] - v_[fine]);
      squares += miss * miss;
      error.max_px = std::max(error.max_px, miss);
    }
  error.rms_px = std::sqrt(squares) / (n + 1);
  return error;
}

std::array<double, 2> Truth::at(double x, double y) const {
  const auto cell = [](double along) { return std::clamp(int(along * kFinest), 0, kFinest - 1); };
  const int i = cell(x), j = cell(y);
  const double s = x * kFinest - i, t = y * kFinest - j;
  const auto blend = [&](const std::vector<double>& field) {
    const double* lower = &field[std::size_t(j) * (kFinest + 1) + std::size_t(i)];
    const double* upper = lower + kFinest + 1;
    return (1 - t) * ((1 - s) * lower[0] + s * lower[1]) + t * ((1 - s) * upper[0] + s * upper[1]);
  };
  return {x + blend(u_), y + blend(v_)};
}

}  // namespace drumhead::bench
