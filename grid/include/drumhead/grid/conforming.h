// SPDX-License-Identifier: MIT
#pragma once
// Conforming cut cells: the second-order way to meet curves (the averaged rows of cut_cells.h are
// first order, because a bilinear cell cannot hold the kink that a curve makes). The curves become
// chains of chords between nodes: lattice nodes whose rest position moves onto the curve, and curve
// nodes where a curve crosses a lattice edge. Cells that hold a chord, a curve node or a moved
// corner are special: they are split along the chords into parts and the parts into triangles (P1).
// All other cells stay as they are. On every lattice of a hierarchy the construction is made anew
// from the curves.
//
// Rules (h: side of a cell):
//  1. A curve is the sequence of its crossings with lattice edges, its tips and its sharp corners
//     (more than 30°); two consecutive crossings of one edge cancel. A tip or corner moves the
//     nearest inner node of its cell that none other has, by at most .75 h along each axis; a tip
//     within h/4 of the outer boundary ends on it.
//  2. An inner node whose nearest crossing on its four edges lies within snap·h moves there. Nodes
//     of the outer boundary never move. A moved node takes over the other crossings of its edges up
//     to snap·h beyond its own place along the edge, a boundary node those within h/20.
//  3. Crossings of one edge closer than snap·h to the first of them become one curve node, at the
//     middle one.
//  4. Chords of different branches that cross in a cell meet in a curve node inside the cell; a
//     chord that passes a held node by less than h/10 goes through it.
//  5. A curve that crosses nothing holds the inner node nearest to its middle.
//  6. Where one node serves several branches, hard ones rule over soft ones. Branches whose
//     displacements differ by less than three times the distance of their points agree, and the
//     nearest one speaks for them; others contradict, the node takes the mean (of soft ones
//     weighted by stiffness), and the distance is kept as a conflict. On the outer boundary the
//     displacement is 0.
//  7. A cell whose parts have no triangulation of fit triangles, or more than kMostPartNodes nodes,
//     is simplified: first its tips and corners are given up, then its curve nodes are handed to
//     the nearest lattice node, at last its corners stay at rest. (0.3 % of the special cells of
//     4000 random scenes made to be awkward; none of the study scenes.)
// Energy of a part: mu/2 Σ A_t |F_t|² + P Σ A_t (J_t − 1) − A P²/(2 kappa): one P per side of the
// chord. Positions and displacements are in cells of the lattice at hand, node (0, 0) at the
// origin; displacements are deformed position − *rest position of the node*, moved or not, so that
// F_t = 1 + Σ u_a ∇N_a everywhere.
#include <array>
#include <limits>
#include <memory>
#include <vector>

#include <drumhead/grid/curve.h>
#include <drumhead/grid/lattice.h>

namespace drumhead::grid {

/// Nodes of a part at most; triangles of a part at most two fewer.
constexpr int kMostPartNodes = 8;

struct ConformOptions {
  /// In cells, (0, 0.25]. A moved node is known, so that less snapping leaves more unknowns and
  /// less stiffness at the curve; more makes better triangles, which nothing was found to need. RMS
  /// error in px of a picture of 1000 at .1, .15, .25: turned circle (S2) 50², kappa/mu 10: .76 .77
  /// .83, infinity: 1.36 1.50 1.86; 100²: .225 .228 .233 and .43 .56 .67; moved circle (S4) 50²,
  /// 10: .50 .56 .61. V(1,1) cycle at kappa 0, 128²: S2 .12 at .1, .17 at .25; S4 .11, .16. Below
  /// .1 errors stay as they are; above .25 they only grow (.4, one pressure a part, S2 50²
  /// 10: 1.16; .92 at .25).
  double snap = 0.1;
};

/// Where a curve node lies.
enum class NodePlace {
  on_x_edge,  ///< on the edge from node (i, j) to (i+1, j)
  on_y_edge,  ///< on the edge from node (i, j) to (i, j+1)
  in_cell     ///< inside cell (i, j): two branches cross there
};

/// A node that a curve holds: known if stiffness is infinite (the curve is hard, or the node lies
/// on the outer boundary), otherwise an unknown with the energy stiffness/2 |u − wanted|².
struct HeldNode {
  Point rest;    ///< rest position, in cells
  Point wanted;  ///< target − rest
  /// d in mu per cell times half the arcs that meet here; energy in mu·cells².
  double stiffness = std::numeric_limits<double>::infinity();
};

/// P1 triangle: a, b, c index the part's node list; gradients of the three shape functions.
struct PartTriangle {
  std::array<int, 3> node{};
  double area = 0.0;  ///< > 0, in cells²
  std::array<Point, 3> gradient{};
};

/// Several branches want one node.
struct HeldConflict {
  Point rest;             ///< in cells
  double distance = 0.0;  ///< between the displacements that are wanted, in cells
  int curve = 0, other_curve = 0;
};

/// Everything lies along the curves; lists are sorted by row, then column.
struct ConformingCells {
  int nx = 0, ny = 0;

