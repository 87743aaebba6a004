// SPDX-License-Identifier: MIT
#include "curve_strip.h"

#include <algorithm>
#include <array>

#include <drumhead/kernels/cuts.h>
#include <drumhead/kernels/elastic.h>

#include "chain.h"

namespace drumhead::multigrid {
namespace {

// Cells around each cut one that belong to the strip.
constexpr int kReach = 2;
// Rows of P and q may depend on one another (and with kappa infinite have no diagonal): these small
// compliances keep their pivots from zero.
constexpr double kCompliance = 1e-9;

/// A node's component, or a cell's P (component kP).
struct Unknown {
  int component, i, j;
};
constexpr int kP = 2;

/// Which nodes and cells belong to the strip, and its unknowns: block by block, each a set of nodes
/// equally far from an end of the strip, with the rows of P and q whose nodes are all there then.
template <class T>
class Layout {
 public:
  Layout(const NewtonSystem<T>& system)
      : nx_(system.level().nx),
        ny_(system.level().ny),
        cuts_(system.cuts()),
        pressure_(system.pressure() && system.level().pressure) {
    mark();
    for (int j = 1; j < ny_; ++j)
      for (int i = 1; i < nx_; ++i)
        if (in_strip(i, j) && step_[node(i, j)] < 0) number_component(i, j);
    number();
  }

  std::vector<Unknown> unknowns;  ///< of the lattice
  std::vector<int> place;         ///< of each of them in the chain
  std::vector<int> force;         ///< likewise of q, two per cut
  std::vector<int> block_begin{0};
  int rows = 0;
  bool pressure() const { return pressure_; }
  /// Index of an unknown of the lattice, or −1.
  int index(int component, int i, int j) const {
    return index_[std::size_t(component) + 3 * node(i, j)];
  }

 private:
  std::size_t node(int i, int j) const {
    return std::size_t(j) * std::size_t(nx_ + 1) + std::size_t(i);
  }
  bool free_node(int i, int j) const { return i > 0 && j > 0 && i < nx_ && j < ny_; }
  bool in_strip(int i, int j) const { return free_node(i, j) && near_node_[node(i, j)]; }
  void mark();
  void number_component(int i, int j);
  void number();
  void walk(int i, int j, int from, std::vector<std::array<int, 2>>& queue);

