// SPDX-License-Identifier: MIT
#pragma once
// The regions into which known nodes divide a level. The boundary of a region is a polygon of known
// nodes: its deformed area does not change, and a constant pressure in it is a force on nothing.
// Summed over a region, the volume rows B d − C dP = g of a linear system therefore say −Σ C dP = Σ
// g: the means of dP are known beforehand. Cycles need to be told where kappa is large. The parts
// of a fine level do not nest in those of the next, small ones may lie across its chords; the sums
// Σ g that a coarse level gets are a little wrong, and it divides them by Σ C, which is next to
// nothing (turned circle, S2, kappa 1e4, 128²: every V-cycle multiplied the error by 70). So coarse
// levels get right-hand sides whose sums are 0, and every level sets its means.
#include <vector>

#include <drumhead/grid/conforming.h>
#include <drumhead/kernels/special.h>

namespace drumhead::multigrid {

class Regions {
 public:
  Regions() = default;
  template <class T>
  Regions(const grid::ConformingCells& geometry, const kernels::SpecialCells<T>& cells);

  int count() const { return int(sum_.size()); }

  // All of these do nothing where there is one region, which every level sees as one.

  /// Finds Σ C of every region.
  template <class T>
  void prepare(const kernels::Membrane<T>& membrane);
  /// Remembers the sums of the volume rows' right-hand sides.
  template <class T>
  void keep_sums(const kernels::Unknowns<T>& f);
  /// Makes them 0, by an equal share of every area.
  template <class T>
  void remove_sums(const kernels::Membrane<T>& membrane, const kernels::Unknowns<T>& f);
  /// Adds a constant to dP of every region so that −Σ C dP is the sum that was kept; where kappa is
  /// infinite, so that the mean is 0.
  template <class T>
  void set_means(const kernels::Membrane<T>& membrane, const kernels::Unknowns<T>& d);

 private:
  struct Run {  ///< regular cells [begin, end) of a row
    int begin = 0, end = 0, region = 0;
  };
  template <class F>
  void for_halves(F&& visit) const;
  template <class T>
  void add_sums(const kernels::Unknowns<T>& f);
  void list_runs(const grid::ConformingCells& geometry);

  std::vector<int> run_begin_;  ///< rows + 1
  std::vector<Run> run_;
  std::vector<int> part_region_;
  std::vector<double> part_weight_;                  ///< A/kappa, or A where kappa is one value
  std::vector<double> sum_, weight_, area_, shift_;  ///< per region
};

}  // namespace drumhead::multigrid
