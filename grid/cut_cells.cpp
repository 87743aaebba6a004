// SPDX-License-Identifier: MIT
#include <drumhead/grid/cut_cells.h>

#include <drumhead/kernels/refuse.h>
#include <algorithm>
#include <cmath>

#include "crossings.h"
#include "made_of_curves.h"
#include "quadrature.h"

namespace drumhead::grid {
namespace {

constexpr double kShortestStay = 1e-3;   // cells
constexpr double kLeastInterior = 0.02;  // of a row's weight
constexpr double kQuadrature = 1e-10;    // relative

struct Cell {
  int i = -1, j = -1;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// ∫ over an arc inside one cell of 1, the bilinear weights and target − source.
struct Integral {
  double length = 0.0;
  std::array<double, 4> weight{};
  Point wanted;
  double stiffness = 0.0;  // Σ d len, infinite for a hard curve
  void add(const Integral& other) {
    length += other.length;
    for (int n = 0; n < 4; ++n) weight[std::size_t(n)] += other.weight[std::size_t(n)];
    wanted = wanted + other.wanted;
    stiffness += other.stiffness;
  }
  void add_point(Cell cell, Point s, Point target, double ds) {
    const double x = s.x - cell.i, y = s.y - cell.j;
    length += ds;
    weight[0] += ds * (1 - x) * (1 - y);
    weight[1] += ds * x * (1 - y);
    weight[2] += ds * (1 - x) * y;
    weight[3] += ds * x * y;
    wanted = wanted + ds * (target - s);
  }
};

/// A curve's uninterrupted stay in one cell.
struct Stay {
  Cell cell;
  Integral integral;
};

/// Two straight segments of constant speed.
struct ChordPair {
  Point source, target;            // where they begin
  Point source_move, target_move;  // from there to their ends
  Point at(double t) const { return source + t * source_move; }
};

Integral gauss(const SegmentPair& pair, Cell cell, double t0, double t1) {
  Integral sum;
  for_gauss_points(t0, t1, [&](double t, double weight) {
    sum.add_point(cell, pair.source.at(t), pair.target.at(t),
                  weight * length(pair.source.derivative(t)));
  });
  return sum;
}

/// Halves the arc until the eight-point rule has converged.
Integral integrate(const SegmentPair& pair, Cell cell, double t0, double t1, const Integral& whole,
                   int depth) {
  const double middle = 0.5 * (t0 + t1);
  const Integral left = gauss(pair, cell, t0, middle), right = gauss(pair, cell, middle, t1);
  Integral sum = left;
  sum.add(right);
  if (depth == 0 || std::abs(sum.length - whole.length) <= kQuadrature * whole.length) return sum;
  sum = integrate(pair, cell, t0, middle, left, depth - 1);
  sum.add(integrate(pair, cell, middle, t1, right, depth - 1));
  return sum;
}

/// Straight arcs at constant speed: weights are quadratic in t, which two points integrate exactly.
[[gnu::always_inline]] inline Integral straight_arc(const ChordPair& pair, Cell cell, double t0,
                                                    double t1) {
  Integral sum;
  const double speed = length(pair.source_move);
  for_two_gauss_points(t0, t1, [&](double t, double weight) {
    sum.add_point(cell, pair.at(t), pair.target + t * pair.target_move, weight * speed);
  });
  return sum;
}

/// One curve: its stays and which of them follow one another, as numbers of their cells.
struct CutCurve {
  std::vector<Stay> stays;
  std::vector<std::array<std::ptrdiff_t, 2>> followers;
};

std::ptrdiff_t number(Cell cell, const Lattice& lattice) {
  return std::ptrdiff_t(cell.j) * lattice.nx + cell.i;
}

class Cutter {
 public:
  Cutter(const Lattice& lattice, double most_weight)
      : lattice_(lattice), most_weight_(most_weight) {}

