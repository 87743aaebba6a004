// SPDX-License-Identifier: MIT
#pragma once
// Cut cells: the averaged curve rows of Setaluri et al. 2014, Eq. 2. Every cell that curves cross
// gets one row pair over the union of all curves in it: W_k u = b_k, with W_k the bilinear weights
// and b_k the wanted displacement, both means over the arc of length len_k inside the cell (the
// paper's rows are not divided by len_k, which makes its weights d depend on the lattice). Cut once
// on the finest lattice, aggregated exactly to coarser ones: len_p = Σ len_c, w_p = Σ len_c
// w_c/len_p, 1/(d_p len_p) = Σ (len_c/len_p)²/(d_c len_c).
#include <array>
#include <memory>
#include <vector>

#include <drumhead/grid/curve.h>
#include <drumhead/grid/lattice.h>

namespace drumhead::grid {

/// Sorted by cell row, then column. Lengths and displacements in cells of the finest lattice.
struct CutCells {
  std::vector<int> row_begin;  ///< ny + 1
  std::vector<int> column;
  std::vector<std::array<double, 4>> weight;  ///< nodes 00, 10, 01, 11; 0 on the fixed boundary
  std::vector<double> length;                 ///< len
  std::vector<Point> wanted;                  ///< b: mean of target − source
  std::vector<double> compliance;             ///< 1/(d len) with d in mu per finest cell; 0: hard
  /// Cuts that follow one another along a curve: links of cut k are [link_begin[k],
  /// link_begin[k+1]).
  std::vector<int> link_begin, link;
  int size() const { return int(column.size()); }
};

/// Cuts all curves by the lattice. `most_weight` caps d (mu per longer picture side); infinity: no
/// cap. Curve points within 1e-9 cells of a grid line are taken to lie on it (and belong to the
/// cell of larger index), stays in a cell shorter than 1e-3 cells are dropped, and so are rows of
/// which the fixed boundary holds all but 2 %. Cost: linear in crossings and segments. Throws
/// std::invalid_argument naming curve, place and bound for a source that leaves the lattice, for a
/// weight that is not positive, and as `check` of a curve does.
CutCells cut(const std::vector<CurvePair>& curves, const Lattice& lattice, double most_weight);

/// Cuts one scene after another by one lattice: only curves that the scene before did not have are
/// cut, the cells are the same.
class CurveCutter {
 public:
  CurveCutter(const Lattice& lattice, double most_weight);
  ~CurveCutter();
  /// As the function `cut`, which throws likewise; a scene that was refused leaves no trace.
  CutCells cut(const std::vector<CurvePair>& curves);

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

/// The cut cells of the next coarser lattice and how they hang together with the finer ones.
struct CoarseCuts {
  CutCells cuts;
  std::vector<int>
      parent;  ///< per fine cut; −1: dropped, all its nodes are fixed on the coarse lattice
  std::vector<double> share;  ///< len_c/len_p: prolongs q_c = share·q_p, restricts by the adjoint
};
/// nx, ny: cells of the finer lattice.
CoarseCuts coarsen(const CutCells& fine, int nx, int ny);

}  // namespace drumhead::grid
