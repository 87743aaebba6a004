// SPDX-License-Identifier: MIT
#include "svg_transform.h"

#include <2geom/transforms.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "svg_shape.h"
#include "svg_text.h"

namespace drumhead::driver {
namespace {

/// The arguments of one transform function; CSS gives them the units px and deg.
std::optional<std::vector<double>> arguments(std::string_view text) {
  std::vector<double> numbers;
  for (text = trimmed(text); !text.empty();) {
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

/// A property of style or, weaker, attribute; empty if it is not there.
std::string_view property(pugi::xml_node element, const char* name) {
  const auto css = style_property(element.attribute("style").value(), name);
  return css.empty() ? trimmed(element.attribute(name).value()) : css;
}

Geom::Affine transform_with(const SvgDocument& document, const SvgView& whole,
                            pugi::xml_node element, const Geom::OptRect* fill_box);

/// The box around what an element shows, in its own user units, strokes left out.
Geom::OptRect bounds(const SvgDocument& document, const SvgView& whole, pugi::xml_node element) {
  if (is_shape(element)) return shape_paths(document, whole, element).boundsExact();
  Geom::OptRect all;
  if (!is_group(kind(element))) {
    const std::string_view what = kind(element);
    if (what == "text" || what == "image" || what == "use" || what == "svg") {
      document.fail(element, "transform-box: fill-box is read of shapes and groups of them only");
    }
    return all;
  }
  for (const pugi::xml_node child : element.children()) {
    if (kind(child).empty()) continue;
    const Geom::OptRect box = bounds(document, whole, child);
    if (box) all.unionWith(*box * transform_with(document, whole, child, &box));
  }
  return all;
}

/// The box that transform-origin is measured from. That of the view lies at 0, 0, wherever the
/// view begins (CSS Transforms 1, section 8).
Geom::Rect reference_box(const SvgDocument& document, const SvgView& whole, pugi::xml_node element,
                         const Geom::OptRect* fill_box) {
  const std::string_view name = property(element, "transform-box");
  if (name == "fill-box" || name == "content-box") {
    const Geom::OptRect box = fill_box ? *fill_box : bounds(document, whole, element);
    return box.value_or(Geom::Rect(0, 0, 0, 0));
  }
  if (!name.empty() && name != "view-box") {
    document.fail(element, "its transform-box '" + std::string(name) +
                               "' is not read; view-box and fill-box are");
  }
  return Geom::Rect::from_xywh(0, 0, whole.width, whole.height);
}

/// One word of transform-origin along an axis with the keywords `first` and `last`.
std::optional<double> along(std::string_view word, const char* first, const char* last,
                            double size) {
  if (word == first) return 0.0;
  if (word == "center") return size / 2;
  if (word == last) return size;
  return svg_length(word, size);
}

/// transform-origin from the corner of its box.
std::optional<Geom::Point> parse_origin(std::string_view text, Geom::Point size) {
  auto word = words(text);
  const auto vertical = [](std::string_view one) { return one == "top" || one == "bottom"; };
  const auto horizontal = [](std::string_view one) { return one == "left" || one == "right"; };
  if (word.empty() || word.size() > 3) return std::nullopt;
  if (word.size() == 3 && !svg_length(word[2], 0)) return std::nullopt;  // depth, of no effect
  if (word.size() == 1) word.push_back("center");
  if (vertical(word[0]) || horizontal(word[1])) std::swap(word[0], word[1]);
  const auto x = along(word[0], "left", "right", size.x());
  const auto y = along(word[1], "top", "bottom", size.y());
  if (!x || !y) return std::nullopt;
  return Geom::Point(*x, *y);
}

/// transform_of, with the element's box where it is known, so that boxes in boxes are taken once.
Geom::Affine transform_with(const SvgDocument& document, const SvgView& whole,
                            pugi::xml_node element, const Geom::OptRect* fill_box) {
  const auto transform = parse_transform(property(element, "transform"));
  if (!transform) document.fail(element, "its transform cannot be read");
  if (*transform == Geom::identity()) return *transform;
  const Geom::Rect box = reference_box(document, whole, element, fill_box);
  const std::string_view text = property(element, "transform-origin");
  const auto origin = text.empty() ? Geom::Point(0, 0) : parse_origin(text, box.dimensions());
  if (!origin) {
    document.fail(element, "its transform-origin '" + std::string(text) + "' cannot be read");
  }
  const Geom::Point centre = box.min() + *origin;
  return Geom::Translate(-centre) * *transform * Geom::Translate(centre);
}

}  // namespace

Geom::Affine transform_of(const SvgDocument& document, const SvgView& whole,
                          pugi::xml_node element) {
  return transform_with(document, whole, element, nullptr);
}

}  // namespace drumhead::driver
