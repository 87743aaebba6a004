// SPDX-License-Identifier: MIT
#pragma once
// A level as the solver holds it (aligned fields), with arbitrary values and the curve rows of a
// circle, on which the kernels are timed.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numbers>
#include <vector>

#include <drumhead/grid/cut_cells.h>
#include <drumhead/grid/field.h>
#include <drumhead/kernels/kaczmarz.h>

namespace drumhead::bench {

/// Values in [−size, size], 0 on the boundary of the lattice; the same for every call.
template <class T>
void fill(const kernels::Plane<T>& plane, std::uint32_t seed, double size) {
  for (int j = 0; j < plane.rows; ++j)
    for (int i = 0; i < plane.columns; ++i) {
      seed = seed * 1664525u + 1013904223u;
      const bool edge = i == 0 || j == 0 || i == plane.columns - 1 || j == plane.rows - 1;
      plane.at(i, j) = edge ? T(0) : T(size * (double(seed >> 8) / double(1 << 23) - 1.0));
    }
}
template <class T>
void fill(const kernels::Unknowns<T>& u, std::uint32_t seed, double size) {
  fill(u.x, seed, size);
  fill(u.y, seed + 1, size);
  fill(u.p, seed + 2, size);
}

template <class T>
class BenchLevel {
 public:
  explicit BenchLevel(int n)
      : ux_(n + 1, n + 1, meter_),
        uy_(n + 1, n + 1, meter_),
        pressure_(n, n, meter_),
        d(n, n, true, meter_),
        f(n, n, true, meter_),
        out(n, n, true, meter_),
        coarse_d((n + 1) / 2, (n + 1) / 2, true, meter_),
        coarse_f((n + 1) / 2, (n + 1) / 2, true, meter_),
        e(n, n, true, meter_),
        scratch(n + 1, kMostThreads),
        n(n),
        alpha2_(n, n, meter_) {
    fill(ux_.view(), 1, 0.2);
    fill(uy_.view(), 2, 0.2);
    fill(pressure_.view(), 3, 1.5);  // the clamp at 1 acts on a third of the cells
    set_cuts();
    reset();
  }

  /// Everything that kernels write, as at first.
  void reset() {
    fill(d.view(), 11, 0.1);
    fill(f.view(), 21, 0.1);
    fill(coarse_d.view(), 31, 0.01);
    out.clear();
    coarse_f.clear();
    std::ranges::fill(dq, T(0));
  }
  std::size_t nodes() const { return std::size_t(n + 1) * std::size_t(n + 1); }
  kernels::Membrane<T> membrane() const {
    kernels::Membrane<T> m;
    m.ux = ux_.view();
    m.uy = uy_.view();
    m.pressure = pressure_.view();
    m.compliance.value = T(0.1);
    return m;
  }
  kernels::Cuts<T> curve() const {
    return {.count = int(cuts_.size()),
            .row_begin = cuts_.row_begin.data(),
            .column = cuts_.column.data(),
            .weight = weight_.data(),
            .compliance = compliance_.data(),
            .length = length_.data(),
            .link_diagonal = link_diagonal_.data(),
            .link_begin = cuts_.link_begin.data(),
            .link = cuts_.link.data(),
            .link_strength = strength_.data(),
            .jump = T(0.005)};
  }
  kernels::LevelSystem<T> system(bool with_curve = false) {
    return {.membrane = membrane(),
            .cuts = with_curve ? curve() : kernels::Cuts<T>{},
            .d = d.view(),
            .f = f.view(),
            .dq = dq.data(),
            .fq = fq.data()};
  }
  /// With the curve rows of the circle and balanced α, β.
  kernels::KaczmarzSystem<T> kaczmarz(T omega) {
    return {.level = system(true),
            .nodes = nodes_->view(),
            .alpha2 = alpha2_.view(),
            .beta2 = beta2_.data(),
            .omega = omega};
  }
  /// All that kernels write, bit by bit.
  std::vector<std::uint64_t> digest() const {
    std::vector<std::uint64_t> sums;
    for (const auto& u : {d.view(), f.view(), out.view(), coarse_f.view()})
      for (const kernels::Plane<const T>& plane : {u.x, u.y, u.p}) sums.push_back(hash(plane));
    for (const T q : dq) sums.push_back(bits(q));
    return sums;
  }

 private:
  static constexpr int kMostThreads = 64;
  static std::uint64_t bits(T value) {
    std::uint64_t all = 0;
    std::memcpy(&all, &value, sizeof value);
    return all;
  }
  static std::uint64_t hash(const kernels::Plane<const T>& plane) {
    std::uint64_t sum = 1469598103934665603u;
    for (int j = 0; j < plane.rows; ++j)
      for (int i = 0; i < plane.columns; ++i) sum = (sum ^ bits(plane.at(i, j))) * 1099511628211u;
    return sum;
  }
  void set_cuts() {
    grid::CurvePair circle;
    circle.name = "circle";
    constexpr int kChords = 720;
    const auto at = [&](int k) {
      const double angle = 2.0 * std::numbers::pi * (k % kChords) / kChords;
      return grid::Point{0.503 + 0.3 * std::cos(angle), 0.502 + 0.3 * std::sin(angle)};
    };
    for (int k = 0; k < kChords; ++k) {
      circle.source.push_back(grid::straight(at(k), at(k + 1)));
      circle.target.push_back(circle.source.back());
    }
    cuts_ = grid::cut({circle}, {n, n, 1.0 / n, {0.0, 0.0}, 1.0}, 1e6);
    for (const auto& four : cuts_.weight)
      for (const double w : four) weight_.push_back(T(w));
    compliance_.assign(cuts_.compliance.begin(), cuts_.compliance.end());
    length_.assign(cuts_.length.begin(), cuts_.length.end());
    link_diagonal_.assign(length_.size(), T(0));
    for (std::size_t k = 0; k < length_.size(); ++k)
      for (int l = cuts_.link_begin[k]; l < cuts_.link_begin[k + 1]; ++l) {
        const T shorter = std::min(length_[k], length_[std::size_t(cuts_.link[std::size_t(l)])]);
        const T other = length_[std::size_t(cuts_.link[std::size_t(l)])];
        strength_.push_back(shorter * shorter / (length_[k] * other));
        link_diagonal_[k] += shorter * shorter / (length_[k] * length_[k]);
      }
    dq.assign(2 * length_.size(), T(0));
    fq.assign(2 * length_.size(), T(0.01));
    eq.assign(4 * length_.size(), T(0));
    nodes_ = std::make_unique<kernels::CurveNodes<T>>(n, n, curve());
    beta2_.resize(length_.size());
    kernels::balance_rows<T>(membrane(), curve(), alpha2_.view(), beta2_.data());
  }

  grid::MemoryMeter meter_;
  grid::Field<T> ux_, uy_, pressure_;
  grid::CutCells cuts_;
  std::vector<T> weight_, compliance_, length_, link_diagonal_, strength_;

 public:
  grid::UnknownFields<T> d, f, out, coarse_d, coarse_f;
  std::vector<T> dq, fq;
  grid::UnknownFields<T> e;  ///< of damped Kaczmarz
  std::vector<T> eq;
  kernels::RowScratch<T> scratch;
  int n;

 private:
  grid::Field<T> alpha2_;
  std::vector<T> beta2_;
  std::unique_ptr<kernels::CurveNodes<T>> nodes_;
};

}  // namespace drumhead::bench
