// SPDX-License-Identifier: MIT
#include "svg_curves.h"

#include <2geom/exception.h>
#include <2geom/transforms.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "svg_shape.h"
#include "svg_text.h"
#include "svg_transform.h"

namespace drumhead::driver {
namespace {

enum class Role { none, source, target, pin };
constexpr std::array<std::string_view, 4> kRoleNames = {"", "source", "target", "pin"};

Role layer_role(pugi::xml_node group) {
  const std::string name = name_of(group);
  const std::string_view id = group.attribute("id").value();
  for (const Role role : {Role::source, Role::target, Role::pin}) {
    const std::string_view wanted = kRoleNames[std::size_t(role)];
    if (name == wanted || id == wanted) return role;
  }
  return Role::none;
}

/// The role that a name's suffix gives; the suffix is taken off.
Role take_suffix(std::string& name) {
  for (const Role role : {Role::source, Role::target}) {
    const std::string_view word = kRoleNames[std::size_t(role)];
    if (name.ends_with(word) && name.size() > word.size() &&
        name[name.size() - word.size() - 1] == '-') {
      name.resize(name.size() - word.size() - 1);
      return role;
    }
  }
  return Role::none;
}

/// The one child that is drawn; none where there are more.
pugi::xml_node only_child(pugi::xml_node group) {
  pugi::xml_node only;
  for (const pugi::xml_node child : group.children()) {
    const std::string_view what = kind(child);
    if (what.empty() || what == "title" || what == "desc" || what == "metadata") continue;
    if (only) return {};
    only = child;
  }
  return only;
}

/// The name of a shape; of one without, that of the innermost named group around nothing else,
/// which is where Affinity writes it.
std::string shape_name(pugi::xml_node shape) {
  std::string name = name_of(shape);
  for (pugi::xml_node group = shape.parent(); name.empty() && is_group(kind(group)) &&
                                              layer_role(group) == Role::none && only_child(group);
       group = group.parent()) {
    name = name_of(group);
  }
  return name;
}

/// Whether a group's name is that of the one shape in it.
bool names_shape(pugi::xml_node group) {
  pugi::xml_node inner = group;
  while (is_group(kind(inner))) inner = only_child(inner);
  return inner && shape_name(inner) == name_of(group);
}

/// Whether a group outside the layers holds one, or a suffix; else it is art.
bool holds_curves(pugi::xml_node group) {
  for (const pugi::xml_node child : group.children()) {
    if (kind(child).empty()) continue;
    if (std::string name = shape_name(child); take_suffix(name) != Role::none) return true;
    if (is_group(kind(child)) && (layer_role(child) != Role::none || holds_curves(child)))
      return true;
  }
  return false;
}

/// A shape of a curve layer, in picture pixels.
struct Drawn {
  std::string name;  ///< without suffix
  Role role = Role::none;
  pugi::xml_node element;
  std::vector<Placed> paths;
};

/// Calls visit(element, role of the enclosing layer, user units → those of the root) for whatever
/// is not a group. Definitions, clips, masks and the like are not part of the drawing and are left
/// out.
using Visit = std::function<void(pugi::xml_node, Role, const Geom::Affine&)>;

void walk(const SvgDocument& document, const SvgView& view, pugi::xml_node parent, Role role,
          const Geom::Affine& to_root, const Visit& visit) {
  for (const pugi::xml_node element : parent.children()) {
    if (!is_group(kind(element))) {
      if (!kind(element).empty()) visit(element, role, to_root);
      continue;
    }
    const Role own = layer_role(element);
    std::string name = name_of(element);
    if (own == Role::none && role == Role::none && take_suffix(name) != Role::none &&
        !names_shape(element)) {
      document.fail(element, "the suffix belongs on the name of a path, not of a group");
    }
    if (own != Role::none && role != Role::none && own != role) {
      document.fail(element, "this layer lies in the layer '" +
                                 std::string(kRoleNames[std::size_t(role)]) + "'");
    }
    const Role inner = own == Role::none ? role : own;
    if (inner == Role::none && !holds_curves(element)) continue;
    walk(document, view, element, inner, transform_of(document, view, element) * to_root, visit);
  }
}

using Warn = std::function<void(const std::string&)>;

class CurveReader {
 public:
  CurveReader(const SvgDocument& document, double width_px, double height_px, const Warn& warn)
      : document_(document),
        warn_(warn),
        view_(document.view().value_or(SvgView{0, 0, width_px, height_px})) {
    const double x_scale = width_px / view_.width, y_scale = height_px / view_.height;
    if (std::abs(x_scale / y_scale - 1.0) > 0.01) {
      char text[160];
      std::snprintf(text, sizeof text,
                    ": the drawing is %g x %g and is stretched onto a picture of %g x %g pixels",
                    view_.width, view_.height, width_px, height_px);
      warn_(document.file().string() + text);
    }
    to_picture_ = Geom::Translate(-view_.x, -view_.y) * Geom::Scale(x_scale, y_scale);
  }

