// SPDX-License-Identifier: MIT
#include "random_fields.h"

#include <algorithm>
#include <cmath>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#endif

namespace drumhead::fields {
namespace {

// Elements of NaN on either side of a guarded half row; odd, so that no row is aligned.
constexpr int kGuard = 7;
constexpr double kStep = 4096.0;

template <class T>
void guard([[maybe_unused]] const T* begin, [[maybe_unused]] std::ptrdiff_t count) {
#if defined(__SANITIZE_ADDRESS__)
  ASAN_POISON_MEMORY_REGION(begin, std::size_t(count) * sizeof(T));
#endif
}

template <class T>
void append(const OwnedPlane<T>& plane, std::vector<T>& out) {
  const std::vector<T> values = plane.values();
  out.insert(out.end(), values.begin(), values.end());
}

bool fixed(int i, int j, int nx, int ny) { return i == 0 || j == 0 || i == nx || j == ny; }

}  // namespace

double Random::number(double low, double high) {
  return double(whole(int(std::ceil(low * kStep)), int(std::floor(high * kStep)))) / kStep;
}

// Not std::uniform_int_distribution, whose numbers depend on the library.
int Random::whole(int low, int high) { return low + int(bits_() % unsigned(high - low + 1)); }

template <class T>
OwnedPlane<T>::OwnedPlane(int columns, int rows, Layout layout) {
  const int pad = layout == Layout::guarded ? kGuard : 0;
  const int even = (columns + 1) / 2, odd = columns / 2;
  plane_.columns = columns;
  plane_.rows = rows;
  plane_.odd = even + pad;
  plane_.stride = plane_.odd + odd + pad;
  const T outside = std::numeric_limits<T>::quiet_NaN();
  storage_.assign(std::size_t(pad + plane_.stride * rows), outside);
  plane_.data = storage_.data() + pad;
  set([](int, int) { return T(0); });
  if (pad == 0) return;
  guard(storage_.data(), pad);
  for (int j = 0; j < rows; ++j) {
    guard(plane_.half(j, 0) + even, pad);
    guard(plane_.half(j, 1) + odd, pad);
  }
}

template <class T>
std::vector<T> OwnedPlane<T>::values() const {
  std::vector<T> all;
  all.reserve(std::size_t(plane_.columns) * std::size_t(plane_.rows));
  for (int j = 0; j < plane_.rows; ++j)
    for (int i = 0; i < plane_.columns; ++i) all.push_back(plane_.at(i, j));
  return all;
}

template <class T>
void OwnedPlane<T>::fill(Random& random, double low, double high) {
  set([&](int, int) { return random.number(low, high); });
}

template <class T>
void OwnedPlane<T>::set_boundary(T value) {
  set([&](int i, int j) {
    return fixed(i, j, plane_.columns - 1, plane_.rows - 1) ? value : plane_.at(i, j);
  });
}

template <class T>
OwnedUnknowns<T>::OwnedUnknowns(int nx, int ny, bool pressure, Layout layout)
    : x(nx + 1, ny + 1, layout), y(nx + 1, ny + 1, layout) {
  if (pressure) p = OwnedPlane<T>(nx, ny, layout);
}

template <class T>
void OwnedUnknowns<T>::fill(Random& random) {
  for (OwnedPlane<T>* plane : {&x, &y}) {
    plane->fill(random, -1.0, 1.0);
    plane->set_boundary(T(0));
  }
  p.fill(random, -1.0, 1.0);
}

template <class T>
std::vector<T> OwnedUnknowns<T>::values() const {
  std::vector<T> all;
  for (const OwnedPlane<T>* plane : {&x, &y, &p}) append(*plane, all);
  return all;
}

template <class T>
RandomCuts<T>::RandomCuts(const LevelSpec& spec, Random& random) : jump(T(spec.jump)) {
  std::vector<int> cells;
  cells.reserve(std::size_t(spec.cuts));
  for (int n = 0; n < spec.cuts; ++n) cells.push_back(random.whole(0, spec.nx * spec.ny - 1));
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  for (const int cell : cells) add(spec, random, cell % spec.nx, cell / spec.nx);
  row_begin.assign(std::size_t(spec.ny) + 1, 0);
  for (const int j : row) ++row_begin[std::size_t(j) + 1];
  for (std::size_t j = 0; j < std::size_t(spec.ny); ++j) row_begin[j + 1] += row_begin[j];
  join(random);
}

// The weights of one point of the cell stand for the mean over an arc.
template <class T>
void RandomCuts<T>::add(const LevelSpec& spec, Random& random, int i, int j) {
  const double s = random.number(0.125, 0.875), t = random.number(0.125, 0.875);
  const double len = random.number(0.125, 1.25) * spec.spacing;
  bool any = false;
  for (int n = 0; n < 4; ++n) {
    const bool held = fixed(i + (n & 1), j + (n >> 1), spec.nx, spec.ny);
    const double w = ((n & 1) ? s : 1.0 - s) * ((n >> 1) ? t : 1.0 - t);
    weight.push_back(held ? T(0) : T(w));
    any = any || !held;
  }
  if (!any) return weight.resize(weight.size() - 4);
  column.push_back(i);
  row.push_back(j);
  length.push_back(T(len));
  compliance.push_back(std::isinf(spec.stiffness) ? T(0) : T(1.0 / (spec.stiffness * len)));
}

template <class T>
void RandomCuts<T>::join(Random& random) {
  const std::size_t count = column.size();
  std::vector<std::vector<int>> links(count);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = k + 1; l < count && row[l] - row[k] <= 1; ++l) {
      if (std::abs(column[k] - column[l]) > 1) continue;
      if (random.whole(0, 2) == 0) continue;
      links[k].push_back(int(l));
      links[l].push_back(int(k));
    }
  link_begin.push_back(0);
  for (std::size_t k = 0; k < count; ++k) {
    T diagonal = T(0);
    for (const int l : links[k]) {
      const T own = length[k], other = length[std::size_t(l)], shorter = std::min(own, other);
      link.push_back(l);
      strength.push_back(shorter * shorter / (own * other));
      diagonal += shorter * shorter / (own * own);
    }
    link_diagonal.push_back(diagonal);
    link_begin.push_back(int(link.size()));
  }
}