  int nx_, ny_;
  kernels::Cuts<T> cuts_;
  bool pressure_;
  std::vector<char> near_cell_, near_node_;
  std::vector<int> step_;  ///< of each node: its block
  std::vector<int> index_;
  int blocks_ = 0;
};

template <class T>
void Layout<T>::mark() {
  near_cell_.assign(std::size_t(nx_ + 1) * std::size_t(ny_ + 1), 0);
  near_node_ = near_cell_;
  step_.assign(near_cell_.size(), -1);
  index_.assign(3 * near_cell_.size(), -1);
  for (int j = 0; j < ny_; ++j)
    for (int k = cuts_.row_begin[j]; k < cuts_.row_begin[j + 1]; ++k)
      for (int b = std::max(0, j - kReach); b <= std::min(ny_ - 1, j + kReach); ++b)
        for (int a = std::max(0, cuts_.column[k] - kReach);
             a <= std::min(nx_ - 1, cuts_.column[k] + kReach); ++a) {
          near_cell_[node(a, b)] = 1;
          for (int n = 0; n < 4; ++n) near_node_[node(a + (n & 1), b + (n >> 1))] = 1;
        }
}

/// Breadth first over the strip's nodes; queue: all nodes of the component in that order.
template <class T>
void Layout<T>::walk(int i, int j, int from, std::vector<std::array<int, 2>>& queue) {
  queue.assign(1, {i, j});
  step_[node(i, j)] = from;
  for (std::size_t at = 0; at < queue.size(); ++at) {
    const auto [x, y] = queue[at];
    for (int b = y - 1; b <= y + 1; ++b)
      for (int a = x - 1; a <= x + 1; ++a)
        if (in_strip(a, b) && step_[node(a, b)] < 0) {
          step_[node(a, b)] = step_[node(x, y)] + 1;
          queue.push_back({a, b});
        }
  }
}

template <class T>
void Layout<T>::number_component(int i, int j) {
  std::vector<std::array<int, 2>> queue;
  walk(i, j, blocks_, queue);
  for (const auto [a, b] : queue) step_[node(a, b)] = -1;
  const auto [x, y] = queue.back();
  walk(x, y, blocks_, queue);
  blocks_ = step_[node(queue.back()[0], queue.back()[1])] + 1;
}

template <class T>
void Layout<T>::number() {
  std::vector<int> step_of;
  auto latest = [&](int i, int j) {
    int step = -1;
    for (int n = 0; n < 4; ++n) step = std::max(step, step_[node(i + (n & 1), j + (n >> 1))]);
    return step;
  };
  for (int j = 0; j <= ny_; ++j)
    for (int i = 0; i <= nx_; ++i)
      for (int component = 0; component <= kP; ++component) {
        const bool cell = component == kP;
        if (cell ? !pressure_ || !near_cell_[node(i, j)] || latest(i, j) < 0 : !in_strip(i, j))
          continue;
        index_[std::size_t(component) + 3 * node(i, j)] = int(unknowns.size());
        unknowns.push_back({component, i, j});
        step_of.push_back(cell ? latest(i, j) : step_[node(i, j)]);
      }
  for (int j = 0; j < ny_; ++j)
    for (int k = cuts_.row_begin[j]; k < cuts_.row_begin[j + 1]; ++k)
      step_of.insert(step_of.end(), 2, std::max(0, latest(cuts_.column[k], j)));
  block_begin.assign(std::size_t(blocks_) + 1, 0);
  for (const int step : step_of) ++block_begin[std::size_t(step) + 1];
  for (std::size_t n = 1; n < block_begin.size(); ++n) block_begin[n] += block_begin[n - 1];
  std::vector<int> next(block_begin.begin(), block_begin.end() - 1);
  for (const int step : step_of) place.push_back(next[std::size_t(step)]++);
  rows = int(place.size());
  force.assign(place.begin() + std::ptrdiff_t(unknowns.size()), place.end());
  place.resize(unknowns.size());
}

template <class T, class Fields>
auto& value_of(Fields& fields, const Unknown& u) {
  return u.component == kP  ? fields.p.at(u.i, u.j)
         : u.component == 0 ? fields.x.at(u.i, u.j)
                            : fields.y.at(u.i, u.j);
}

/// Entries of the strip's equations by rows of the chain.
template <class T>
class Assembly {
 public:
  Assembly(const NewtonSystem<T>& system, const Layout<T>& layout)
      : system_(system), layout_(layout), entries_(std::size_t(layout.rows)) {
    add_lattice();
    add_curve_rows();
  }
  SparseRows rows() const {
    SparseRows all;
    for (const auto& row : entries_) {
      for (const auto& [column, value] : row) all.add(column, value);
      all.end_row();
    }
    return all;
  }

 private:
  void add_lattice();
  void add_curve_rows();

