// SPDX-License-Identifier: MIT
// The kernels alone, on memory of one's own: makes the right-hand side of a known correction with
// the operator, relaxes once from zero and sees how much of the residual is gone.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/planes.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/relax.h>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace drumhead::kernels;

constexpr int nx = 40, ny = 30;

using Values = std::vector<float>;  // one per node
Values zeros() { return Values((nx + 1) * (ny + 1)); }

/// The kernels keep a row's even columns side by side, then its odd ones.
struct Nodes {
  Values values = zeros();
  operator Plane<float>() { return plane_of(values.data(), nx + 1, ny + 1); }
};
struct Field {
  Nodes x, y;
  operator Unknowns<float>() { return {x, y, {}}; }
};

int main() {
  Field state, known, right, correction, residual;  // the state: a membrane at rest
  const Unknowns<float> d = known, f = right, r = residual;
  Values moved = zeros(), force = zeros();  // row after row, as a program of its own holds them
  const auto at = [](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) moved[at(i, j)] = float((7 * i + 3 * j) % 5 - 2);
  copy_from_rows(moved.data(), d.x);

  LevelSystem<float> level;
  level.membrane.ux = Plane<float>(state.x);
  level.membrane.uy = Plane<float>(state.y);
  apply_hessian<float>(level.membrane, d, f);
  copy_to_rows(f.x, force.data());
  // Without pressures the operator is mu (4 centre − the four neighbours), exact in small integers.
  int wrong = 0;
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) {
      const float neighbours =
          moved[at(i - 1, j)] + moved[at(i + 1, j)] + moved[at(i, j - 1)] + moved[at(i, j + 1)];
      wrong += force[at(i, j)] != 4.0F * moved[at(i, j)] - neighbours || f.y.at(i, j) != 0.0F;
    }

  level.d = correction;
  level.f = right;
  RowScratch<float> scratch(nx + 1, 1);
  relax<float>(level, {.from_zero = true}, nullptr, nullptr, scratch);
  linear_residual<float>(level.membrane, f, level.d, r);
  const double left = std::sqrt(dot<float>(r, r) / dot<float>(f, f));
  std::printf("%d nodes wrong, %.3f of the residual left\n", wrong, left);
  return wrong == 0 && left < 0.5 ? 0 : 1;
}
