// SPDX-License-Identifier: MIT
#include <drumhead/grid/conforming.h>

#include <drumhead/kernels/refuse.h>
#include <algorithm>
#include <cassert>
#include <span>

#include "curve_nodes.h"
#include "held_nodes.h"
#include "made_of_curves.h"
#include "split_cell.h"

namespace drumhead::grid {
namespace {

class Conformer {
 public:
  Conformer(const std::vector<double>& weights, const CurveWalks& walks, const Lattice& lattice,
            const ConformOptions& options)
      : weights_(weights), lattice_(lattice), options_(options), walks_(walks) {}

  ConformingCells run() {
    while (!assemble()) {
    }
    list_nodes();
    visits_ = NodeVisits(std::move(nodes_.visits));
    hold_nodes(visits_, weights_, lattice_, cells_);
    for (const auto& [number, how] : simplified_)
      cells_.simplified_cells.push_back(
          {double(number % lattice_.nx) + 0.5, double(number / lattice_.nx) + 0.5});
    cells_.lost_tips = nodes_.lost_tips;
    return std::move(cells_);
  }
  /// After `run`: what the cells need for other targets.
  NodeVisits visits() { return std::move(visits_); }

 private:
  Vertex lattice_node(int i, int j) const { return Vertex(j) * (lattice_.nx + 1) + i; }
  Vertex first_curve_node() const { return lattice_node(0, lattice_.ny + 1); }
  std::int64_t cell_number(CellIndex c) const { return std::int64_t(c.j) * lattice_.nx + c.i; }

  bool assemble();
  std::vector<std::int64_t> special_cells() const;
  void go_on(CellIndex cell);
  int held_corner(CellIndex cell, int code) const;
  void set_outline(CellIndex cell);
  bool add_cell(CellIndex cell, std::span<const Chord> chords);
  void list_nodes();