  const NewtonSystem<T>& system_;
  const Layout<T>& layout_;
  std::vector<std::vector<std::pair<int, double>>> entries_;
};

/// From products with unit vectors three nodes apart, which do not see one another.
template <class T>
void Assembly<T>::add_lattice() {
  const Level<T>& level = system_.level();
  Vector<T> unit = system_.make_vector(), image = system_.make_vector();
  const kernels::Unknowns<T> d = unit.fields.view(), out = image.fields.view();
  for (int colour = 0; colour < (layout_.pressure() ? 27 : 18); ++colour) {
    const int component = colour / 9, x = colour % 3, y = colour / 3 % 3;
    unit.fields.clear();
    for (const Unknown& u : layout_.unknowns)
      if (u.component == component && u.i % 3 == x && u.j % 3 == y) value_of<T>(d, u) = T(1);
    kernels::apply_hessian<T>(system_.membrane(), d, out);
    for (std::size_t n = 0; n < layout_.unknowns.size(); ++n) {
      const Unknown& u = layout_.unknowns[n];
      const double value = double(value_of<T>(out, u));
      if (value == 0.0) continue;
      // The one node of this colour among the nine about this one.
      const int i = u.i - 1 + (x - u.i + 1 + 3 * level.nx) % 3;
      const int j = u.j - 1 + (y - u.j + 1 + 3 * level.ny) % 3;
      if (i < 0 || j < 0 || i > level.nx || j > level.ny) continue;
      const int from = layout_.index(component, i, j);
      if (from >= 0)
        entries_[std::size_t(layout_.place[n])].push_back(
            {layout_.place[std::size_t(from)], value});
    }
  }
  for (std::size_t n = 0; n < layout_.unknowns.size(); ++n)
    if (layout_.unknowns[n].component == kP)
      entries_[std::size_t(layout_.place[n])].push_back({layout_.place[n], -kCompliance});
}

template <class T>
void Assembly<T>::add_curve_rows() {
  const kernels::Cuts<T> cuts = system_.cuts();
  for (int j = 0; j < system_.level().ny; ++j)
    for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k)
      for (int axis = 0; axis < 2; ++axis) {
        const int row = layout_.force[std::size_t(2 * k + axis)];
        for (int n = 0; n < 4; ++n) {
          const int at = layout_.index(axis, cuts.column[k] + (n & 1), j + (n >> 1));
          if (at < 0) continue;
          const int column = layout_.place[std::size_t(at)];
          const double w = -double(cuts.weight[4 * k + n]);
          entries_[std::size_t(row)].push_back({column, w});
          entries_[std::size_t(column)].push_back({row, w});
        }
        entries_[std::size_t(row)].push_back(
            {row, -double(kernels::cut_compliance_diagonal(cuts, k)) - kCompliance});
        for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1] && cuts.jump > T(0); ++l)
          entries_[std::size_t(row)].push_back({layout_.force[std::size_t(2 * cuts.link[l] + axis)],
                                                double(cuts.jump) * double(cuts.link_strength[l])});
      }
}

}  // namespace

template <class T>
struct CurveStrip<T>::Block {
  std::vector<Unknown> unknowns;
  std::vector<int> place, force;
  Chain chain;
  std::vector<double> values;
  grid::MemoryMeter* meter = nullptr;
  std::size_t bytes = 0;
  ~Block() { meter->remove(bytes); }
};

template <class T>
CurveStrip<T>::~CurveStrip() = default;
template <class T>
CurveStrip<T>::CurveStrip(CurveStrip&&) noexcept = default;

template <class T>
CurveStrip<T>::CurveStrip(const NewtonSystem<T>& system) : block_(std::make_unique<Block>()) {
  Block& b = *block_;
  b.meter = &system.meter();
  Layout<T> layout(system);
  b.chain.factorise(Assembly<T>(system, layout).rows(), layout.block_begin);
  b.unknowns = std::move(layout.unknowns);
  b.place = std::move(layout.place);
  b.force = std::move(layout.force);
  b.values.resize(std::size_t(layout.rows));
  b.bytes = b.unknowns.size() * (sizeof(Unknown) + sizeof(int)) + b.force.size() * sizeof(int) +
            b.chain.bytes() + b.values.size() * sizeof(double);
  b.meter->add(b.bytes);
}

template <class T>
void CurveStrip<T>::add_solution(const Vector<T>& r, Vector<T>& x) {
  Block& b = *block_;
  const auto right = r.fields.view();
  const auto out = x.fields.view();
  for (std::size_t n = 0; n < b.unknowns.size(); ++n)
    b.values[std::size_t(b.place[n])] = double(value_of<T>(right, b.unknowns[n]));
  for (std::size_t k = 0; k < b.force.size(); ++k)
    b.values[std::size_t(b.force[k])] = double(r.q[k]);
  b.chain.solve(b.values);
  for (std::size_t n = 0; n < b.unknowns.size(); ++n)
    value_of<T>(out, b.unknowns[n]) += T(b.values[std::size_t(b.place[n])]);
  for (std::size_t k = 0; k < b.force.size(); ++k) x.q[k] += T(b.values[std::size_t(b.force[k])]);
}

template class CurveStrip<float>;
template class CurveStrip<double>;

}  // namespace drumhead::multigrid
