// SPDX-License-Identifier: MIT
#pragma once
// Lattices and pictures for the resampler's tests.
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include <drumhead/kernels/resample.h>

namespace drumhead::tests {

using kernels::Position;

struct WarpedLattice {
  int nx = 1, ny = 1;
  double cell_px = 1.0;
  Position origin_px;
  std::vector<double> u, v;

  kernels::LatticeMapView view() const { return {u.data(), v.data(), nx, ny, cell_px, origin_px}; }
};

/// Displacements from a function rest → warped.
inline WarpedLattice warped_by(int nx, int ny, double cell_px, Position origin,
                               const std::function<Position(Position)>& warp) {
  WarpedLattice lattice{nx, ny, cell_px, origin, {}, {}};
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const Position rest{origin.x + cell_px * i, origin.y + cell_px * j}, to = warp(rest);
      lattice.u.push_back(to.x - rest.x);
      lattice.v.push_back(to.y - rest.y);
    }
  }
  return lattice;
}

/// Inner nodes displaced by up to `cells` cells in each direction; the boundary stays.
inline WarpedLattice random_lattice(int nx, int ny, double cell_px, Position origin, double cells,
                                    unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> displacement(-cells * cell_px, cells * cell_px);
  WarpedLattice lattice = warped_by(nx, ny, cell_px, origin, [](Position rest) { return rest; });
  for (int j = 1; j < ny; ++j) {
    for (int i = 1; i < nx; ++i) {
      const std::size_t node = std::size_t(j) * std::size_t(nx + 1) + std::size_t(i);
      lattice.u[node] = displacement(generator);
      lattice.v[node] = displacement(generator);
    }
  }
  return lattice;
}

struct Picture {
  int width = 0, height = 0, channels = 1, left = 0, top = 0;
  std::vector<float> data;

  Picture(int w, int h, int c, int l = 0, int t = 0)
      : width(w),
        height(h),
        channels(c),
        left(l),
        top(t),
        data(std::size_t(w) * std::size_t(h) * std::size_t(c)) {}
  float& at(int a, int b, int c = 0) {
    return data[(std::size_t(b) * std::size_t(width) + std::size_t(a)) * std::size_t(channels) +
                std::size_t(c)];
  }
  float at(int a, int b, int c = 0) const { return const_cast<Picture*>(this)->at(a, b, c); }
  kernels::ImageView view() const {
    return {data.data(), width, height, channels, std::ptrdiff_t(width) * channels};
  }
  kernels::ImageTarget target() {
    return {data.data(), width, height, channels, std::ptrdiff_t(width) * channels, left, top};
  }
};

inline Picture noise(int width, int height, int channels, unsigned seed) {
  Picture picture(width, height, channels);
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  for (float& x : picture.data) x = value(generator);
  return picture;
}

/// `picture` through `lattice`, at the size and place of `out`.
inline Picture rendered(const Picture& picture, const WarpedLattice& lattice, Picture out,
                        const kernels::ResampleOptions& options = {}) {
  kernels::Resampler(picture.view(), lattice.view(), options).render(out.target());
  return out;
}

struct BackwardMap {
  int width = 0, height = 0, left = 0, top = 0;
  std::vector<Position> source;
  std::vector<float> jacobian;
  std::vector<signed char> side;
  std::size_t index(int a, int b) const {
    return std::size_t(b) * std::size_t(width) + std::size_t(a);
  }
};

inline BackwardMap backward(const WarpedLattice& lattice, int width, int height, int left = 0,
                            int top = 0, int threads = 0) {
  const std::size_t n = std::size_t(width) * std::size_t(height);
  BackwardMap map{width,
                  height,
                  left,
                  top,
                  std::vector<Position>(n),
                  std::vector<float>(4 * n),
                  std::vector<signed char>(n)};
  kernels::backward_map(lattice.view(),
                        {map.source.data(), reinterpret_cast<float(*)[4]>(map.jacobian.data()),
                         map.side.data(), width, height, width, left, top},
                        threads);
  return map;
}

}  // namespace drumhead::tests