  CutCurve cut(const CurvePair& curve) {
    if (!(curve.weight > 0.0))
      kernels::refuse("curve '" + curve.name + "': weight", curve.weight,
                      "positive (infinity allowed)");
    check(curve);
    std::vector<Stay> stays;
    for_matched(curve, [&](const CubicBezier& source, const CubicBezier& target) {
      if (source.constant_speed() && target.constant_speed())
        add_straight(curve, source, target, stays);
      else
        add_curved(curve, source, target, stays);
    });
    const Point gap = lattice_.to_cells(curve.source.back().control[3]) -
                      lattice_.to_cells(curve.source.front().control[0]);
    return keep(std::move(stays), length(gap) < 1e-6, std::min(curve.weight, most_weight_));
  }

 private:
  void add_straight(const CurvePair& curve, const CubicBezier& source, const CubicBezier& target,
                    std::vector<Stay>& stays) {
    const Point begin = lattice_.to_cells(source.control[0]),
                end = lattice_.to_cells(source.control[3]),
                target_begin = lattice_.to_cells(target.control[0]),
                target_end = lattice_.to_cells(target.control[3]);
    const ChordPair pair{begin, target_begin, end - begin, target_end - target_begin};
    // Most chords of a polyline cross no line.
    if (!stays.empty() && inside(begin, stays.back().cell) && inside(end, stays.back().cell)) {
      stays.back().integral.add(straight_arc(pair, stays.back().cell, 0.0, 1.0));
      return;
    }
    find_crossings(in_cells(source), crossings_);
    add_pieces(
        curve, stays, [&](double t) { return pair.at(t); },
        [&](Cell cell, double t0, double t1) { return straight_arc(pair, cell, t0, t1); });
  }

  void add_curved(const CurvePair& curve, const CubicBezier& source, const CubicBezier& target,
                  std::vector<Stay>& stays) {
    const SegmentPair pair{in_cells(source), in_cells(target)};
    find_crossings(pair.source, crossings_);
    add_pieces(
        curve, stays, [&](double t) { return pair.source.at(t); },
        [&](Cell cell, double t0, double t1) {
          return integrate(pair, cell, t0, t1, gauss(pair, cell, t0, t1), 20);
        });
  }

  /// Files the integrals arc(cell, t0, t1) between crossings_ of a source at(t).
  template <class At, class Arc>
  void add_pieces(const CurvePair& curve, std::vector<Stay>& stays, At&& at, Arc&& arc) {
    crossings_.push_back(1.0);
    double t0 = 0.0;
    for (const double t1 : crossings_) {
      if (t1 <= t0) continue;
      const Point middle = at(0.5 * (t0 + t1));
      if (middle.x < -kSnap || middle.y < -kSnap || middle.x > lattice_.nx + kSnap ||
          middle.y > lattice_.ny + kSnap)
        refuse_outside(curve, middle, lattice_);
      const bool stayed = !stays.empty() && inside(middle, stays.back().cell);
      const Cell cell =
          stayed ? stays.back().cell
                 : Cell{cell_index(middle.x, lattice_.nx), cell_index(middle.y, lattice_.ny)};
      if (stays.empty() || !(stays.back().cell == cell)) stays.push_back({cell, {}});
      stays.back().integral.add(arc(cell, t0, t1));
      t0 = t1;
    }
  }

  CubicBezier in_cells(CubicBezier curve) const {
    for (Point& p : curve.control) p = lattice_.to_cells(p);
    return curve;
  }
  static bool inside(Point p, Cell cell) {
    const double x = p.x - cell.i, y = p.y - cell.j;
    return std::min(x, y) > kSnap && std::max(x, y) < 1.0 - kSnap;
  }

  /// Drops stays that are too short, and notes which of the others follow one another.
  CutCurve keep(std::vector<Stay> stays, bool closed, double weight) const {
    if (closed && stays.size() > 1 && stays.front().cell == stays.back().cell) {
      stays.front().integral.add(stays.back().integral);
      stays.pop_back();
    }
    std::erase_if(stays, [](const Stay& s) { return s.integral.length < kShortestStay; });
    // d in mu per side_px becomes mu per cell.
    const double stiffness = weight * lattice_.cell_px / lattice_.side_px;
    for (Stay& stay : stays) stay.integral.stiffness = stiffness * stay.integral.length;
    CutCurve curve;
    auto follow = [&](const Stay& a, const Stay& b) {
      if (!(a.cell == b.cell))
        curve.followers.push_back({number(a.cell, lattice_), number(b.cell, lattice_)});
    };
    for (std::size_t n = 0; n + 1 < stays.size(); ++n) follow(stays[n], stays[n + 1]);
    if (closed && stays.size() > 2) follow(stays.back(), stays.front());
    curve.stays = std::move(stays);
    return curve;
  }

