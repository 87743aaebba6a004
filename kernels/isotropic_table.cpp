// SPDX-License-Identifier: MIT
// Compiled once per instruction set, like isa_table.cpp, and apart from it because it takes longer.
#include "isotropic_table.h"

#include "averaged_body.h"
#include "blocks_body.h"
#include "isotropic_energy_body.h"
#include "point_body.h"

namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE {

template <class Density, class T>
constexpr PointLaw<T> point_law() {
  return {point_stress<Density, T>, point_tangent<Density, T>};
}

template <class Model, class T>
constexpr IsotropicRows<T> isotropic_rows() {
  PointLaw<T> point, corner;
  constexpr bool centred = requires { typename Model::Centre; };
  if constexpr (centred)
    point = point_law<typename Model::Centre, T>();
  else
    point = point_law<Model, T>();
  if constexpr (requires { typename Model::Corner; })
    corner = point_law<typename Model::Corner, T>();
  return {isotropic_product_row<Model, T>,
          isotropic_force_row<Model, T>,
          isotropic_diagonal_row<Model, T>,
          cell_tangent_row<Model, T>,
          isotropic_energy_row<Model, T>,
          point,
          corner,
          centred};
}

template <class T>
constexpr IsotropicTable<T> make_isotropic_table() {
  return {
      .arap = isotropic_rows<Arap, T>(),
      .fold_free = isotropic_rows<FoldFree, T>(),
      .corotated = isotropic_rows<Corotated, T>(),
      .linear = isotropic_rows<Linear, T>(),
      .neohookean = isotropic_rows<NeoHookean, T>(),
      .stvk = isotropic_rows<Stvk, T>(),
      .averaged =
          {averaged_product_row<T>, nullptr, averaged_diagonal_row<T>, nullptr, nullptr, {}, {}},
      .block_step = block_step_row<T>,
      .invert_blocks = invert_blocks_row<T>,
      .corner_pressure = corner_pressure_row<T>,
      .point_pressure = point_pressure<T>,
  };
}

extern const IsotropicTable<float> isotropic_floats = make_isotropic_table<float>();
extern const IsotropicTable<double> isotropic_doubles = make_isotropic_table<double>();

}  // namespace drumhead::kernels::DRUMHEAD_ISA_NAMESPACE