  std::vector<SvgCurve> read() {
    walk(document_, view_, document_.root(), Role::none, to_picture_,
         [this](pugi::xml_node element, Role layer, const Geom::Affine& to_picture) {
           visit(element, layer, to_picture);
         });
    if (drawn_.empty()) {
      throw std::invalid_argument(
          document_.file().string() +
          ": no curves: no layer source, target or pin holds a path, and no "
          "path's name ends in -source or -target");
    }
    refuse_doubled();
    for (const Drawn& one : drawn_) pair(one);
    return std::move(curves_);
  }

 private:
  void visit(pugi::xml_node element, Role layer, const Geom::Affine& to_picture) {
    std::string name = shape_name(element);
    const Role suffix = take_suffix(name);
    const Role role = layer == Role::none ? suffix : layer;
    if (role == Role::none) return;
    if (kind(element) == "svg" || kind(element) == "symbol") {
      document_.fail(element, "is not read among curves; draw its paths in the layer itself");
    }
    pugi::xml_node shape = element;
    Geom::Affine affine = transform_of(document_, view_, element) * to_picture;
    if (kind(element) == "use") {
      shape = used_shape(element);
      affine = transform_of(document_, view_, shape) *
               Geom::Translate(
                   svg_length(element.attribute("x").as_string("0"), view_.width).value_or(0),
                   svg_length(element.attribute("y").as_string("0"), view_.height).value_or(0)) *
               affine;
    } else if (!is_shape(element)) {
      if (kind(element) == "text" || kind(element) == "image")
        warn_(document_.named_place(element) +
              " is not a path and no curve; Inkscape: Path > Object to Path");
      return;
    }
    if (suffix != Role::none && suffix != role) {
      document_.fail(element, "its suffix says another layer than '" +
                                  std::string(kRoleNames[std::size_t(role)]) + "', where it lies");
    }
    std::vector<Placed> paths;
    for (const Geom::Path& path : shape_paths(document_, view_, shape)) {
      paths.push_back({path, affine});
    }
    add(element, name, role, std::move(paths));
  }

  pugi::xml_node used_shape(pugi::xml_node use) const {
    std::string_view href = use.attribute("href").value();
    if (href.empty()) href = use.attribute("xlink:href").value();
    const auto shape = href.starts_with('#') ? document_.by_id(href.substr(1)) : pugi::xml_node();
    if (!shape || !is_shape(shape)) {
      document_.fail(use, "<use> of '" + std::string(href) + "', which is no shape of this file");
    }
    return shape;
  }

  void add(pugi::xml_node element, std::string name, Role role, std::vector<Placed> paths) {
    if (name.empty()) {
      if (role != Role::pin) {
        document_.fail(element, "has no name (inkscape:label or id) to pair it by");
      }
      name = "pin at line " + document_.place(element).substr(document_.file().string().size() + 1);
    }
    if (paths.empty()) document_.fail(element, "has no length");
    drawn_.push_back({std::move(name), role, element, std::move(paths)});
  }

  const Drawn* find(const std::string& name, Role role, const Drawn* before = nullptr) const {
    for (const Drawn& one : drawn_) {
      if (&one == before) return nullptr;
      if (one.name == name && one.role == role) return &one;
    }
    return nullptr;
  }

  void refuse_doubled() const {
    for (const Drawn& one : drawn_) {
      const Drawn* other = find(one.name, one.role, &one);
      if (!other && one.role == Role::pin) {
        other = find(one.name, Role::source);
        if (!other) other = find(one.name, Role::target);
      }
      if (other) {
        document_.fail(one.element, "the name '" + one.name + "' was used before, at " +
                                        document_.place(other->element));
      }
    }
  }

  void pair(const Drawn& one) {
    try {
      pair_paths(one);
    } catch (const Geom::Exception& error) {
      document_.fail(one.element, error.what());
    }
  }

