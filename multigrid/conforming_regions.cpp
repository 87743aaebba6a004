// SPDX-License-Identifier: MIT
#include "conforming_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "conforming_visits.h"

namespace drumhead::multigrid {
namespace {

/// Sets that are merged; each is named by its least member.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int n) {
    while (parent_[std::size_t(n)] != n) {
      int& parent = parent_[std::size_t(n)];
      parent = parent_[std::size_t(parent)];
      n = parent;
    }
    return n;
  }
  void merge(int a, int b) {
    const auto [least, most] = std::minmax({find(a), find(b)});
    parent_[std::size_t(most)] = least;
  }

 private:
  std::vector<int> parent_;
};

/// Whether a side (south, east, north, west) of cell (i, j) lies between two known nodes.
bool is_wall(const grid::ConformingCells& cells, int i, int j, int side) {
  constexpr std::array<std::array<int, 4>, 4> kEnds{
      {{0, 0, 1, 0}, {1, 0, 1, 1}, {0, 1, 1, 1}, {0, 0, 0, 1}}};
  const auto& [ax, ay, bx, by] = kEnds[std::size_t(side)];
  return is_known(cells, i + ax, j + ay) && is_known(cells, i + bx, j + by);
}

/// Pairs of parts with a common side that lies between two held nodes, not both of them known: a
/// soft curve is no wall.
std::vector<std::array<int, 2>> across_soft_curves(const grid::ConformingCells& cells) {
  struct Side {
    std::int64_t a, b;  // numbers of the nodes
    int part;
    auto operator<=>(const Side&) const = default;
  };
  const auto soft = [](const grid::HeldNode& node) { return !std::isinf(node.stiffness); };
  if (!std::ranges::any_of(cells.node, soft) && !std::ranges::any_of(cells.curve_node, soft))
    return {};
  std::vector<Side> sides;
  const std::int64_t nodes = std::int64_t(cells.nx + 1) * (cells.ny + 1);
  for_special(cells, [&](int c, int i, int j) {
    struct End {
      std::int64_t number;
      bool held, known;
    };
    auto end_at = [&](int code) -> End {
      if (code >= kernels::kFirstCrossing) {
        const std::size_t n = std::size_t(code - kernels::kFirstCrossing);
        return {nodes + std::int64_t(n), true, std::isinf(cells.curve_node[n].stiffness)};
      }
      const int x = i + (code & 1), y = j + (code >> 1);
      return {std::int64_t(y) * (cells.nx + 1) + x,
              cells.cell_corner[std::size_t(c)][std::size_t(code)] >= 0, is_known(cells, x, y)};
    };
    for_parts(cells, c, [&](int p) {
      const int first = cells.part_node_begin[std::size_t(p)],
                last = cells.part_node_begin[std::size_t(p) + 1];
      for (int n = first; n < last; ++n) {
        const End a = end_at(cells.part_node[std::size_t(n)]),
                  b = end_at(cells.part_node[std::size_t(n + 1 < last ? n + 1 : first)]);
        if (!(a.known && b.known) && (a.held || a.known) && (b.held || b.known))
          sides.push_back({std::min(a.number, b.number), std::max(a.number, b.number), p});
      }
    });
  });
  std::ranges::sort(sides);
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t n = 0; n + 1 < sides.size(); ++n)
    if (sides[n].a == sides[n + 1].a && sides[n].b == sides[n + 1].b)
      pairs.push_back({sides[n].part, sides[n + 1].part});
  return pairs;
}

/// Σ value(k) over k = begin … end − 1, in eight sums that do not wait for one another.
template <class F>
double sum_of(int begin, int end, F&& value) {
  constexpr int kSums = 8;
  std::array<double, kSums> sums{};
  int k = begin;
  for (; k + kSums <= end; k += kSums)
    for (int n = 0; n < kSums; ++n) sums[std::size_t(n)] += double(value(k + n));
  for (int n = 0; k < end; ++k, ++n) sums[std::size_t(n)] += double(value(k));
  return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

}  // namespace

