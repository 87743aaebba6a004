// SPDX-License-Identifier: MIT
#include "split_cell.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace drumhead::grid {
namespace {

// A chord that passes a held node nearer than this (in cells) goes through it.
constexpr double kThrough = 0.1;
// Least quality 4 √3 A / Σ edge² of a triangle, 1 where it is equilateral.
constexpr double kLeastQuality = 0.01;
constexpr int kMostPieces = 24;  // of one chord

double quality(Point a, Point b, Point c) {
  const Point ab = b - a, bc = c - b, ca = a - c;
  const double twice = cross(ab, c - a);
  return 2.0 * std::sqrt(3.0) * twice / (dot(ab, ab) + dot(bc, bc) + dot(ca, ca));
}

PartTriangle triangle(std::array<int, 3> node, Point a, Point b, Point c) {
  const double twice = cross(b - a, c - a);
  auto gradient = [&](Point from, Point to) {  // of the corner opposite to this edge
    return Point{(from.y - to.y) / twice, (to.x - from.x) / twice};
  };
  return {node, 0.5 * twice, {gradient(b, c), gradient(c, a), gradient(a, b)}};
}

}  // namespace

void CellSplit::begin(CellIndex cell, const std::vector<CellVertex>& outline) {
  cell_ = cell;
  vertices_ = outline;
  loops_.resize(outline.size());
  std::iota(loops_.begin(), loops_.end(), 0);
  parts_.assign(1, {0, loops_.size()});
  pieces_.clear();
}

int CellSplit::find(Vertex vertex) const {
  const auto at = std::ranges::find(vertices_, vertex, &CellVertex::vertex);
  return at == vertices_.end() ? -1 : int(at - vertices_.begin());
}

bool CellSplit::add(const Chord& chord) {
  const int a = find(nodes_.visits[std::size_t(chord.from)].vertex),
            b = find(nodes_.visits[std::size_t(chord.to)].vertex);
  return a >= 0 && b >= 0 && join(a, b, chord.from, chord.to, 0);
}

/// Splits along the piece a–b of a chord between two visits.
bool CellSplit::join(int a, int b, int from, int to, int depth) {
  if (depth > kMostPieces) return false;
  // A piece between two nodes of one side follows the side.
  if (a == b || (vertices_[std::size_t(a)].sides & vertices_[std::size_t(b)].sides) != 0)
    return true;
  double lambda = 0.0;
  const int near = vertex_near(a, b, lambda);
  if (near >= 0) {
    const int visit = visit_between(from, to, lambda, vertices_[std::size_t(near)]);
    return join(a, near, from, visit, depth + 1) && join(near, b, visit, to, depth + 1);
  }
  return split_common_part(a, b, from, to) || cross(a, b, from, to, depth);
}

/// The held vertex that a–b passes most closely, −1 if none is near, and where it does.
int CellSplit::vertex_near(int a, int b, double& lambda) const {
  const Point start = vertices_[std::size_t(a)].rest;
  const Point way = vertices_[std::size_t(b)].rest - start;
  int nearest = -1;
  double least = kThrough;
  for (std::size_t n = 0; n < vertices_.size(); ++n) {
    if (int(n) == a || int(n) == b || !vertices_[n].held) continue;
    const Point to = vertices_[n].rest - start;
    const double along = dot(to, way) / dot(way, way);
    const double distance = length(to - along * way);
    if (along <= 0.0 || along >= 1.0 || distance >= least) continue;
    least = distance;
    nearest = int(n);
    lambda = along;
  }
  return nearest;
}

/// A visit of a chord's curve at a node on it, whose arcs come from those of the ends.
int CellSplit::visit_between(int from, int to, double lambda, const CellVertex& at) {
  Visit& start = nodes_.visits[std::size_t(from)];
  Visit& end = nodes_.visits[std::size_t(to)];
  const double half = 0.5 * length(end.source - start.source);
  start.arc = std::max(0.0, start.arc - (1.0 - lambda) * half);
  end.arc = std::max(0.0, end.arc - lambda * half);
  const Visit visit{at.vertex,
                    start.curve,
                    (1.0 - lambda) * start.source + lambda * end.source,
                    (1.0 - lambda) * start.displacement + lambda * end.displacement,
                    half,
                    -1,
                    from,
                    to,
                    lambda};
  nodes_.visits.push_back(visit);
  return int(nodes_.visits.size()) - 1;
}

