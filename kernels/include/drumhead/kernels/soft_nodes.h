// SPDX-License-Identifier: MIT
#pragma once
// Rows of the operator for curve nodes of soft curves: unknowns with the energy stiffness/2 |u −
// wanted|² besides those of the triangles and parts they belong to (special.h). Each belongs to a
// row: that of the lattice edge it lies on, or of the cell row above if between two. Like a node of
// the lattice it sees nodes and curve nodes of its own row and the two beside it. What rows of
// lattice nodes and parts have of curve nodes is kept here too, so that scenes whose curves are all
// hard store and read nothing of it. Isotropic membranes have 2×2 blocks beside the couplings,
// which are then between all vertices of a part.
#include <vector>

#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

template <class T>
struct SpecialCells;

/// Coupling to another node: (H d)_x = k d_x + g d_y, (H d)_y = k d_y − g d_x.
template <class T>
struct NodeCoupling {
  int column = 0, row = 0;  ///< of a lattice node; row < 0: curve node `column`
  T k = T(0), g = T(0);
};
/// The same of isotropic membranes: (H d)_x = xx d_x + xy d_y, (H d)_y = yx d_x + yy d_y.
template <class T>
struct NodeBlock {
  T xx = T(0), xy = T(0), yx = T(0), yy = T(0);
};
/// Of a curve node and a part, or the other way round.
template <class T>
struct AreaCoupling {
  int other = 0;
  T bx = T(0), by = T(0);
};

template <class T>
class SoftRows {
 public:
  struct Row {
    int node = 0;                        ///< curve node
    int node_begin = 0, part_begin = 0;  ///< couplings, up to the next row's
    T diagonal = T(0), inverse = T(0);   ///< K_ii, 1/K_ii
  };

  SoftRows() = default;
  /// `rows`: complete but for these.
  SoftRows(const SpecialRows<T>& rows, const Membrane<T>& membrane);
  /// Sets what depends on the membrane's state and pressures.
  void linearise(const SpecialRows<T>& rows, const Membrane<T>& membrane);

  int size() const { return row_.empty() ? 0 : int(row_.size()) - 1; }
  /// Soft curve nodes of row j: [begin(j), begin(j + 1)).
  int begin(int j) const { return row_begin_[std::size_t(j)]; }
  const Row& row(int n) const { return row_[std::size_t(n)]; }
  /// Of a curve node among the soft ones; −1: known.
  int index(int curve_node) const { return index_[std::size_t(curve_node)]; }
  /// 1/K_ii of a soft curve node.
  T inverse(int curve_node) const { return row_[std::size_t(index(curve_node))].inverse; }

  const NodeCoupling<T>& node(int k) const { return node_[std::size_t(k)]; }
  const AreaCoupling<T>& part(int k) const { return part_[std::size_t(k)]; }
  /// Curve nodes that near node n sees: [near_begin(n), near_begin(n + 1)) of of_near.
  int near_begin(int n) const { return near_begin_[std::size_t(n)]; }
  const NodeCoupling<T>& of_near(int k) const { return of_near_[std::size_t(k)]; }
  /// The same for the row of part p.
  int area_begin(int p) const { return area_begin_[std::size_t(p)]; }
  const AreaCoupling<T>& of_part(int k) const { return of_part_[std::size_t(k)]; }

  // Of isotropic membranes: blocks of couplings, of the nodes themselves and those' inverses.
  const NodeBlock<T>& node_block(int k) const { return node_block_[std::size_t(k)]; }
  const NodeBlock<T>& of_near_block(int k) const { return of_near_block_[std::size_t(k)]; }
  const NodeBlock<T>& own_block(int n) const { return own_block_[std::size_t(n)]; }
  const NodeBlock<T>& inverse_block(int n) const { return inverse_block_[std::size_t(n)]; }
  /// All of them := 0, or the stiffness of the nodes' springs.
  void clear_blocks(const SpecialCells<T>& cells);
  /// That of a soft curve node and the node (column, row) as couplings name it; null: known.
  NodeBlock<T>* find_block(int curve_node, int column, int row);
  /// That of near node n and a soft curve node.
  NodeBlock<T>& find_block_of_near(int n, int curve_node);
  /// (own block + 1e-4 mu)⁻¹, as blocks.h has those of lattice nodes.
  void invert_blocks(T mu);
  std::size_t bytes() const;

 private:
  void list_nodes(const SpecialCells<T>& cells, int rows);

  std::vector<int> index_;      // of every curve node among the soft ones, −1: known
  std::vector<int> row_begin_;  // ny + 2
  std::vector<Row> row_;        // one more than there are
  std::vector<NodeCoupling<T>> node_, of_near_;
  std::vector<AreaCoupling<T>> part_, of_part_;
  std::vector<NodeBlock<T>> node_block_, of_near_block_, own_block_, inverse_block_;
  std::vector<int> near_begin_, area_begin_;
};

}  // namespace drumhead::kernels