  // Lattice nodes that curves hold: those of node row j are [node_begin[j], node_begin[j+1]).
  std::vector<int> node_begin;  ///< ny + 2
  std::vector<int> node_column;
  std::vector<HeldNode> node;

  // Curve nodes: the ones on edges and in cells, in no order that means anything.
  std::vector<HeldNode> curve_node;
  std::vector<NodePlace> curve_place;
  std::vector<std::array<int, 2>> curve_cell;  ///< i, j of curve_place

  // Special cells: those of cell row j are [cell_begin[j], cell_begin[j+1]).
  std::vector<int> cell_begin;  ///< ny + 1
  std::vector<int> cell_column;
  /// Index into `node` of corners 00, 10, 01, 11; −1: not held (at rest in its place; unknown, or
  /// fixed on the boundary).
  std::vector<std::array<int, 4>> cell_corner;
  std::vector<int> part_begin;  ///< cells + 1: parts of special cell c

  // Parts.
  std::vector<int> part_node_begin;  ///< parts + 1, at most kMostPartNodes each, counter-clockwise
  /// 0…3: corner 00, 10, 01, 11 of the cell; 4 + k: curve node k.
  std::vector<int> part_node;
  std::vector<int> part_triangle_begin;  ///< parts + 1
  std::vector<PartTriangle> triangle;
  std::vector<double> part_area;   ///< in cells²
  std::vector<Point> part_centre;  ///< its centroid

  std::vector<HeldConflict> conflicts;  ///< farther apart than 1e-6 cells
  std::vector<Point> simplified_cells;  ///< centres, in cells (rule 7)
  std::vector<Point> lost_tips;         ///< that hold no node (rule 7, or none was free), in cells

  int cells() const { return int(cell_column.size()); }
  int parts() const { return int(part_area.size()); }
  /// The special cell at (i, j), −1 if that cell is regular. Logarithmic in the row's length.
  int find_cell(int i, int j) const;
  /// The held lattice node at (i, j), −1 if none.
  int find_node(int i, int j) const;
  /// The part of special cell c in row j that contains a point (in cells), the nearest one if none
  /// does.
  int part_at(int c, int j, Point at) const;
  /// Rest position of node n of part p of special cell c in row j.
  Point rest(int c, int j, int code) const {
    if (code >= 4) return curve_node[std::size_t(code - 4)].rest;
    const int held = cell_corner[std::size_t(c)][std::size_t(code)];
    if (held >= 0) return node[std::size_t(held)].rest;
    return {double(cell_column[std::size_t(c)] + (code & 1)), double(j + (code >> 1))};
  }
};

/// Builds the cells that conform to the sources of `curves`. Linear in crossings and segments, and
/// independent of the number of cells. Pairs with equally many segments are taken as they are (see
/// `matched`). Throws std::invalid_argument naming curve, place and bound for a source that leaves
/// the lattice, for a weight that is not positive, for a snap outside (0, 0.25], and as `check`
/// of a curve does.
ConformingCells conform(const std::vector<CurvePair>& curves, const Lattice& lattice,
                        const ConformOptions& options = {});

/// The same on `lattice` and the next coarser ones, `levels` altogether, with one look at the
/// curves.
std::vector<ConformingCells> conform_levels(const std::vector<CurvePair>& curves,
                                            const Lattice& lattice, int levels,
                                            const ConformOptions& options = {});

/// Conforming cells of one scene after another, on a lattice and the next coarser ones, `levels`
/// altogether. Only curves that the scene before did not have are looked at; where all have the
/// same sources and weights, cells stay and only what their nodes are asked for is found anew.
class CurveConformer {
 public:
  /// Throws std::invalid_argument for a snap outside (0, 0.25].
  CurveConformer(const Lattice& lattice, int levels, const ConformOptions& options = {});
  ~CurveConformer();
  /// The cells of all levels, as `conform_levels` has them, which throws likewise; none where those
  /// of the curves before serve, once `retarget` has told them of the new targets.
  std::vector<ConformingCells> conform(const std::vector<CurvePair>& curves);
  /// Gives the cells of a level, as they came from `conform`, the targets of the last curves.
  void retarget(int level, ConformingCells& cells);

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

/// The next coarser lattice over the same place: cells of twice the side, an odd count rounded up
/// (the last cell overhangs the fixed edge).
Lattice coarsened(const Lattice& fine);

}  // namespace drumhead::grid