  const Lattice& lattice_;
  double most_weight_;
  std::vector<double> crossings_;  // of the segment at hand
};

/// Zeroes the weights of nodes on the fixed boundary; returns what is left.
double keep_interior(std::array<double, 4>& weight, int i, int j, int nx, int ny) {
  double sum = 0.0;
  for (int n = 0; n < 4; ++n) {
    const int x = i + (n & 1), y = j + (n >> 1);
    if (x == 0 || x == nx || y == 0 || y == ny) weight[std::size_t(n)] = 0.0;
    sum += weight[std::size_t(n)];
  }
  return sum;
}

/// Unique symmetric links from pairs of cuts.
void set_links(CutCells& cuts, std::vector<std::array<int, 2>>& pairs) {
  const std::size_t given = pairs.size();
  for (std::size_t n = 0; n < given; ++n) pairs.push_back({pairs[n][1], pairs[n][0]});
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()),
              pairs.end());  // clang 14 has no ranges::unique
  cuts.link_begin.assign(std::size_t(cuts.size()) + 1, 0);
  for (const auto& [k, l] : pairs) {
    ++cuts.link_begin[std::size_t(k) + 1];
    cuts.link.push_back(l);
  }
  for (std::size_t k = 0; k < std::size_t(cuts.size()); ++k)
    cuts.link_begin[k + 1] += cuts.link_begin[k];
}

/// Joins what curves have in one cell; `curves`: pointers to CutCurve.
template <class Curves>
CutCells join(const Curves& curves, const Lattice& lattice) {
  std::vector<std::pair<std::ptrdiff_t, const Stay*>> stays;
  for (const auto& curve : curves)
    for (const Stay& stay : curve->stays) stays.push_back({number(stay.cell, lattice), &stay});
  std::ranges::stable_sort(stays, {}, [](const auto& s) { return s.first; });
  CutCells cuts;
  cuts.row_begin.assign(std::size_t(lattice.ny) + 1, 0);
  std::vector<std::ptrdiff_t> kept;
  for (std::size_t n = 0; n < stays.size();) {
    const auto [own, first] = stays[n];
    const Cell cell = first->cell;
    Integral sum;
    for (; n < stays.size() && stays[n].first == own; ++n) sum.add(stays[n].second->integral);
    for (double& w : sum.weight) w /= sum.length;
    if (keep_interior(sum.weight, cell.i, cell.j, lattice.nx, lattice.ny) < kLeastInterior)
      continue;
    cuts.column.push_back(cell.i);
    cuts.weight.push_back(sum.weight);
    cuts.length.push_back(sum.length);
    cuts.wanted.push_back((1.0 / sum.length) * sum.wanted);
    cuts.compliance.push_back(std::isinf(sum.stiffness) ? 0.0 : 1.0 / sum.stiffness);
    ++cuts.row_begin[std::size_t(cell.j) + 1];
    kept.push_back(own);
  }
  for (std::size_t j = 0; j < std::size_t(lattice.ny); ++j)
    cuts.row_begin[j + 1] += cuts.row_begin[j];
  std::vector<std::array<int, 2>> pairs;
  auto find = [&](std::ptrdiff_t cell) {
    const auto at = std::ranges::lower_bound(kept, cell);
    return at != kept.end() && *at == cell ? int(at - kept.begin()) : -1;
  };
  for (const auto& curve : curves)
    for (const auto& [a, b] : curve->followers) {
      const int k = find(a), l = find(b);
      if (k >= 0 && l >= 0) pairs.push_back({k, l});
    }
  set_links(cuts, pairs);
  return cuts;
}

}  // namespace

CutCells cut(const std::vector<CurvePair>& curves, const Lattice& lattice, double most_weight) {
  Cutter cutter(lattice, most_weight);
  std::vector<std::unique_ptr<const CutCurve>> cut;
  for (const CurvePair& curve : curves)
    cut.push_back(std::make_unique<const CutCurve>(cutter.cut(curve)));
  return join(cut, lattice);
}

