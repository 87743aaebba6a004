// SPDX-License-Identifier: MIT
#pragma once
// Special cells: those that a curve passes through or moves a corner of, when the lattice conforms
// to the curves. Such a cell is divided along the curve into parts, each a polygon of at most eight
// vertices cut into triangles, and instead of Eq. 6 and 5 of Setaluri et al. 2014 it has
//   Σ_triangles mu A/2 |F|² + Σ_parts [P (A J − A) − A P²/(2 kappa)]
// with F constant on a triangle and A J the area of the deformed polygon: one pressure per side of
// the curve (one per cell is first order again, one per triangle locks). A part may have but one
// unknown corner, which its pressure would hold alone; so neighbours on the same side of the curve
// share what they resist, by a penalty on the jump of the pressure between them as in stabilised
// mixed elements (Kechkar and Silvester 1992),
//   −Σ_neighbours gamma/2 h²/(mu_a + mu_b) (P_a − P_b)²
// where both are parts of special cells; less where kappa jumps, too. Nodes that a curve holds
// have the energy stiffness/2 |u − wanted|² besides; those of a hard curve are *known*: their
// stiffness is infinite, their correction 0. Curve nodes of soft curves are unknowns beside the
// lattice (soft_nodes.h). Storage is proportional to the length of the curves.
//
// Every node of a special cell, and every known node, is *near*. The vectorised kernels pass over
// special cells and near nodes as if they were regular, and what they write there is overwritten (a
// relaxation: restored) by loops over the lists of this header, which hold whole rows of the
// operator. A plane's value at a special cell is therefore not part of any system; corrections keep
// 0 there.
//
// Isotropic membranes (model.h) have no pressures: their part with mu is taken at F of every
// triangle, that with kappa at the mean F of every part (the one-sided one of arap and fold-free,
// too, at every triangle, whose J it keeps above eps), and the rows of near nodes have 2×2 blocks.
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <drumhead/kernels/soft_nodes.h>
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// Vertices of triangles and parts: 0…3 are the corners 00, 10, 01, 11 of the cell, 4 + n is
/// crossing node n of the level.
constexpr int kFirstCrossing = 4;

template <class T>
struct Triangle {
  int vertex[3] = {};
  T area = T(0);             ///< at rest, > 0, in finest cells squared
  T gx[3] = {}, gy[3] = {};  ///< gradients of the barycentric coordinates
};

/// A vertex of a part's boundary.
template <class T>
struct PartVertex {
  int vertex = 0;
  T x = T(0), y = T(0);  ///< rest position from the cell's corner 00, in finest cells
};

/// What lies across a piece of a special cell's side, on the same side of the curves.
struct PartNeighbour {
  int part = -1;   ///< of another special cell; −1: a regular cell
  int vertex = 0;  ///< entry of SpecialCells::vertex at which the piece begins
  int side = 0;    ///< 0…3: south, east, north, west
};
/// A regular cell and a part that is its neighbour.
struct PartBorder {
  int column = 0;     ///< of the regular cell
  int part = 0;       ///< of the special cell
  int neighbour = 0;  ///< the part's entry of SpecialCells::neighbour
};

/// A node that a curve holds. Its displacement, in finest cells, is kept as that which is wanted
/// (target − rest position) and the rest, lest stiff springs see little but rounding.
template <class T>
struct HeldNode {
  int place = 0;  ///< column of a lattice node, row of a curve node
  T wanted_x = T(0), wanted_y = T(0);
  T stiffness = T(0);  ///< infinite: the node is known
  T off_x = T(0), off_y = T(0);

  bool known() const { return stiffness > std::numeric_limits<T>::max(); }
  T ux() const { return wanted_x + off_x; }
  T uy() const { return wanted_y + off_y; }
};

