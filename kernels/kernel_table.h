// SPDX-License-Identifier: MIT
#pragma once
// The row kernels of one instruction set. isa_table.cpp fills one table per instruction set and
// number type; the public functions call through the table that was chosen for this processor.
#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/folds.h>
#include <drumhead/kernels/kaczmarz.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/views.h>

namespace drumhead::kernels {

/// Where row j of H d or f − H d goes: nodes (row 0: nothing that is wanted), volume rows, and
/// twice what the cells of row j − 1 add to the nodes of row j, which becomes that for row j + 1.
/// Column 0 of the nodes is left as it is.
template <class T>
struct LinearRow {
  SplitRow<T> x, y, p, carried_x, carried_y;
};

template <class T>
struct KernelTable {
  using Fields = Unknowns<T>;
  using ConstFields = Unknowns<const T>;
  using Row = SplitRow<T>;
  using ConstRow = SplitRow<const T>;

  /// Where there are pressures; all fields of nodes are laid out alike.
  void (*apply)(const Membrane<T>&, const ConstFields*, const ConstFields& d, const LinearRow<T>&,
                int j);
  void (*residual)(const Membrane<T>&, const ConstFields* f, const ConstFields& d,
                   const LinearRow<T>&, int j);
  /// Nodes alone, with or without pressures.
  void (*apply_nodes)(const Membrane<T>&, const ConstFields*, const ConstFields& d, Row, Row,
                      int j);
  void (*residual_nodes)(const Membrane<T>&, const ConstFields* f, const ConstFields& d, Row, Row,
                         int j);
  void (*force_nodes)(const Membrane<T>&, const Fields& out, int j);
  void (*force_cells)(const Membrane<T>&, const Fields& out, int j);
  int (*inverted_cells)(const Membrane<T>&, const Fields& force, int j);
  void (*energy)(const Membrane<T>&, const ConstFields& d, T step, bool moved,
                 const Columns& left_out, EnergySums&, int j);

  void (*relax_nodes)(const Membrane<T>&, const ConstFields& f, const Fields& d, int colour,
                      Spans nodes, int j);
  void (*start_nodes)(const Membrane<T>&, const ConstFields& f, const Fields& d, int j);
  void (*relax_volume)(const Membrane<T>&, const ConstFields& f, const Fields& d, bool reverse,
                       const ConstRow& share, int j);
  void (*relax_volume_spans)(const Membrane<T>&, const ConstFields& f, const Fields& d, int parity,
                             Spans cells, int j);

  void (*kaczmarz_nodes)(const KaczmarzSystem<T>&, Reach, int j);
  void (*kaczmarz_cells)(const KaczmarzSystem<T>&, Reach, int parity, int j);
  void (*jacobi_nodes)(const KaczmarzSystem<T>&, const Fields& e, int j);
  void (*jacobi_cells)(const KaczmarzSystem<T>&, const Fields& e, int j);
  void (*jacobi_pressures)(const KaczmarzSystem<T>&, const ConstFields& e, int j);
  void (*balance_cells)(const Membrane<T>&, const Plane<T>& alpha2, int j);

  void (*prolong_nodes)(const Plane<const T>& coarse, const Plane<T>& fine, int j);
  void (*add_prolonged_nodes)(const Plane<const T>& coarse, const Plane<T>& fine, int j);
  void (*restrict_nodes)(const ConstRow& below, const ConstRow& middle, const ConstRow* above,
                         int fine_columns, const Plane<T>& coarse, int j);
  void (*inject_nodes)(const Plane<const T>& fine, const Plane<T>& coarse, int j);
  void (*prolong_cells)(const Plane<const T>& coarse, const Plane<T>& fine, int j);
  void (*sum_cells)(const ConstRow& below, const ConstRow* above, int fine_columns,
                    const Plane<T>& coarse, int j);
  void (*mean_cells)(const ConstRow& below, const ConstRow* above, int fine_columns,
                     const Plane<T>& coarse, int j);
  void (*interpolate_cells)(const Plane<const T>& coarse, const Plane<T>& fine, int j);

  double (*dot)(const Plane<const T>& a, const Plane<const T>& b, int j);
  double (*squares_over)(const Plane<const T>& a, const Plane<const T>& b, int j);
  void (*combine)(T a, const Plane<const T>& x, T b, const Plane<T>& y, int j);
  void (*move)(T a, const Plane<const T>& x, const Plane<T>& y, Moved&, int j);

  void (*folds)(const double* u, const double* v, int cells, double scale, const Columns& left_out,
                RowFolds&);
};

/// The table of the instruction set in use.
template <class T>
const KernelTable<T>& table();

#define DRUMHEAD_DECLARE_TABLES(isa)             \
  namespace isa {                                \
  extern const KernelTable<float> float_table;   \
  extern const KernelTable<double> double_table; \
  }
DRUMHEAD_DECLARE_TABLES(scalar)
DRUMHEAD_DECLARE_TABLES(sse2)
DRUMHEAD_DECLARE_TABLES(avx2)
DRUMHEAD_DECLARE_TABLES(avx512)
#undef DRUMHEAD_DECLARE_TABLES

}  // namespace drumhead::kernels