bool CellSplit::split_common_part(int a, int b, int from, int to) {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const auto [begin, end] = parts_[p];
    const std::span<const int> part = loop(parts_[p]);
    const auto at_a = std::ranges::find(part, a), at_b = std::ranges::find(part, b);
    if (at_a == part.end() || at_b == part.end()) continue;
    const auto [low, high] = std::minmax({at_a - part.begin(), at_b - part.begin()});
    const std::size_t first = begin + std::size_t(low), second = begin + std::size_t(high);
    if (second - first == 1 || second - first == end - begin - 1)
      return true;  // a chord of another branch
    const std::size_t far = loops_.size();
    for (std::size_t n = second; n < end; ++n) loops_.push_back(int(loops_[n]));
    for (std::size_t n = begin; n <= first; ++n) loops_.push_back(int(loops_[n]));
    parts_[p] = {first, second + 1};
    parts_.push_back({far, loops_.size()});
    pieces_.push_back({a, b, from, to});
    return true;
  }
  return false;
}

/// a–b crosses a piece of another chord: both meet in a new node there.
bool CellSplit::cross(int a, int b, int from, int to, int depth) {
  const Point start = vertices_[std::size_t(a)].rest;
  const Point way = vertices_[std::size_t(b)].rest - start;
  std::size_t crossed = pieces_.size();
  double first = 1.0, on_piece = 0.0;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    const Piece& piece = pieces_[n];
    const Point p = vertices_[std::size_t(piece.a)].rest;
    const Point along = vertices_[std::size_t(piece.b)].rest - p;
    const double bottom = grid::cross(way, along);
    if (bottom == 0.0 || piece.a == a || piece.b == a || piece.a == b || piece.b == b) continue;
    const double lambda = grid::cross(p - start, along) / bottom;
    const double mu = grid::cross(p - start, way) / bottom;
    if (lambda <= 0.0 || lambda >= first || mu <= 0.0 || mu >= 1.0) continue;
    first = lambda;
    on_piece = mu;
    crossed = n;
  }
  if (crossed == pieces_.size()) return false;
  const Piece piece = pieces_[crossed];
  const CellVertex node{first_curve_node_ + Vertex(nodes_.edge.size()), 4 + int(nodes_.edge.size()),
                        start + first * way, 0, true};
  nodes_.edge.push_back(kNoEdge);
  nodes_.cell.push_back(cell_);
  nodes_.curve_rest.push_back(node.rest);
  const int x = int(vertices_.size());
  vertices_.push_back(node);
  for (Part& part : parts_)
    for (std::size_t n = part.begin; n < part.end; ++n) {
      const std::size_t next = n + 1 < part.end ? n + 1 : part.begin;
      if (std::minmax(int(loops_[n]), int(loops_[next])) != std::minmax(piece.a, piece.b)) continue;
      const std::size_t begin = loops_.size();
      for (std::size_t k = part.begin; k < part.end; ++k) {
        loops_.push_back(int(loops_[k]));
        if (k == n) loops_.push_back(x);
      }
      part = {begin, loops_.size()};
      break;
    }
  const int other = visit_between(piece.from, piece.to, on_piece, node);
  pieces_[crossed] = {piece.a, x, piece.from, other};
  pieces_.push_back({x, piece.b, other, piece.to});
  const int visit = visit_between(from, to, first, node);
  return split_common_part(a, x, from, visit) && join(x, b, visit, to, depth + 1);
}

bool CellSplit::triangulate(std::span<const int> part, std::vector<PartTriangle>& out) const {
  const int count = int(part.size());
  if (count < 3 || count > kMostPartNodes) return false;
  auto at = [&](int n) { return vertices_[std::size_t(part[std::size_t(n)])].rest; };
  // best[a][b]: the least quality of the best triangulation of vertices a … b; split[a][b]: the
  // third corner of its triangle on a–b.
  std::array<std::array<double, kMostPartNodes>, kMostPartNodes> best;
  std::array<std::array<int, kMostPartNodes>, kMostPartNodes> split;
  for (int width = 1; width < count; ++width)
    for (int a = 0; a + width < count; ++a) {
      const std::size_t b = std::size_t(a + width);
      best[std::size_t(a)][b] = width == 1 ? 1.0 : -1.0;
      for (int k = a + 1; k < int(b); ++k) {
        const double least = std::min({best[std::size_t(a)][std::size_t(k)],
                                       best[std::size_t(k)][b], quality(at(a), at(k), at(int(b)))});
        if (least <= best[std::size_t(a)][b]) continue;
        best[std::size_t(a)][b] = least;
        split[std::size_t(a)][b] = k;
      }
    }
  if (best[0][std::size_t(count - 1)] < kLeastQuality) return false;
  auto add = [&](auto& self, int a, int b) {
    if (b - a < 2) return;
    const int k = split[std::size_t(a)][std::size_t(b)];
    out.push_back(triangle({a, k, b}, at(a), at(k), at(b)));
    self(self, k, b);
    self(self, a, k);
  };
  add(add, 0, count - 1);
  return true;
}

}  // namespace drumhead::grid