struct CurveCutter::Kept {
  Lattice lattice;
  double most_weight;
  MadeOfCurves<CutCurve> curves;
};

CurveCutter::CurveCutter(const Lattice& lattice, double most_weight)
    : kept_(std::make_unique<Kept>(Kept{lattice, most_weight, {}})) {}

CurveCutter::~CurveCutter() = default;

CutCells CurveCutter::cut(const std::vector<CurvePair>& curves) {
  Cutter cutter(kept_->lattice, kept_->most_weight);
  return join(kept_->curves.of(curves, [&](const CurvePair& curve) { return cutter.cut(curve); }),
              kept_->lattice);
}

namespace {

/// Coarse cuts that follow one another because children of theirs do.
std::vector<std::array<int, 2>> coarse_pairs(const CutCells& fine, const std::vector<int>& parent) {
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t k = 0; k < std::size_t(fine.size()); ++k)
    for (int l = fine.link_begin[k]; l < fine.link_begin[k + 1]; ++l) {
      const int p = parent[k], q = parent[std::size_t(fine.link[std::size_t(l)])];
      if (p >= 0 && q >= 0 && p < q) pairs.push_back({p, q});
    }
  return pairs;
}

}  // namespace

CoarseCuts coarsen(const CutCells& fine, int nx, int ny) {
  const int coarse_nx = coarse_cells(nx), coarse_ny = coarse_cells(ny);
  CoarseCuts out;
  out.parent.assign(std::size_t(fine.size()), -1);
  out.share.assign(std::size_t(fine.size()), 0.0);
  CutCells& cuts = out.cuts;
  cuts.row_begin.assign(std::size_t(coarse_ny) + 1, 0);
  for (int j = 0; j < coarse_ny; ++j) {
    // Children of this row in order of their parents' columns.
    std::vector<std::array<int, 3>> children;  // parent column, cut, fine row
    for (int row = 2 * j; row < std::min(2 * j + 2, ny); ++row)
      for (int k = fine.row_begin[std::size_t(row)]; k < fine.row_begin[std::size_t(row) + 1]; ++k)
        children.push_back({fine.column[std::size_t(k)] / 2, k, row});
    std::ranges::sort(children);
    for (std::size_t n = 0; n < children.size();) {
      const std::size_t first = n;
      const int i = children[n][0];
      double length = 0.0, compliance = 0.0;
      Point wanted;
      std::array<double, 4> weight{};
      for (; n < children.size() && children[n][0] == i; ++n) {
        const std::size_t k = std::size_t(children[n][1]);
        const int a = fine.column[k] & 1, b = children[n][2] & 1;
        const double len = fine.length[k];
        length += len;
        wanted = wanted + len * fine.wanted[k];
        compliance += len * len * fine.compliance[k];
        for (int c = 0; c < 4; ++c) {  // the child's corners at quarters of the parent
          const double x = 0.5 * (a + (c & 1)), y = 0.5 * (b + (c >> 1));
          const double w = len * fine.weight[k][std::size_t(c)];
          weight[0] += w * (1 - x) * (1 - y);
          weight[1] += w * x * (1 - y);
          weight[2] += w * (1 - x) * y;
          weight[3] += w * x * y;
        }
      }
      for (double& w : weight) w /= length;
      if (keep_interior(weight, i, j, coarse_nx, coarse_ny) < kLeastInterior) continue;
      for (std::size_t c = first; c < n; ++c) {
        const std::size_t k = std::size_t(children[c][1]);
        out.parent[k] = cuts.size();
        out.share[k] = fine.length[k] / length;
      }
      cuts.column.push_back(i);
      cuts.weight.push_back(weight);
      cuts.length.push_back(length);
      cuts.wanted.push_back((1.0 / length) * wanted);
      cuts.compliance.push_back(compliance / (length * length));
      ++cuts.row_begin[std::size_t(j) + 1];
    }
  }
  for (std::size_t j = 0; j < std::size_t(coarse_ny); ++j)
    cuts.row_begin[j + 1] += cuts.row_begin[j];
  std::vector<std::array<int, 2>> pairs = coarse_pairs(fine, out.parent);
  set_links(cuts, pairs);
  return out;
}

}  // namespace drumhead::grid