  const std::vector<double>& weights_;
  const Lattice& lattice_;
  const ConformOptions& options_;
  const CurveWalks& walks_;
  SimplifiedCells simplified_;
  CurveNodes nodes_;
  NodeVisits visits_;
  std::size_t edge_nodes_ = 0;  // curve nodes on edges; the ones in cells follow
  // Of the cell at hand, in its lower and its upper row: see go_on.
  std::array<std::size_t, 2> held_at_{}, edge_at_{};
  std::array<int, 4> corner_{};  // as ConformingCells::cell_corner
  std::vector<CellVertex> outline_;
  CellSplit split_{first_curve_node(), nodes_};
  ConformingCells cells_;
};

/// Places the nodes and splits all special cells; false if some had to be simplified.
bool Conformer::assemble() {
  nodes_ = place_nodes(walks_, weights_, lattice_, options_.snap, simplified_);
  edge_nodes_ = nodes_.edge.size();
  held_at_ = edge_at_ = {};
  cells_ = {};
  cells_.nx = lattice_.nx;
  cells_.ny = lattice_.ny;
  cells_.cell_begin.assign(std::size_t(lattice_.ny) + 1, 0);
  cells_.part_begin = cells_.part_node_begin = cells_.part_triangle_begin = {0};
  std::vector<Chord>& chords = nodes_.chords;
  std::ranges::stable_sort(chords, {}, [&](const Chord& c) { return cell_number(c.cell); });
  auto next = chords.begin();
  bool good = true;
  const std::vector<std::int64_t> numbers = special_cells();
  cells_.cell_column.reserve(numbers.size());
  cells_.cell_corner.reserve(numbers.size());
  cells_.triangle.reserve(4 * numbers.size());  // most cells have two parts of four corners
  cells_.part_node.reserve(8 * numbers.size());
  cells_.part_area.reserve(2 * numbers.size());
  cells_.part_centre.reserve(2 * numbers.size());
  for (const std::int64_t number : numbers) {
    const CellIndex cell{int(number % lattice_.nx), int(number / lattice_.nx)};
    const auto first = next;
    while (next != chords.end() && cell_number(next->cell) <= number) ++next;
    go_on(cell);
    if (add_cell(cell, {first, next})) continue;
    good = false;
    Simplified& level = simplified_[number];
    assert(level != Simplified::at_rest);
    level = Simplified(int(level) + 1);
  }
  for (std::size_t j = 0; j < std::size_t(lattice_.ny); ++j)
    cells_.cell_begin[j + 1] += cells_.cell_begin[j];
  return good;
}

/// Cells with a chord, a curve node or a moved corner, ascending.
std::vector<std::int64_t> Conformer::special_cells() const {
  std::vector<std::int64_t> numbers;
  auto add = [&](int i, int j) {
    if (i >= 0 && j >= 0 && i < lattice_.nx && j < lattice_.ny)
      numbers.push_back(cell_number({i, j}));
  };
  for (std::size_t n = 0; n < nodes_.held.size(); ++n) {
    const int i = int(nodes_.held[n] % (lattice_.nx + 1)),
              j = int(nodes_.held[n] / (lattice_.nx + 1));
    if (nodes_.held_rest[n] == Point{double(i), double(j)}) continue;
    for (int c = 0; c < 4; ++c) add(i - (c & 1), j - (c >> 1));
  }
  for (std::size_t k = 0; k < edge_nodes_; ++k) {
    const CellIndex c = nodes_.cell[k];
    add(c.i, c.j);
    nodes_.edge[k] % 2 ? add(c.i - 1, c.j) : add(c.i, c.j - 1);
  }
  for (const Chord& chord : nodes_.chords) add(chord.cell.i, chord.cell.j);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Special cells come in order, and so does what is looked for: index of the first value that is
/// not below `wanted`, going on from `from`.
template <class Value>
std::size_t go_to(const std::vector<Value>& values, std::size_t end, std::size_t from,
                  Value wanted) {
  while (from < end && values[from] < wanted) ++from;
  return from;
}

/// Moves the places in the lists of held nodes and of nodes on edges on to those of a cell.
void Conformer::go_on(CellIndex cell) {
  const Vertex low = lattice_node(cell.i, cell.j), high = lattice_node(cell.i, cell.j + 1);
  held_at_ = {go_to(nodes_.held, nodes_.held.size(), held_at_[0], low),
              go_to(nodes_.held, nodes_.held.size(), held_at_[1], high)};
  edge_at_ = {go_to(nodes_.edge, edge_nodes_, edge_at_[0], 2 * low),
              go_to(nodes_.edge, edge_nodes_, edge_at_[1], 2 * high)};
}

/// Number in the list of held nodes of a corner of the cell that `go_on` went to, −1: not held.
int Conformer::held_corner(CellIndex cell, int code) const {
  const Vertex node = lattice_node(cell.i + (code & 1), cell.j + (code >> 1));
  const std::size_t at =
      go_to(nodes_.held, nodes_.held.size(), held_at_[std::size_t(code >> 1)], node);
  return at < nodes_.held.size() && nodes_.held[at] == node ? int(at) : -1;
}

void Conformer::set_outline(CellIndex cell) {
  std::vector<CellVertex>& vertices = outline_;
  vertices.clear();
  auto corner = [&](int code, unsigned sides) {
    const int i = cell.i + (code & 1), j = cell.j + (code >> 1);
    const int held = corner_[std::size_t(code)] = held_corner(cell, code);
    const Point rest = held < 0 ? Point{double(i), double(j)} : nodes_.held_rest[std::size_t(held)];
    const bool edge = i == 0 || j == 0 || i == lattice_.nx || j == lattice_.ny;
    vertices.push_back({lattice_node(i, j), code, rest, sides, held >= 0 || edge});
  };
  auto side = [&](EdgeIndex edge, unsigned bit, bool backwards) {
    const std::size_t first = vertices.size();
    for (std::size_t k = go_to(nodes_.edge, edge_nodes_, edge_at_[bit == 4], edge);
         k < edge_nodes_ && nodes_.edge[k] == edge; ++k)
      vertices.push_back(
          {first_curve_node() + Vertex(k), 4 + int(k), nodes_.curve_rest[k], bit, true});
    if (backwards) std::reverse(vertices.begin() + std::ptrdiff_t(first), vertices.end());
  };
  const Vertex node = lattice_node(cell.i, cell.j);
  corner(0, 1 | 8);
  side(2 * node, 1, false);
  corner(1, 1 | 2);
  side(2 * (node + 1) + 1, 2, false);
  corner(3, 2 | 4);
  side(2 * (node + lattice_.nx + 1), 4, true);
  corner(2, 4 | 8);
  side(2 * node + 1, 8, true);
}

/// Appends a special cell; a cell that is whole and in its place stays regular.
bool Conformer::add_cell(CellIndex cell, std::span<const Chord> chords) {
  set_outline(cell);
  split_.begin(cell, outline_);
  for (const Chord& chord : chords)
    if (!split_.add(chord)) return false;
  const bool whole = split_.parts() == 1 && outline_.size() == 4;
  const bool in_place = std::ranges::all_of(outline_, [&](const CellVertex& v) {
    return v.rest == Point{double(cell.i + (v.code & 1)), double(cell.j + (v.code >> 1))};
  });
  if (whole && in_place) return true;
  for (int p = 0; p < split_.parts(); ++p) {
    const std::span<const int> part = split_.part(p);
    const std::size_t first = cells_.triangle.size();
    if (!split_.triangulate(part, cells_.triangle)) return false;
    double area = 0.0;
    Point moment;
    for (std::size_t t = first; t < cells_.triangle.size(); ++t) {
      const PartTriangle& triangle = cells_.triangle[t];
      area += triangle.area;
      for (const int n : triangle.node)
        moment = moment +
                 (triangle.area / 3.0) * split_.vertices()[std::size_t(part[std::size_t(n)])].rest;
    }
    for (const int n : part) cells_.part_node.push_back(split_.vertices()[std::size_t(n)].code);
    cells_.part_node_begin.push_back(int(cells_.part_node.size()));
    cells_.part_triangle_begin.push_back(int(cells_.triangle.size()));
    cells_.part_area.push_back(area);
    cells_.part_centre.push_back((1.0 / area) * moment);
  }
  cells_.cell_corner.push_back(corner_);
  cells_.cell_column.push_back(cell.i);
  cells_.part_begin.push_back(cells_.parts());
  ++cells_.cell_begin[std::size_t(cell.j) + 1];
  return true;
}

/// Lists the held nodes in their places.
void Conformer::list_nodes() {
  cells_.node_begin.assign(std::size_t(lattice_.ny) + 2, 0);
  cells_.node.reserve(nodes_.held.size());
  cells_.curve_node.reserve(nodes_.cell.size());
  for (std::size_t n = 0; n < nodes_.held.size(); ++n) {
    cells_.node.push_back({.rest = nodes_.held_rest[n], .wanted = {}});
    cells_.node_column.push_back(int(nodes_.held[n] % (lattice_.nx + 1)));
    ++cells_.node_begin[std::size_t(nodes_.held[n] / (lattice_.nx + 1)) + 1];
  }
  for (std::size_t j = 0; j + 1 < cells_.node_begin.size(); ++j)
    cells_.node_begin[j + 1] += cells_.node_begin[j];
  cells_.curve_cell.reserve(nodes_.cell.size());
  for (std::size_t k = 0; k < nodes_.cell.size(); ++k) {
    cells_.curve_node.push_back({.rest = nodes_.curve_rest[k], .wanted = {}});
    cells_.curve_cell.push_back({nodes_.cell[k].i, nodes_.cell[k].j});
    const EdgeIndex edge = nodes_.edge[k];
    cells_.curve_place.push_back(edge == kNoEdge
                                     ? NodePlace::in_cell
                                     : (edge % 2 ? NodePlace::on_y_edge : NodePlace::on_x_edge));
  }
}

}  // namespace

namespace {

void check_snap(const ConformOptions& options) {
  if (!(options.snap > 0.0 && options.snap <= 0.25))
    kernels::refuse("snap", options.snap, "above 0 and at most 0.25");
}

std::vector<double> weights_of(const std::vector<CurvePair>& curves) {
  std::vector<double> weights;
  for (const CurvePair& curve : curves) {
    if (!(curve.weight > 0.0))
      kernels::refuse("curve '" + curve.name + "': weight", curve.weight,
                      "positive (infinity allowed)");
    weights.push_back(curve.weight);
  }
  return weights;
}

}  // namespace

std::vector<ConformingCells> conform_levels(const std::vector<CurvePair>& curves,
                                            const Lattice& lattice, int levels,
                                            const ConformOptions& options) {
  check_snap(options);
  const std::vector<double> weights = weights_of(curves);
  std::vector<CurveWalk> walks;
  CurveWalks pointers;
  for (const CurvePair& curve : curves) walks.push_back(walk(curve, lattice));
  for (const CurveWalk& walk : walks) pointers.push_back(&walk);
  std::vector<ConformingCells> cells;
  for (Lattice on_level = lattice; int(cells.size()) < levels;) {
    cells.push_back(Conformer(weights, pointers, on_level, options).run());
    for (CurveWalk& walk : walks) walk = coarsened(walk, on_level);
    on_level = coarsened(on_level);
  }
  return cells;
}

using WalksOfCurve = std::vector<CurveWalk>;  // level by level

struct CurveConformer::Kept {
  std::vector<Lattice> lattices;
  ConformOptions options;
  MadeOfCurves<WalksOfCurve> made;
  MadeOfCurves<WalksOfCurve>::Pointers walks;  // of the last curves
  std::vector<double> weights;                 // of the last curves
  std::vector<NodeVisits> visits;              // per level

