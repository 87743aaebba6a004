// SPDX-License-Identifier: MIT
#pragma once
// The isotropic membranes behind the functions of elastic.h and relax.h; private to kernels/.
#include <drumhead/kernels/model.h>
#include <drumhead/kernels/relax.h>

#include "isotropic_table.h"

namespace drumhead::kernels {

/// The row kernels of the membrane's model.
template <class T>
const IsotropicRows<T>& isotropic_rows(const Membrane<T>& m);

template <class T>
void apply_isotropic(const Membrane<T>& m, const Unknowns<const T>& d, const Unknowns<T>& out);

template <class T>
void isotropic_force(const Membrane<T>& m, const Unknowns<T>& f);

template <class T>
void relax_isotropic(const LevelSystem<T>& level, bool from_zero, const Unknowns<const T>* coarse_d,
                     const Unknowns<T>* coarse_f);

template <class T>
double isotropic_residual_norm2(const LevelSystem<T>& level);

}  // namespace drumhead::kernels
