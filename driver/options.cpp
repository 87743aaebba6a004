// SPDX-License-Identifier: MIT
#include "options.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "keys.h"

namespace drumhead::driver {

std::optional<double> number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return double(*whole);
  if (const auto* real = std::get_if<double>(&value); real && !std::isnan(*real)) return *real;
  if (const auto* text = std::get_if<std::string>(&value); text && *text == "inf") {
    return std::numeric_limits<double>::infinity();
  }
  return std::nullopt;
}

bool set_positive(const Value& value, double& field) {
  const auto x = finite_number(value);
  if (!x || *x <= 0) return false;
  field = *x;
  return true;
}

bool set_whole(const Value& value, int most, int& field) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  if (!whole || *whole < 1 || *whole > most) return false;
  field = int(*whole);
  return true;
}

bool set_switch(const Value& value, bool& field) {
  const auto* on = std::get_if<bool>(&value);
  if (on) field = *on;
  return on;
}

bool set_path(const Value& value, std::string_view extension, std::filesystem::path& field) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text || text->empty()) return false;
  const std::filesystem::path path = *text;
  if (!extension.empty() && !has_extension(path, extension)) return false;
  field = path;
  return true;
}

std::optional<double> finite_number(const Value& value) {
  const auto x = number(value);
  return x && std::isfinite(*x) ? x : std::nullopt;
}

std::optional<double> weight_of(const Value& value) {
  const auto x = number(value);
  return x && *x > 0 ? x : std::nullopt;
}

std::span<const Key> keys() {
  static const std::vector<Key> all = [] {
    std::vector<Key> tables;
    for (const std::span<const Key> table :
         {scene_keys(), mask_keys(), map_keys(), output_keys()}) {
      tables.insert(tables.end(), table.begin(), table.end());
    }
    return tables;
  }();
  return all;
}

const Key* find_key(std::string_view name) {
  const auto found = std::ranges::find(keys(), name, &Key::name);
  return found == keys().end() ? nullptr : &*found;
}

bool has_extension(const std::filesystem::path& file, std::string_view extension) {
  const std::string own = file.extension();
  return std::ranges::equal(own, extension,
                            [](unsigned char a, char b) { return std::tolower(a) == b; });
}

std::string flag_name(const Key& key) {
  std::string flag = "--" + std::string(key.name);
  std::ranges::replace(flag, '_', '-');
  return flag;
}

Value value_of(const Key& key, const std::string& text) {
  if (key.path || !key.flag) return text;
  const char* const end = text.data() + text.size();
  std::int64_t whole = 0;
  if (const auto [stop, error] = std::from_chars(text.data(), end, whole);
      error == std::errc{} && stop == end) {
    return whole;
  }
  double real = 0.0;
  if (const auto [stop, error] = std::from_chars(text.data(), end, real);
      error == std::errc{} && stop == end) {
    return real;
  }
  return text;
}

void set(const Key& key, const Value& value, const std::string& place, Options& options) {
  if (!key.set(value, options)) {
    throw std::invalid_argument(place + ": must be " + std::string(key.bound));
  }
}

}  // namespace drumhead::driver
