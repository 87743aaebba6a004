// SPDX-License-Identifier: MIT
#include "svg_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace drumhead::driver {
namespace {

constexpr std::string_view kSpace = " \t\r\n\f";

void skip_space(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<double> take_number(std::string_view& text) {
  // from_chars alone would also read inf and nan and refuse a plus.
  std::string_view rest = text;
  if (rest.starts_with('+')) rest.remove_prefix(1);
  const std::size_t digit = rest.starts_with('-') && rest.size() == text.size() ? 1 : 0;
  if (rest.size() <= digit || (rest[digit] != '.' && (rest[digit] < '0' || rest[digit] > '9'))) {
    return std::nullopt;
  }
  double x = 0.0;
  const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), x);
  if (error != std::errc{} || !std::isfinite(x)) return std::nullopt;
  text.remove_prefix(std::size_t(stop - text.data()));
  return x;
}

void skip_separator(std::string_view& text) {
  skip_space(text);
  if (text.starts_with(',')) {
    text.remove_prefix(1);
    skip_space(text);
  }
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  for (skip_space(text); !text.empty(); skip_space(text)) {
    const auto end = std::min(text.find_first_of(kSpace), text.size());
    all.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return all;
}

std::optional<double> svg_length(std::string_view text, double whole) {
  using Unit = std::pair<std::string_view, double>;
  constexpr std::array<Unit, 8> kUnits{{{"", 1.0},
                                        {"px", 1.0},
                                        {"in", 96.0},
                                        {"cm", 96.0 / 2.54},
                                        {"mm", 96.0 / 25.4},
                                        {"pt", 96.0 / 72.0},
                                        {"pc", 16.0},
                                        {"Q", 24.0 / 25.4}}};
  text = trimmed(text);
  const auto x = take_number(text);
  if (!x) return std::nullopt;
  if (text == "%") return *x / 100.0 * whole;
  for (const auto& [unit, pixels] : kUnits) {
    if (text == unit) return *x * pixels;
  }
  return std::nullopt;
}

std::optional<std::vector<double>> svg_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (skip_space(text); !text.empty(); skip_separator(text)) {
    const auto x = take_number(text);
    if (!x) return std::nullopt;
    numbers.push_back(*x);
  }
  return numbers;
}

}  // namespace drumhead::driver