  CurveWalks on_level(std::size_t l) const {
    CurveWalks out;
    for (const auto& walk : walks) out.push_back(&(*walk)[l]);
    return out;
  }
};

CurveConformer::CurveConformer(const Lattice& lattice, int levels, const ConformOptions& options)
    : kept_(std::make_unique<Kept>()) {
  check_snap(options);
  kept_->options = options;
  kept_->lattices = {lattice};
  while (int(kept_->lattices.size()) < levels)
    kept_->lattices.push_back(coarsened(kept_->lattices.back()));
}

CurveConformer::~CurveConformer() = default;

std::vector<ConformingCells> CurveConformer::conform(const std::vector<CurvePair>& curves) {
  std::vector<double> weights = weights_of(curves);
  auto walks = kept_->made.of(curves, [&](const CurvePair& curve) {
    WalksOfCurve levels{walk(curve, kept_->lattices.front())};
    for (std::size_t l = 0; l + 1 < kept_->lattices.size(); ++l)
      levels.push_back(coarsened(levels.back(), kept_->lattices[l]));
    return levels;
  });
  const bool same = !kept_->visits.empty() && weights == kept_->weights &&
                    std::ranges::equal(walks, kept_->walks, [](const auto& a, const auto& b) {
                      return a == b || std::ranges::equal(*a, *b, same_source);
                    });
  kept_->walks = std::move(walks);
  kept_->weights = std::move(weights);
  std::vector<ConformingCells> cells;
  if (same) return cells;
  kept_->visits.clear();
  for (std::size_t l = 0; l < kept_->lattices.size(); ++l) {
    const CurveWalks on_level = kept_->on_level(l);
    Conformer conformer(kept_->weights, on_level, kept_->lattices[l], kept_->options);
    cells.push_back(conformer.run());
    kept_->visits.push_back(conformer.visits());
  }
  return cells;
}

void CurveConformer::retarget(int level, ConformingCells& cells) {
  const std::size_t l = std::size_t(level);
  kept_->visits[l].retarget(kept_->on_level(l));
  hold_nodes(kept_->visits[l], kept_->weights, kept_->lattices[l], cells);
}

ConformingCells conform(const std::vector<CurvePair>& curves, const Lattice& lattice,
                        const ConformOptions& options) {
  return std::move(conform_levels(curves, lattice, 1, options).front());
}

Lattice coarsened(const Lattice& fine) {
  Lattice coarse = fine;
  coarse.nx = coarse_cells(fine.nx);
  coarse.ny = coarse_cells(fine.ny);
  coarse.cell_px = 2.0 * fine.cell_px;
  return coarse;
}

int ConformingCells::find_cell(int i, int j) const {
  const auto begin = cell_column.begin() + cell_begin[std::size_t(j)],
             end = cell_column.begin() + cell_begin[std::size_t(j) + 1];
  const auto at = std::lower_bound(begin, end, i);
  return at != end && *at == i ? int(at - cell_column.begin()) : -1;
}

int ConformingCells::find_node(int i, int j) const {
  const auto begin = node_column.begin() + node_begin[std::size_t(j)],
             end = node_column.begin() + node_begin[std::size_t(j) + 1];
  const auto at = std::lower_bound(begin, end, i);
  return at != end && *at == i ? int(at - node_column.begin()) : -1;
}

int ConformingCells::part_at(int c, int j, Point at) const {
  int nearest = part_begin[std::size_t(c)];
  if (part_begin[std::size_t(c) + 1] == nearest + 1) return nearest;
  double best = -1e300;             // the least barycentric coordinate: how far inside the triangle
  constexpr double kInside = 1e-6;  // in no other triangle then
  for (int p = part_begin[std::size_t(c)]; p < part_begin[std::size_t(c) + 1]; ++p)
    for (int t = part_triangle_begin[std::size_t(p)]; t < part_triangle_begin[std::size_t(p) + 1];
         ++t) {
      const PartTriangle& tri = triangle[std::size_t(t)];
      double least = 1.0;
      for (std::size_t n = 0; n < 3 && least > best; ++n) {
        const int code = part_node[std::size_t(part_node_begin[std::size_t(p)] + tri.node[n])];
        least = std::min(least, 1.0 + dot(tri.gradient[n], at - rest(c, j, code)));
      }
      if (least <= best) continue;
      best = least;
      nearest = p;
      if (best > kInside) return p;
    }
  return nearest;
}

}  // namespace drumhead::grid