/// The special cells of one level, sorted by row, then column.
template <class T>
struct SpecialCells {
  std::vector<int> row_begin;  ///< ny + 1: cells of row j are [row_begin[j], row_begin[j+1])
  std::vector<int> column;
  std::vector<int> part_begin;      ///< cells + 1
  std::vector<int> triangle_begin;  ///< cells + 1
  std::vector<Triangle<T>> triangle;
  std::vector<int> vertex_begin;      ///< parts + 1
  std::vector<PartVertex<T>> vertex;  ///< in the sense 00, 10, 11, 01, which makes areas positive
  std::vector<T> area;                ///< of each part
  std::vector<int> neighbour_begin;   ///< parts + 1
  std::vector<PartNeighbour> neighbour;
  std::vector<int> border_begin;  ///< ny + 1, by the regular cell's row; sorted by column
  std::vector<PartBorder> border;
  std::vector<int> held_begin;  ///< ny + 2: lattice nodes of row j that curves hold, by column
  std::vector<HeldNode<T>> held;
  std::vector<HeldNode<T>> crossing;

  int size() const { return int(column.size()); }
  int parts() const { return int(area.size()); }
};

/// A near node that is no known one.
struct NearNode {
  int column = 0;
  int regular = 15;   ///< bit q set: the cell in quadrant q of sw, se, nw, ne is regular
  int diagonal = -1;  ///< its DiagonalRow; −1: none
};
/// Its row: the stencil west, east, south and north, and per quadrant the pressure of a regular
/// cell or of the part that the node belongs to. In the order of vectors, which a node's loop is
/// made of, and in floats 96 bytes.
template <class T>
struct alignas(32) NearRow {
  T k[4] = {};  ///< (H d)_x = own d_x + k·d_x + g·d_y, (H d)_y = own d_y + k·d_y − g·d_x
  T g[4] = {};
  T bx[4] = {}, by[4] = {};
  /// −1 − place: that of the cell in its row; the cell is regular, or the node no corner of a part.
  int part[4] = {-1, -1, -1, -1};
  int place = 0, west = 0;  ///< of the node and of its western neighbour in their row (row_place)
  T own = T(0);             ///< K_ii
  T inverse = T(0);         ///< 1/K_ii
};
/// What else the row of a near node has where triangles join it with unknown nodes across cells:
/// those in the south-west, south-east, north-west and north-east.
template <class T>
struct DiagonalRow {
  T k[4] = {}, g[4] = {};
};
/// The same of isotropic membranes: (H d)_x = xx·d_x + xy·d_y, (H d)_y = yx·d_x + yy·d_y.
template <class T>
struct BlockRow {
  T xx[9] = {}, xy[9] = {}, yx[9] = {}, yy[9] = {};
};
/// A regular cell with an unknown near node; `near`: numbers of those at its corners 00, 10, 01,
/// 11, −1: none.
struct FringeCell {
  int column = 0, row = 0;
  int near[4] = {-1, -1, -1, -1};
};
/// A part to which a near node belongs beyond one a quadrant: those that a soft curve's node
/// divides.
template <class T>
struct PartCoupling {
  int part = 0;
  T bx = T(0), by = T(0);
};
/// Row of a part: Σ bx d_x + by d_y over the cell's corners − compliance dP − Σ_neighbours jump_n
/// (dP − dP_n); 0 at known corners.
template <class T>
struct PartRow {
  T bx[4] = {}, by[4] = {};
  T compliance = T(0);  ///< A/kappa
  T jumps = T(0);       ///< Σ jump_n
  T inverse = T(0);  ///< 1/s of Kaczmarz's method: s = Σ (bx² + by²)/K_ii + compliance + jumps
  int column = 0;    ///< of its cell
};
/// Its first neighbours across the sides south, east, north, west.
template <class T>
struct PartJumps {
  T jump[4] = {};     ///< 0: none
  int part[4] = {};   ///< −1: a regular cell that it is joined with; the part itself: none
  bool more = false;  ///< it has more than one across a side
};
/// A regular cell and a part that is its neighbour.
template <class T>
struct BorderJump {
  int half = 0;  ///< of the regular cell's column, rounded down
  int part = 0;
  int neighbour = 0;  ///< the part's entry of SpecialCells::neighbour
  T jump = T(0);
};
/// A special cell as sweeps meet it.
template <class T>
struct CellVisit {
  int column = 0, part_begin = 0, part_end = 0;
  T inverse[4] = {};  ///< 1/K_ii of its corners; 0: known or on the fixed boundary
};

template <class T>
class CellState;

