// SPDX-License-Identifier: MIT
#include "svg_document.h"

#include <2geom/transforms.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace drumhead::driver {
namespace {

constexpr std::string_view kSpace = " \t\r\n\f";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

void skip_space(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
}

/// Takes a number off the front; from_chars alone would also read inf and nan and refuse a plus.
std::optional<double> take_number(std::string_view& text) {
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

/// The arguments of one transform function; CSS gives them the units px and deg.
std::optional<std::vector<double>> arguments(std::string_view text) {
  std::vector<double> numbers;
  skip_space(text);
  while (!text.empty()) {
    const auto x = take_number(text);
    if (!x) return std::nullopt;
    numbers.push_back(*x);
    for (const std::string_view unit : {"px", "deg"}) {
      if (text.starts_with(unit)) text.remove_prefix(unit.size());
    }
    skip_separator(text);
  }
  return numbers;
}

std::optional<Geom::Affine> one_transform(std::string_view name, const std::vector<double>& a) {
  const std::size_t n = a.size();
  const auto angle = [&](std::size_t i) { return a[i] * std::numbers::pi / 180.0; };
  if (name == "matrix" && n == 6) return Geom::Affine(a[0], a[1], a[2], a[3], a[4], a[5]);
  if (name == "translate" && (n == 1 || n == 2)) return Geom::Translate(a[0], n == 2 ? a[1] : 0.0);
  if (name == "scale" && (n == 1 || n == 2)) return Geom::Scale(a[0], n == 2 ? a[1] : a[0]);
  if (name == "skewX" && n == 1) return Geom::Affine(1, 0, std::tan(angle(0)), 1, 0, 0);
  if (name == "skewY" && n == 1) return Geom::Affine(1, std::tan(angle(0)), 0, 1, 0, 0);
  if (name == "rotate" && n == 1) return Geom::Rotate(angle(0));
  if (name == "rotate" && n == 3) {
    return Geom::Translate(-a[1], -a[2]) * Geom::Rotate(angle(0)) * Geom::Translate(a[1], a[2]);
  }
  return std::nullopt;
}

std::optional<Geom::Affine> parse_transform(std::string_view text) {
  Geom::Affine all = Geom::identity();
  text = trimmed(text);
  if (text == "none") return all;
  while (!text.empty()) {
    const auto open = text.find('('), close = text.find(')');
    if (close == std::string_view::npos || open > close) return std::nullopt;
    const auto numbers = arguments(text.substr(open + 1, close - open - 1));
    const auto one =
        numbers ? one_transform(trimmed(text.substr(0, open)), *numbers) : std::nullopt;
    if (!one) return std::nullopt;
    all = *one * all;  // 2geom multiplies row vectors: the last transform written acts first
    text.remove_prefix(close + 1);
    skip_separator(text);
  }
  return all;
}

/// The value of a property in a style attribute; empty if it is not there.
std::string_view style_property(std::string_view style, std::string_view property) {
  while (!style.empty()) {
    const auto end = std::min(style.find(';'), style.size());
    const std::string_view declaration = style.substr(0, end);
    const auto colon = declaration.find(':');
    if (colon != std::string_view::npos && trimmed(declaration.substr(0, colon)) == property) {
      return trimmed(declaration.substr(colon + 1));
    }
    style.remove_prefix(std::min(end + 1, style.size()));
  }
  return {};
}

/// Drawings are read by recursion; programs that write them nest a few dozen elements.
struct Depth : pugi::xml_tree_walker {
  static constexpr int kMost = 1000;
  bool for_each(pugi::xml_node&) override { return depth() < kMost; }
};

}  // namespace

SvgDocument::SvgDocument(std::filesystem::path file) : file_(std::move(file)) {
  std::ifstream stream(file_, std::ios::binary);
  std::ostringstream text;
  std::error_code error;
  if (!std::filesystem::exists(file_, error))
    throw std::invalid_argument(file_.string() + ": cannot be read: no such file");
  if (!stream || std::filesystem::is_directory(file_, error))
    throw std::invalid_argument(file_.string() + ": cannot be read: no file, or not permitted");
  text << stream.rdbuf();
  text_ = text.str();
  const auto result =
      xml_.load_buffer(text_.data(), text_.size(), pugi::parse_full | pugi::parse_ws_pcdata);
  if (!result) {
    throw std::invalid_argument(at_line(result.offset) +
                                ": is not well-formed XML: " + result.description());
  }
  if (Depth depth; !xml_.traverse(depth))
    throw std::invalid_argument(file_.string() + ": elements are nested deeper than " +
                                std::to_string(Depth::kMost));
  root_ = xml_.document_element();
  if (kind(root_) != "svg") throw std::invalid_argument(file_.string() + ": is not an SVG drawing");
}

std::optional<SvgView> SvgDocument::view() const {
  if (const auto box = root_.attribute("viewBox")) {
    const auto numbers = svg_numbers(box.value());
    if (!numbers || numbers->size() != 4 || (*numbers)[2] <= 0 || (*numbers)[3] <= 0) {
      fail(root_,
           std::string("viewBox '") + box.value() + "' must be four numbers, the last two above 0");
    }
    return SvgView{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  }
  SvgView view;
  for (const auto& [name, size] : {std::pair{"width", &view.width}, {"height", &view.height}}) {
    const std::string_view text = root_.attribute(name).value();
    if (trimmed(text).empty() || trimmed(text).ends_with('%') || text == "auto")
      return std::nullopt;
    const auto length = svg_length(text, 0.0);
    if (!length || *length <= 0) {
      fail(root_, std::string(name) + " '" + std::string(text) + "' must be a length above 0");
    }
    *size = *length;
  }
  return view;
}

std::string SvgDocument::place(pugi::xml_node element) const {
  return at_line(element.offset_debug());
}

std::string SvgDocument::at_line(std::ptrdiff_t offset) const {
  const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
  return file_.string() + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n'));
}

void SvgDocument::fail(pugi::xml_node element, const std::string& what) const {
  throw std::invalid_argument(named_place(element) + ": " + what);
}

std::string SvgDocument::named_place(pugi::xml_node element) const {
  const std::string name = name_of(element);
  return place(element) + ": " + std::string(kind(element)) +
         (name.empty() ? "" : " '" + name + "'");
}

void SvgDocument::save(const std::filesystem::path& file) const {
  if (!xml_.save_file(file.c_str(), "", pugi::format_raw)) {
    throw std::runtime_error(file.string() + ": cannot be written");
  }
}

pugi::xml_node SvgDocument::by_id(std::string_view id) const {
  return root_.find_node([&](pugi::xml_node node) { return node.attribute("id").value() == id; });
}

std::string_view kind(pugi::xml_node element) {
  if (element.type() != pugi::node_element) return {};
  const std::string_view name = element.name();
  return name.substr(name.find(':') + 1);  // find gives npos = -1 where there is no prefix
}

std::string name_of(pugi::xml_node element) {
  for (const char* attribute : {"inkscape:label", "data-name", "id"}) {
    const std::string_view name = trimmed(element.attribute(attribute).value());
    if (!name.empty()) return std::string(name);
  }
  return {};
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

std::optional<Geom::Affine> transform_of(pugi::xml_node element) {
  const auto css = style_property(element.attribute("style").value(), "transform");
  return parse_transform(css.empty() ? element.attribute("transform").value() : css);
}

}  // namespace drumhead::driver
