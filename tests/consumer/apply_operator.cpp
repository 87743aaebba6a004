// SPDX-License-Identifier: MIT
// The kernels alone, on memory of one's own: makes the right-hand side of a known correction with
// the operator, relaxes once from zero and sees how much of the residual is gone.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/relax.h>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace drumhead::kernels;

constexpr int nx = 40, ny = 30;

/// One value per node, a row's even columns first, then its odd ones, without padding.
struct Nodes {
  std::vector<float> values = std::vector<float>((nx + 1) * (ny + 1));
  operator Plane<float>() { return {values.data(), nx + 1, (nx + 2) / 2, nx + 1, ny + 1}; }
};
struct Field {
  Nodes x, y;
  operator Unknowns<float>() { return {x, y, {}}; }
};

int main() {
  Field state, known, right, correction, residual;  // the state: a membrane at rest
  const Unknowns<float> d = known, f = right, r = residual;
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) d.x.at(i, j) = float((7 * i + 3 * j) % 5 - 2);

  LevelSystem<float> level;
  level.membrane.ux = Plane<float>(state.x);
  level.membrane.uy = Plane<float>(state.y);
  apply_hessian<float>(level.membrane, d, f);
  // Without pressures the operator is mu (4 centre − the four neighbours), exact in small integers.
  int wrong = 0;
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) {
      const float neighbours =
          d.x.at(i - 1, j) + d.x.at(i + 1, j) + d.x.at(i, j - 1) + d.x.at(i, j + 1);
      wrong += f.x.at(i, j) != 4.0F * d.x.at(i, j) - neighbours || f.y.at(i, j) != 0.0F;
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
