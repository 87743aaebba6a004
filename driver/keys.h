// SPDX-License-Identifier: MIT
#pragma once
// The key tables behind options.h, one a theme, and what their entries are made of: each setter
// takes a value into a field and returns false, with the field as it was, outside the key's bound.
#include "options.h"

namespace drumhead::driver {

/// Pictures, lattice, membrane, solver.
std::span<const Key> scene_keys();

/// Where mu and kappa vary.
std::span<const Key> mask_keys();

/// The warp and its lattice for other programs.
std::span<const Key> map_keys();

/// How the warped picture is made, and what is written.
std::span<const Key> output_keys();

/// A number or inf; nothing for nan and all else.
std::optional<double> number(const Value& value);

/// Finite and above 0.
bool set_positive(const Value& value, double& field);

/// Whole, from 1 to `most`.
bool set_whole(const Value& value, int most, int& field);

bool set_switch(const Value& value, bool& field);

template <auto Field>
bool set_positive(const Value& value, Options& options) {
  return set_positive(value, options.*Field);
}

template <auto Field>
bool set_switch(const Value& value, Options& options) {
  return set_switch(value, options.*Field);
}

/// A path that is not empty and ends in `extension`, if that is not empty.
bool set_path(const Value& value, std::string_view extension, std::filesystem::path& field);

template <auto Field>
bool set_file(const Value& value, Options& options) {
  return set_path(value, "", options.*Field);
}

constexpr std::string_view kAnyPath = "the path of a file";

}  // namespace drumhead::driver