/// Runs of regular cells between special ones and walls.
void Regions::list_runs(const grid::ConformingCells& cells) {
  run_begin_.assign(1, 0);
  for (int j = 0; j < cells.ny; ++j) {
    auto add = [&](int begin, int end) {
      // A wall between regular cells ends in nodes that curves hold in their places.
      const std::size_t nodes = std::size_t(std::max(j, 1));
      for (int n = cells.node_begin[nodes]; n < cells.node_begin[nodes + 1]; ++n) {
        const int i = cells.node_column[std::size_t(n)];
        if (i <= begin || i >= end || !is_wall(cells, i, j, 3)) continue;
        run_.push_back({begin, i});
        begin = i;
      }
      if (begin < end) run_.push_back({begin, end});
    };
    int begin = 0;
    for (int c = cells.cell_begin[std::size_t(j)]; c < cells.cell_begin[std::size_t(j) + 1]; ++c) {
      add(begin, cells.cell_column[std::size_t(c)]);
      begin = cells.cell_column[std::size_t(c)] + 1;
    }
    add(begin, cells.nx);
    run_begin_.push_back(int(run_.size()));
  }
}

template <class T>
Regions::Regions(const grid::ConformingCells& geometry, const kernels::SpecialCells<T>& cells) {
  list_runs(geometry);
  const int runs = int(run_.size());
  Sets sets(run_.size() + std::size_t(cells.parts()));
  for (int j = 1; j < geometry.ny; ++j) {
    const int row_end = run_begin_[std::size_t(j)];
    int low = run_begin_[std::size_t(j) - 1];
    for (int high = row_end; high < run_begin_[std::size_t(j) + 1]; ++high) {
      const Run& above = run_[std::size_t(high)];
      while (low < row_end && run_[std::size_t(low)].end <= above.begin) ++low;
      for (int n = low; n < row_end && run_[std::size_t(n)].begin < above.end; ++n) {
        int i = std::max(above.begin, run_[std::size_t(n)].begin);
        const int end = std::min(above.end, run_[std::size_t(n)].end);
        while (i < end && is_wall(geometry, i, j, 0)) ++i;
        if (i < end) sets.merge(high, n);
      }
    }
  }
  for (int p = 0; p < cells.parts(); ++p)
    for (int k = cells.neighbour_begin[std::size_t(p)];
         k < cells.neighbour_begin[std::size_t(p) + 1]; ++k)
      if (const int other = cells.neighbour[std::size_t(k)].part; other >= 0)
        sets.merge(runs + p, runs + other);
  for (const auto& [a, b] : across_soft_curves(geometry)) sets.merge(runs + a, runs + b);
  for (int j = 0; j < geometry.ny; ++j) {
    int run = run_begin_[std::size_t(j)];
    for (int b = cells.border_begin[std::size_t(j)]; b < cells.border_begin[std::size_t(j) + 1];
         ++b) {
      const kernels::PartBorder& border = cells.border[std::size_t(b)];
      while (run_[std::size_t(run)].end <= border.column) ++run;
      const int side = (cells.neighbour[std::size_t(border.neighbour)].side + 2) % 4;
      if (!is_wall(geometry, border.column, j, side)) sets.merge(run, runs + border.part);
    }
  }
  std::vector<int> number(run_.size() + std::size_t(cells.parts()), -1);
  int count = 0;
  auto region = [&](int n) {
    int& of_root = number[std::size_t(sets.find(n))];
    if (of_root < 0) of_root = count++;
    return of_root;
  };
  for (int n = 0; n < runs; ++n) run_[std::size_t(n)].region = region(n);
  for (int p = 0; p < cells.parts(); ++p) part_region_.push_back(region(runs + p));
  part_weight_.resize(part_region_.size());
  sum_.resize(std::size_t(count));
  weight_ = area_ = shift_ = sum_;
}

/// visit(region, j, parity, begin, end) for the columns of one parity of every run.
template <class F>
void Regions::for_halves(F&& visit) const {
  for (int j = 0; j + 1 < int(run_begin_.size()); ++j)
    for (int n = run_begin_[std::size_t(j)]; n < run_begin_[std::size_t(j) + 1]; ++n)
      for (const int parity : {0, 1}) {
        const Run& run = run_[std::size_t(n)];
        visit(std::size_t(run.region), j, parity, (run.begin + 1 - parity) / 2,
              (run.end + 1 - parity) / 2);
      }
}

