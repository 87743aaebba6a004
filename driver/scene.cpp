// SPDX-License-Identifier: MIT
#include "scene.h"

#include <toml++/toml.h>
#include <stdexcept>

namespace drumhead::driver {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& place, const std::string& what) {
  throw std::invalid_argument(place + ": " + what);
}

std::string place_of(const fs::path& file, const toml::node& node) {
  return file.string() + ":" + std::to_string(node.source().begin.line);
}

/// "key = value" as an error quotes it.
std::string quoted(std::string_view key, const toml::node& node) {
  std::ostringstream text;
  text << key;
  if (node.is_value())
    node.visit([&](const auto& n) {
      if constexpr (toml::is_value<decltype(n)>)
        text << " = " << toml::node_view<const toml::node>(n);
    });
  return text.str();
}

/// Nothing for tables, arrays, dates.
std::optional<Value> value_of(const toml::node& node) {
  if (const auto* v = node.as_boolean()) return Value(v->get());
  if (const auto* v = node.as_integer()) return Value(std::int64_t(v->get()));
  if (const auto* v = node.as_floating_point()) return Value(v->get());
  if (const auto* v = node.as_string()) return Value(v->get());
  return std::nullopt;
}

std::string known_keys() {
  std::string names;
  for (const Key& key : keys()) names += std::string(key.name) + ", ";
  return names + "[[curve]]";
}

CurveOverride read_curve(const fs::path& file, const toml::table& table) {
  CurveOverride curve;
  curve.place = place_of(file, table);
  for (const auto& [key, node] : table) {
    const std::string place = place_of(file, node) + ": " + quoted(key.str(), node);
    const auto value = value_of(node);
    if (key == "name") {
      if (!node.is_string() || node.as_string()->get().empty()) {
        fail(place, "must be the name of a curve");
      }
      curve.name = node.as_string()->get();
    } else if (key == "weight") {
      if (value) curve.weight = weight_of(*value);
      if (!curve.weight) fail(place, "must be a number above 0, or inf");
    } else if (key == "turn") {
      if (value) curve.turn_degrees = finite_number(*value);
      if (!curve.turn_degrees) fail(place, "must be a finite number of degrees");
    } else {
      fail(place, "unknown key; a curve has name, weight, turn");
    }
  }
  if (curve.name.empty()) fail(curve.place, "[[curve]] without a name");
  return curve;
}

void read_curves(const fs::path& file, const toml::node& node, Options& options) {
  const auto* tables = node.as_array();
  if (!tables || !tables->is_homogeneous(toml::node_type::table)) {
    fail(place_of(file, node), "curve: must be tables, [[curve]]");
  }
  for (const toml::node& table : *tables) {
    CurveOverride curve = read_curve(file, *table.as_table());
    for (const CurveOverride& other : options.overrides) {
      if (other.name == curve.name) {
        fail(curve.place, "curve '" + curve.name + "' was already given at " + other.place);
      }
    }
    options.overrides.push_back(std::move(curve));
  }
}

void read_key(const fs::path& file, std::string_view name, const toml::node& node,
              Options& options) {
  const std::string place = place_of(file, node) + ": " + quoted(name, node);
  const Key* key = find_key(name);
  if (!key) fail(place, "unknown key; a scene has " + known_keys());
  const auto value = value_of(node);
  if (!value) fail(place, "must be " + std::string(key->bound));
  if (const auto* text = std::get_if<std::string>(&*value); key->path && text && !text->empty()) {
    set(*key, (file.parent_path() / *text).string(), place, options);
  } else {
    set(*key, *value, place, options);
  }
}

}  // namespace

void read_scene(const fs::path& file, Options& options) {
  if (fs::is_directory(file)) fail(file.string(), "is a folder, not a scene");
  toml::table scene;
  try {
    scene = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    fail(file.string() + (line ? ":" + std::to_string(line) : ""),
         std::string(error.description()));
  }
  if (const auto* cell_size = scene.get("cell_size"); cell_size && scene.contains("cells")) {
    fail(place_of(file, *cell_size), "cell_size: give either cells or cell_size");
  }
  for (const auto& [name, node] : scene) {
    if (name == "curve")
      read_curves(file, node, options);
    else
      read_key(file, name.str(), node, options);
  }
}

}  // namespace drumhead::driver