template <class T>
kernels::Cuts<T> RandomCuts<T>::view() const {
  return {.count = size(),
          .row_begin = row_begin.data(),
          .column = column.data(),
          .weight = weight.data(),
          .compliance = compliance.data(),
          .length = length.data(),
          .link_diagonal = link_diagonal.data(),
          .link_begin = link_begin.data(),
          .link = link.data(),
          .link_strength = strength.data(),
          .jump = jump};
}

template <class T>
RandomLevel<T>::RandomLevel(const LevelSpec& wanted)
    : spec(wanted),
      random(wanted.seed),
      ux(spec.nx + 1, spec.ny + 1, spec.layout),
      uy(spec.nx + 1, spec.ny + 1, spec.layout),
      d(spec.nx, spec.ny, spec.pressure, spec.layout),
      f(spec.nx, spec.ny, spec.pressure, spec.layout),
      cuts(spec, random) {
  ux.fill(random, -0.3 * spec.spacing, 0.3 * spec.spacing);
  uy.fill(random, -0.3 * spec.spacing, 0.3 * spec.spacing);
  d.fill(random);
  f.fill(random);
  if (spec.pressure) {
    pressure = OwnedPlane<T>(spec.nx, spec.ny, spec.layout);
    pressure.fill(random, -2.0, 2.0);
  }
  if (spec.mu_cells) {
    mu = OwnedPlane<T>(spec.nx, spec.ny, spec.layout);
    mu.fill(random, 0.5, 3.0);
    inverse_diagonal = OwnedPlane<T>(spec.nx + 1, spec.ny + 1, spec.layout);
    const kernels::Plane<T> m = mu.view();
    inverse_diagonal.set([&](int i, int j) {
      if (fixed(i, j, spec.nx, spec.ny)) return T(0);
      return T(1) / ((m.at(i - 1, j - 1) + m.at(i, j - 1)) + (m.at(i - 1, j) + m.at(i, j)));
    });
  }
  if (spec.kappa == Kappa::infinite) compliance_value = T(0);
  if (spec.kappa == Kappa::cells) {
    // Some incompressible, some soft, and some stiffer than the cap of the merit function.
    const double choices[] = {0.0, 0.001953125, 0.25, 1.0, 8.0};
    compliance = OwnedPlane<T>(spec.nx, spec.ny, spec.layout);
    compliance.set([&](int, int) { return choices[random.whole(0, 4)]; });
  }
  for (int n = 0; n < 2 * cuts.size(); ++n) {
    dq.push_back(T(random.number(-1.0, 1.0)));
    fq.push_back(T(random.number(-1.0, 1.0)));
  }
}

template <class T>
kernels::Membrane<T> RandomLevel<T>::membrane() const {
  kernels::Membrane<T> m;
  m.ux = ux.view();
  m.uy = uy.view();
  m.pressure = pressure.view();
  m.spacing = T(spec.spacing);
  m.mu = {mu_value, mu.view()};
  m.compliance = {compliance_value, compliance.view()};
  m.inverse_diagonal = inverse_diagonal.view();
  m.clamp_centre = clamp_centre;
  m.clamp_width = clamp_width;
  m.pressure_jump = T(spec.pressure_jump);
  return m;
}

template <class T>
kernels::LevelSystem<T> RandomLevel<T>::system() {
  return {.membrane = membrane(),
          .cuts = cuts.view(),
          .d = d.view(),
          .f = f.view(),
          .dq = dq.data(),
          .fq = fq.data()};
}

std::vector<LevelSpec> membranes() {
  std::vector<LevelSpec> specs;
  for (const bool mu_cells : {false, true}) {
    specs.push_back({.pressure = false, .mu_cells = mu_cells});
    for (const Kappa kappa : {Kappa::constant, Kappa::cells, Kappa::infinite})
      specs.push_back({.pressure = true, .mu_cells = mu_cells, .kappa = kappa});
  }
  return specs;
}

template class OwnedPlane<float>;
template class OwnedPlane<double>;
template struct OwnedUnknowns<float>;
template struct OwnedUnknowns<double>;
template struct RandomCuts<float>;
template struct RandomCuts<double>;
template struct RandomLevel<float>;
template struct RandomLevel<double>;

}  // namespace drumhead::fields