/// The operator's rows at near nodes and parts, linearised at a state.
template <class T>
class SpecialRows {
 public:
  SpecialRows() = default;
  /// The rows of `cells` (which must outlive this) with the stiffness of the membrane's lattice and
  /// mu; its state is not read.
  SpecialRows(const SpecialCells<T>& cells, const Membrane<T>& membrane);

  /// Sets what depends on the membrane's state, its pressures, their clamp and their jump.
  void linearise(const Membrane<T>& membrane);

  const SpecialCells<T>& cells() const { return *cells_; }
  /// Near nodes of node row j that are unknown, by column: [near_begin(j), near_begin(j + 1)).
  int near_begin(int j) const { return near_begin_[std::size_t(j)]; }
  /// Known nodes of node row j but those on the fixed boundary.
  Columns known(int j) const { return columns(known_, known_begin_, j); }
  /// Those of them that are a corner of a regular cell.
  Columns loose(int j) const { return columns(loose_, loose_begin_, j); }
  /// Half the column, rounded down, of the near nodes of node row j in columns of one parity.
  Columns near_half(int j, int parity) const {
    return columns(near_half_, near_half_begin_, 2 * j + parity);
  }
  /// Special cells of cell row j in columns of one parity.
  std::span<const CellVisit<T>> visits(int j, int parity) const {
    const int begin = visit_begin_[std::size_t(2 * j + parity)],
              end = visit_begin_[std::size_t(2 * j + parity) + 1];
    return {visit_.data() + begin, std::size_t(end - begin)};
  }
  /// Regular cells of cell row j in columns of one parity that have parts as neighbours, by column.
  std::span<const BorderJump<T>> borders(int j, int parity) const {
    const int begin = border_begin_[std::size_t(2 * j + parity)],
              end = border_begin_[std::size_t(2 * j + parity) + 1];
    return {border_.data() + begin, std::size_t(end - begin)};
  }
  /// Whether cell row j has neither special cells nor cells that their relaxation concerns.
  bool regular_row(int j) const {
    const auto none = [](const Columns& some) { return some.first == some.last; };
    const bool borders_none =
        !has_border_jumps_ || (borders(j, 0).empty() && borders(j, 1).empty());
    return visits(j, 0).empty() && visits(j, 1).empty() && none(loose(j)) && none(loose(j + 1)) &&
           borders_none;
  }
  const NearNode& near_node(int n) const { return near_node_[std::size_t(n)]; }
  const NearRow<T>& near(int n) const { return near_[std::size_t(n)]; }
  const DiagonalRow<T>& diagonal(int n) const { return diagonal_[std::size_t(n)]; }
  const PartRow<T>& part(int p) const { return part_[std::size_t(p)]; }
  /// Whether any neighbours are joined by a jump.
  bool has_jumps() const { return has_jumps_; }
  /// Strength of the jump at entry k of SpecialCells::neighbour.
  T jump(int k) const { return jump_[std::size_t(k)]; }
  /// Of that, what the equations have themselves (Membrane::part_jump).
  T own_jump(int k) const { return own_jump_.empty() ? T(0) : own_jump_[std::size_t(k)]; }
  /// Whether regular cells are joined with parts by jumps.
  bool has_border_jumps() const { return has_border_jumps_; }
  /// Of a part, where there are jumps.
  const PartJumps<T>& jumps(int p) const { return part_jumps_[std::size_t(p)]; }
  /// Whether there is anything that NearRow::part leaves out; where all curves are hard there is
  /// not.
  bool has_further() const { return !further_.empty(); }
  /// That of near node n.
  std::span<const PartCoupling<T>> further(int n) const {
    if (!has_further()) return {};
    const int begin = further_begin_[std::size_t(n)], end = further_begin_[std::size_t(n) + 1];
    return {further_.data() + begin, std::size_t(end - begin)};
  }
  /// Curve nodes of soft curves; null: none.
  const SoftRows<T>* soft() const { return soft_.size() > 0 ? &soft_ : nullptr; }
  /// Near node at corner c of special cell n; −1: known or on the fixed boundary.
  int unknown_corner(int n, int c) const { return corner_[4 * std::size_t(n) + std::size_t(c)]; }
  // Of isotropic membranes.
  const BlockRow<T>& block(int n) const { return block_[std::size_t(n)]; }
  const std::vector<FringeCell>& fringe() const { return fringe_; }
  /// Mean tangent of special cell n: ten entries (Membrane::tangent).
  const T* tangent(int n) const { return &tangent_[10 * std::size_t(n)]; }
  std::size_t bytes() const;