template <class T>
void Regions::prepare(const kernels::Membrane<T>& m) {
  if (count() <= 1) return;
  const double cell = double(m.spacing) * double(m.spacing);
  const kernels::Plane<const T>& compliance = m.compliance.cells;
  const kernels::SpecialCells<T>& cells = m.special->cells();
  std::ranges::fill(weight_, 0.0);
  std::ranges::fill(area_, 0.0);
  for_halves([&](std::size_t region, int j, int parity, int begin, int end) {
    area_[region] += cell * (end - begin);
    if (!compliance) return;
    const T* row = compliance.half(j, parity);
    weight_[region] += cell * sum_of(begin, end, [=](int k) { return row[k]; });
  });
  for (int j = 0; j + 1 < int(cells.row_begin.size()); ++j)
    for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n)
      for (int p = cells.part_begin[std::size_t(n)]; p < cells.part_begin[std::size_t(n) + 1];
           ++p) {
        const double area = double(cells.area[std::size_t(p)]);
        const double c = compliance ? double(compliance.at(cells.column[std::size_t(n)], j)) : 1.0;
        const std::size_t region = std::size_t(part_region_[std::size_t(p)]);
        part_weight_[std::size_t(p)] = area * c;
        area_[region] += area;
        weight_[region] += area * c;
      }
  if (!compliance) weight_ = area_;
}

template <class T>
void Regions::add_sums(const kernels::Unknowns<T>& f) {
  std::ranges::fill(sum_, 0.0);
  for_halves([&](std::size_t region, int j, int parity, int begin, int end) {
    const T* row = f.p.half(j, parity);
    sum_[region] += sum_of(begin, end, [=](int k) { return row[k]; });
  });
  for (std::size_t p = 0; p < part_region_.size(); ++p)
    sum_[std::size_t(part_region_[p])] += double(f.listed[p]);
}

template <class T>
void Regions::keep_sums(const kernels::Unknowns<T>& f) {
  if (count() > 1) add_sums(f);
}

template <class T>
void Regions::remove_sums(const kernels::Membrane<T>& m, const kernels::Unknowns<T>& f) {
  if (count() <= 1) return;
  add_sums(f);
  const double cell = double(m.spacing) * double(m.spacing);
  for_halves([&](std::size_t region, int j, int parity, int begin, int end) {
    const T share = T(cell * sum_[region] / area_[region]);
    T* row = f.p.half(j, parity);
    for (int k = begin; k < end; ++k) row[k] -= share;
  });
  const std::vector<T>& area = m.special->cells().area;
  for (std::size_t p = 0; p < part_region_.size(); ++p) {
    const std::size_t region = std::size_t(part_region_[p]);
    f.listed[p] -= T(double(area[p]) * sum_[region] / area_[region]);
  }
  std::ranges::fill(sum_, 0.0);
}

template <class T>
void Regions::set_means(const kernels::Membrane<T>& m, const kernels::Unknowns<T>& d) {
  if (count() <= 1) return;
  const double cell = double(m.spacing) * double(m.spacing);
  const kernels::Plane<const T>& compliance = m.compliance.cells;
  // With one kappa the weights are areas, `unit` what they lack.
  const double unit = compliance ? 1.0 : double(m.compliance.value);
  std::ranges::fill(shift_, 0.0);
  for_halves([&](std::size_t region, int j, int parity, int begin, int end) {
    const T* p = d.p.half(j, parity);
    const T* c = compliance ? compliance.half(j, parity) : nullptr;
    shift_[region] +=
        cell * (c ? sum_of(begin, end, [=](int k) { return double(c[k]) * double(p[k]); })
                  : sum_of(begin, end, [=](int k) { return p[k]; }));
  });
  for (std::size_t p = 0; p < part_region_.size(); ++p)
    shift_[std::size_t(part_region_[p])] += part_weight_[p] * double(d.listed[p]);
  for (std::size_t r = 0; r < shift_.size(); ++r) {
    const double wanted = unit > 0.0 ? sum_[r] / unit : 0.0;
    shift_[r] = weight_[r] > 0.0 ? -(wanted + shift_[r]) / weight_[r] : 0.0;
  }
  for_halves([&](std::size_t region, int j, int parity, int begin, int end) {
    const T shift = T(shift_[region]);
    T* row = d.p.half(j, parity);
    for (int k = begin; k < end; ++k) row[k] += shift;
  });
  for (std::size_t p = 0; p < part_region_.size(); ++p)
    d.listed[p] += T(shift_[std::size_t(part_region_[p])]);
}

#define DRUMHEAD_INSTANTIATE(T)                                                                 \
  template Regions::Regions(const grid::ConformingCells&, const kernels::SpecialCells<T>&);     \
  template void Regions::prepare(const kernels::Membrane<T>&);                                  \
  template void Regions::keep_sums(const kernels::Unknowns<T>&);                                \
  template void Regions::remove_sums(const kernels::Membrane<T>&, const kernels::Unknowns<T>&); \
  template void Regions::set_means(const kernels::Membrane<T>&, const kernels::Unknowns<T>&);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::multigrid
