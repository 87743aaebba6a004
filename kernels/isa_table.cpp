// SPDX-License-Identifier: MIT
// Compiled once per instruction set, with DRUMHEAD_ISA_NAMESPACE and DRUMHEAD_ISA_LEVEL set by the
// build: 0 scalar (auto-vectoriser off), 1 SSE2, 2 AVX2, 3 AVX-512.
#include "energy_body.h"
#include "folds_body.h"
#include "kaczmarz_body.h"
#include "kernel_table.h"
#include "linear_body.h"
#include "reduce_body.h"
#include "relax_body.h"
#include "transfer_body.h"
#include "volume_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

template <class T>
constexpr KernelTable<T> make_table() {
  return {
      .apply = linear_row<false, T>,
      .residual = linear_row<true, T>,
      .apply_nodes = linear_nodes_row<false, T>,
      .residual_nodes = linear_nodes_row<true, T>,
      .force_nodes = force_nodes_row<T>,
      .force_cells = force_cells_row<T>,
      .inverted_cells = inverted_cells_row<T>,
      .energy = energy_row<T>,
      .relax_nodes = relax_nodes_row<T>,
      .start_nodes = start_nodes_row<T>,
      .relax_volume = relax_volume_row<T>,
      .relax_volume_spans = relax_volume_spans<T>,
      .kaczmarz_nodes = kaczmarz_nodes_row<T>,
      .kaczmarz_cells = kaczmarz_cells_row<T>,
      .jacobi_nodes = jacobi_nodes_row<T>,
      .jacobi_cells = jacobi_cells_row<T>,
      .jacobi_pressures = jacobi_pressures_row<T>,
      .balance_cells = balance_cells_row<T>,
      .prolong_nodes = prolong_nodes_row<false, T>,
      .add_prolonged_nodes = prolong_nodes_row<true, T>,
      .restrict_nodes = restrict_nodes_row<T>,
      .inject_nodes = inject_nodes_row<T>,
      .prolong_cells = prolong_cells_row<T>,
      .sum_cells = gather_cells_row<false, T>,
      .mean_cells = gather_cells_row<true, T>,
      .interpolate_cells = interpolate_cells_row<T>,
      .dot = dot_row<T>,
      .squares_over = squares_over_row<T>,
      .combine = combine_row<T>,
      .move = move_row<T>,
      .folds = folds_row,
  };
}

extern const KernelTable<float> float_table = make_table<float>();
extern const KernelTable<double> double_table = make_table<double>();

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