  void pair_paths(const Drawn& one) {
    if (one.role == Role::pin) {
      for (std::size_t k = 0; k < one.paths.size(); ++k) {
        const Chain held = chain(one.paths[k]);
        check(one, held);
        add_curve(one, k, held, held);
      }
      return;
    }
    const Role wanted = one.role == Role::source ? Role::target : Role::source;
    const Drawn* other = find(one.name, wanted);
    if (!other) {
      document_.fail(one.element, "'" + one.name + "' has no " +
                                      std::string(kRoleNames[std::size_t(wanted)]) +
                                      "; the names on both sides must be the same");
    }
    if (one.role == Role::target) return;
    if (one.paths.size() != other->paths.size()) {
      document_.fail(one.element, "'" + one.name + "' has " + std::to_string(one.paths.size()) +
                                      " subpaths and its target " +
                                      std::to_string(other->paths.size()));
    }
    for (std::size_t k = 0; k < one.paths.size(); ++k) pair_subpath(one, *other, k);
  }

  void pair_subpath(const Drawn& source, const Drawn& target, std::size_t k) {
    auto [from, to] = corresponding_chains(source.paths[k], target.paths[k]);
    check(source, from);
    check(target, to);
    const std::string name = part_name(source, k);
    if (closed(from) && !closed(to)) {
      document_.fail(target.element, "'" + name + "' is open but its source is closed");
    }
    if (closed(from) && area(from) * area(to) < 0) {
      warn_(document_.place(target.element) + ": '" + name +
            "' runs the other way round than its source: the warp folds over");
    }
    add_curve(source, k, std::move(from), std::move(to));
  }

  /// Points at infinity or not apart come from absurd numbers and flattening transforms.
  void check(const Drawn& drawn, const Chain& chain) const {
    double length = 0.0;
    for (const grid::CubicBezier& piece : chain) {
      for (int k = 0; k < 3; ++k) length += grid::length(piece.control[k + 1] - piece.control[k]);
    }
    if (!std::isfinite(length)) document_.fail(drawn.element, "has a point at infinity");
    if (length <= 0) document_.fail(drawn.element, "has no length");
  }

  void add_curve(const Drawn& drawn, std::size_t k, Chain source, Chain target) {
    SvgCurve curve;
    curve.pair.name = part_name(drawn, k);
    curve.pair.source = std::move(source);
    curve.pair.target = std::move(target);
    curve.pin = drawn.role == Role::pin;
    curve.place = document_.named_place(drawn.element);
    curves_.push_back(std::move(curve));
  }

  static std::string part_name(const Drawn& one, std::size_t k) {
    return one.paths.size() == 1 ? one.name : one.name + "#" + std::to_string(k + 1);
  }

  static bool closed(const Chain& chain) {
    const grid::Point first = chain.front().control[0], last = chain.back().control[3];
    return grid::length(last - first) <= 1e-6 * grid::arc_length(chain);
  }

  /// Twice the signed area of the control polygon: its sign is the sense of rotation.
  static double area(const Chain& chain) {
    double sum = 0.0;
    for (const grid::CubicBezier& piece : chain) {
      for (int k = 0; k < 3; ++k) sum += grid::cross(piece.control[k], piece.control[k + 1]);
    }
    return sum;
  }

  const SvgDocument& document_;
  const Warn& warn_;
  SvgView view_;
  Geom::Affine to_picture_;
  std::vector<Drawn> drawn_;
  std::vector<SvgCurve> curves_;
};

void add_curve_elements(pugi::xml_node parent, std::vector<pugi::xml_node>& elements) {
  for (const pugi::xml_node element : parent.children()) {
    if (is_group(kind(element))) {
      if (layer_role(element) == Role::none)
        add_curve_elements(element, elements);
      else
        elements.push_back(element);
    } else if (std::string name = shape_name(element);
               (is_shape(element) || kind(element) == "use") && take_suffix(name) != Role::none) {
      elements.push_back(element);
    }
  }
}

}  // namespace

std::vector<SvgCurve> read_curves(const SvgDocument& document, double width_px, double height_px,
                                  const Warn& warn) {
  return CurveReader(document, width_px, height_px, warn).read();
}

std::vector<pugi::xml_node> curve_elements(const SvgDocument& document) {
  std::vector<pugi::xml_node> elements;
  add_curve_elements(document.root(), elements);
  return elements;
}

}  // namespace drumhead::driver