 private:
  static Columns columns(const std::vector<int>& list, const std::vector<int>& begin, int row) {
    return {list.data() + begin[std::size_t(row)], list.data() + begin[std::size_t(row) + 1]};
  }
  void list_near_nodes(int columns, int rows);
  void list_diagonals();
  DiagonalRow<T>* diagonals_of(int near);
  void list_fringe(int rows);
  void linearise_isotropic(const Membrane<T>& membrane);
  void list_couplings();
  void list_visits();
  void list_borders();
  void add_stiffness(const Membrane<T>& membrane);
  void linearise_regular(const Membrane<T>& membrane);
  void linearise_part(const Membrane<T>& membrane, const CellState<T>& u, int cell, int part,
                      int j);
  void set_own_jumps(const Membrane<T>& membrane);
  void clear_jumps(const Membrane<T>& membrane);
  void set_jumps(const Membrane<T>& membrane, const CellState<T>& u, std::size_t part, int i,
                 int j);
  T coarse_jump(const Membrane<T>& membrane, const CellState<T>& u, std::size_t part,
                const PartNeighbour& other, int i, int j) const;
  void set_steps(const Membrane<T>& membrane);

  const SpecialCells<T>* cells_ = nullptr;
  std::vector<int> near_begin_, corner_, known_, known_begin_, loose_, loose_begin_, near_half_,
      near_half_begin_, visit_begin_, border_begin_, further_begin_;
  std::vector<NearNode> near_node_;
  std::vector<NearRow<T>> near_;
  std::vector<DiagonalRow<T>> diagonal_;
  std::vector<CellVisit<T>> visit_;
  std::vector<PartRow<T>> part_;
  std::vector<T> jump_, own_jump_;
  std::vector<PartJumps<T>> part_jumps_;
  std::vector<BorderJump<T>> border_;
  std::vector<PartCoupling<T>> further_;
  std::vector<BlockRow<T>> block_;
  std::vector<FringeCell> fringe_;
  std::vector<T> tangent_;
  bool has_jumps_ = false, has_border_jumps_ = false;
  SoftRows<T> soft_;
};

/// How a level with special cells hangs together with the next coarser one, beyond the transfers of
/// regular lattices. Corrections go up by these weights, residuals down by the adjoint.
template <class T>
struct SpecialTransfer {
  /// A pressure below a coarse part, or of a part: constant prolongation. An index ≥ 0 is a part,
  /// ~index the column of a regular cell.
  struct Pair {
    int fine = 0, coarse = 0;
  };
  /// A node that lies in a special coarse cell: what its weights in the triangles of that cell are
  /// beyond the bilinear ones. `column`, `row`: the coarse cell; weights of its corners 00, 10, 01,
  /// 11.
  struct Node {
    int fine = 0, column = 0, row = 0;
    T weight[4] = {};
  };
  std::vector<int> pair_begin;  ///< fine ny + 1; the coarse row is half the fine one
  std::vector<Pair> pair;
  std::vector<int> node_begin;  ///< fine ny + 2
  std::vector<Node> node;

  // Where curves are soft: weights of coarse curve nodes in fine lattice nodes, and of coarse nodes
  // in fine curve nodes.
  struct OfNode {
    int fine = 0;    ///< column
    int coarse = 0;  ///< curve node
    T weight = T(0);
  };
  struct OfCurve {
    int fine = 0;             ///< curve node
    int column = 0, row = 0;  ///< coarse lattice node; row < 0: curve node `column`
    T weight = T(0);
  };
  std::vector<int> of_node_begin, of_curve_begin;  ///< fine ny + 2, or none
  std::vector<OfNode> of_node;
  std::vector<OfCurve> of_curve;
};

}  // namespace drumhead::kernels
