// SPDX-License-Identifier: MIT
#pragma once
// Random lattices for the tests of the kernels, the same for every seed: planes on memory of
// exactly the size that views.h asks for, and whole levels (state, material, curve rows, correction
// and right-hand side) on top of them. All values are multiples of 2^-12, so that float holds them
// and the double oracle sees the same numbers.
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <drumhead/kernels/isa.h>
#include <drumhead/kernels/relax.h>

namespace drumhead::fields {

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  /// A multiple of 2^-12 in [low, high].
  double number(double low, double high);
  /// In [low, high].
  int whole(int low, int high);

 private:
  std::mt19937 bits_;
};

/// How a plane lies in memory.
enum class Layout {
  exact,   ///< rows and halves touch: one heap block without a spare element
  guarded  ///< NaN between halves and rows, which AddressSanitizer guards against any access
};

/// columns × rows values, all 0 at first.
template <class T>
class OwnedPlane {
 public:
  OwnedPlane() = default;
  OwnedPlane(int columns, int rows, Layout layout = Layout::guarded);
  OwnedPlane(OwnedPlane&&) noexcept = default;
  OwnedPlane& operator=(OwnedPlane&&) noexcept = default;
  OwnedPlane(const OwnedPlane&) = delete;
  OwnedPlane& operator=(const OwnedPlane&) = delete;

  kernels::Plane<T> view() { return plane_; }
  kernels::Plane<const T> view() const { return plane_; }
  /// The values, i fastest.
  std::vector<T> values() const;
  /// A fresh number in every place.
  void fill(Random& random, double low, double high);
  /// value(i, j) in every place.
  template <class F>
  void set(F&& value) {
    for (int j = 0; j < plane_.rows; ++j)
      for (int i = 0; i < plane_.columns; ++i) plane_.at(i, j) = T(value(i, j));
  }
  /// The same in places (i, j) of the outer boundary.
  void set_boundary(T value);

 private:
  std::vector<T> storage_;
  kernels::Plane<T> plane_;
};

/// x, y per node of an nx × ny lattice and, if asked for, p per cell.
template <class T>
struct OwnedUnknowns {
  OwnedPlane<T> x, y, p;
  OwnedUnknowns() = default;
  OwnedUnknowns(int nx, int ny, bool pressure, Layout layout = Layout::guarded);
  /// Random values, 0 at the boundary nodes.
  void fill(Random& random);
  kernels::Unknowns<T> view() { return {x.view(), y.view(), p.view()}; }
  kernels::Unknowns<const T> view() const { return {x.view(), y.view(), p.view()}; }
  /// x, y, p one after the other.
  std::vector<T> values() const;
};

enum class Kappa { constant, cells, infinite };

struct LevelSpec {
  int nx = 5, ny = 4;
  bool pressure = true;
  bool mu_cells = false;
  Kappa kappa = Kappa::constant;
  double spacing = 1.0;
  int cuts = 0;  ///< at most: cells whose nodes are all fixed get none
  /// d of the curve rows in mu per finest cell, infinity: hard; and the jump of q.
  double stiffness = std::numeric_limits<double>::infinity(), jump = 0.0;
  double pressure_jump = 0.0;  ///< sigma of the volume rows
  Layout layout = Layout::guarded;
  unsigned seed = 1;
};

/// Curve rows in random cells, with random links between cells that touch.
template <class T>
struct RandomCuts {
  std::vector<int> row_begin, column, row, link_begin, link;
  std::vector<T> weight, compliance, length, link_diagonal, strength;
  T jump = T(0);
  RandomCuts(const LevelSpec& spec, Random& random);
  int size() const { return int(column.size()); }
  kernels::Cuts<T> view() const;

 private:
  void add(const LevelSpec& spec, Random& random, int i, int j);
  void join(Random& random);
};

template <class T>
struct RandomLevel {
  LevelSpec spec;
  Random random;
  T mu_value = T(1.5), compliance_value = T(0.375), clamp_centre = T(0.125), clamp_width = T(0.5);
  OwnedPlane<T> ux, uy, pressure, mu, compliance, inverse_diagonal;
  OwnedUnknowns<T> d, f;
  RandomCuts<T> cuts;
  std::vector<T> dq, fq;

  explicit RandomLevel(const LevelSpec& wanted);
  kernels::Membrane<T> membrane() const;
  kernels::LevelSystem<T> system();
};

/// Every combination of pressures, mu and kappa, none with curve rows.
std::vector<LevelSpec> membranes();

/// The values of several vectors as one.
template <class T>
std::vector<T> joined(std::initializer_list<std::vector<T>> parts) {
  std::vector<T> all;
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Bit for bit, so that −0 differs from 0 and NaN equals itself.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Another instruction set until the end of the scope.
class ForcedIsa {
 public:
  explicit ForcedIsa(kernels::Isa isa) : before_(kernels::current_isa()) { kernels::use_isa(isa); }
  ~ForcedIsa() { kernels::use_isa(before_); }
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;

 private:
  kernels::Isa before_;
};

}  // namespace drumhead::fields
