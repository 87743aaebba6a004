// SPDX-License-Identifier: MIT
#pragma once
// The membranes. All are isotropic: with
//   a = (F11 + F22, F21 − F12)/√2, b = (F11 − F22, F21 + F12)/√2, ra = |a|, rb = |b|
// the singular values of F are (ra ± rb)/√2, |F|² = ra² + rb², J = (ra² − rb²)/2, and the rotation
// closest to F turns by the angle of a. crpm is the one of Setaluri et al. 2014 (Eq. 1); it has its
// own kernels (elastic.h), in which kappa may be infinite. The others have densities in
// kernels/model_<name>.h and share the kernels of isotropic.h, in which kappa is finite.
#include <drumhead/kernels/views.h>

#include <array>
#include <string_view>

namespace drumhead::kernels {

struct ModelInfo {
  Model model;
  std::string_view name;
  std::string_view density;  ///< for help texts
};

/// Every membrane, in the order of the help.
constexpr std::array<ModelInfo, 8> kModels{{
    {Model::crpm, "crpm", "mu/2 |F|² + kappa/2 (J−1)²"},
    {Model::harmonic, "harmonic", "mu/2 |F|²"},
    {Model::arap, "arap", "mu/2 |F−R|² + kappa/2 min(0, J−eps)²"},
    {Model::fold_free, "fold-free", "crpm's, and J >= eps at every corner"},
    {Model::corotated, "corotated", "mu |F−R|² + kappa/2 (tr RᵀF − 2)²"},
    {Model::linear, "linear", "mu |e|² + kappa/2 (tr e)², e the linear strain"},
    {Model::neohookean, "neohookean", "mu/2 (|F|²−2) − mu ln J + kappa/2 ln² J"},
    {Model::stvk, "stvk", "mu |E|² + kappa/2 (tr E)², E the Green strain"},
}};

constexpr std::string_view name(Model model) {
  for (const ModelInfo& info : kModels)
    if (info.model == model) return info.name;
  return {};
}

/// Whether the membrane goes through isotropic.h; the others through elastic.h.
constexpr bool isotropic(Model model) { return model != Model::crpm && model != Model::harmonic; }

}  // namespace drumhead::kernels
