// SPDX-License-Identifier: MIT
#include "svg_shape.h"

#include <2geom/bezier-curve.h>
#include <2geom/elliptical-arc.h>
#include <2geom/exception.h>
#include <2geom/path-sink.h>
#include <2geom/svg-path-parser.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "svg_text.h"

namespace drumhead::driver {
namespace {

/// Rounded coordinates leave closing segments and stubs of this share of a subpath's size, which
/// nobody drew.
constexpr double kNoLength = 1e-4;

class ShapeReader {
 public:
  ShapeReader(const SvgDocument& document, const SvgView& whole, pugi::xml_node element)
      : document_(document), whole_(whole), element_(element) {}

  Geom::PathVector read() {
    try {
      return read_subpaths();
    } catch (const Geom::Exception& error) {  // ellipses of absurd size
      fail(error.what());
    }
  }

 private:
  Geom::PathVector read_subpaths() {
    const std::string_view shape = kind(element_);
    if (shape == "path")
      read_path();
    else if (shape == "rect")
      read_rect();
    else if (shape == "circle")
      add_ellipse(size("r", diagonal()), size("r", diagonal()));
    else if (shape == "ellipse")
      read_ellipse();
    else if (shape == "line")
      read_line();
    else
      read_points(shape == "polygon");
    builder_.flush();
    Geom::PathVector paths;
    for (const Geom::Path& path : builder_.peek()) {
      if (path.size_default() > 0) paths.push_back(path);
    }
    return paths;
  }

  double diagonal() const { return std::hypot(whole_.width, whole_.height) / std::sqrt(2.0); }

  double length(const char* name, double whole) const {
    const auto attribute = element_.attribute(name);
    if (!attribute) return 0.0;
    const auto x = svg_length(attribute.value(), whole);
    if (!x) fail(std::string(name) + " '" + attribute.value() + "' is not a length");
    return *x;
  }
  double x(const char* name) const { return length(name, whole_.width); }
  double y(const char* name) const { return length(name, whole_.height); }
  double size(const char* name, double whole) const {
    const double value = length(name, whole);
    if (value < 0) fail(std::string(name) + " must be 0 or above");
    return value;
  }
  /// rx and ry: each follows the other where it is absent or auto.
  std::pair<double, double> radii() const {
    const auto given = [&](const char* name) {
      const std::string_view text = element_.attribute(name).value();
      return !text.empty() && text != "auto";
    };
    const double rx = given("rx") ? size("rx", whole_.width) : 0.0;
    const double ry = given("ry") ? size("ry", whole_.height) : rx;
    return {given("rx") ? rx : ry, ry};
  }
  [[noreturn]] void fail(const std::string& what) const { document_.fail(element_, what); }

  void read_path() {
    const std::string_view data = element_.attribute("d").value();
    try {
      Geom::SVGPathParser(builder_).parse(data.data(), int(data.size()));
    } catch (const std::exception&) {
      // 2geom does not say where. Its block-wise feed, which could, loses digits at the ends of
      // blocks.
      const auto strange = data.find_first_not_of("MmZzLlHhVvCcSsQqTtAaEe0123456789+-., \t\r\n\f");
      if (strange != std::string_view::npos) {
        fail("broken path data at '" + std::string(data.substr(strange, 16)) + "'");
      }
      fail("broken path data '" + std::string(data.substr(0, 40)) + "'");
    }
  }

  void read_rect() {
    const double x0 = x("x"), y0 = y("y");
    const double w = size("width", whole_.width), h = size("height", whole_.height);
    if (w == 0 || h == 0) return;
    auto [rx, ry] = radii();
    rx = std::min(rx, w / 2), ry = std::min(ry, h / 2);
    const double x1 = x0 + w, y1 = y0 + h;
    const auto corner = [&, rx = rx, ry = ry](double to_x, double to_y) {
      if (rx > 0 && ry > 0) builder_.arcTo(rx, ry, 0, false, true, {to_x, to_y});
    };
    if (rx == 0 || ry == 0) rx = ry = 0;
    builder_.moveTo({x0 + rx, y0});
    builder_.lineTo({x1 - rx, y0});
    corner(x1, y0 + ry);
    builder_.lineTo({x1, y1 - ry});
    corner(x1 - rx, y1);
    builder_.lineTo({x0 + rx, y1});
    corner(x0, y1 - ry);
    builder_.lineTo({x0, y0 + ry});
    corner(x0 + rx, y0);
    builder_.closePath();
  }

  void read_ellipse() {
    const auto [rx, ry] = radii();
    add_ellipse(rx, ry);
  }

  void add_ellipse(double rx, double ry) {
    if (rx == 0 || ry == 0) return;
    const double cx = x("cx"), cy = y("cy");
    builder_.moveTo({cx + rx, cy});
    builder_.arcTo(rx, ry, 0, false, true, {cx, cy + ry});
    builder_.arcTo(rx, ry, 0, false, true, {cx - rx, cy});
    builder_.arcTo(rx, ry, 0, false, true, {cx, cy - ry});
    builder_.arcTo(rx, ry, 0, false, true, {cx + rx, cy});
    builder_.closePath();
  }

  void read_line() {
    builder_.moveTo({x("x1"), y("y1")});
    builder_.lineTo({x("x2"), y("y2")});
  }

  void read_points(bool closed) {
    const auto points = svg_numbers(element_.attribute("points").value());
    if (!points || points->size() % 2) fail("points must be pairs of numbers");
    for (std::size_t i = 0; i < points->size(); i += 2) {
      const Geom::Point p((*points)[i], (*points)[i + 1]);
      if (i == 0)
        builder_.moveTo(p);
      else
        builder_.lineTo(p);
    }
    if (closed && !points->empty()) builder_.closePath();
  }

  const SvgDocument& document_;
  const SvgView& whole_;
  pugi::xml_node element_;
  Geom::PathBuilder builder_;
};

using Segments = std::vector<std::unique_ptr<Geom::Curve>>;

grid::Point point(const Geom::Point& p) { return {p[Geom::X], p[Geom::Y]}; }

double extent(const Geom::Curve& segment) { return segment.boundsFast().diameter(); }

/// The segments that have a length. A closing line that only bridges rounded coordinates is taken
/// into the last segment, so that it does not count as one.
Segments segments_of(const Geom::Path& path) {
  Segments segments;
  const auto bounds = path.boundsFast();
  const double least = bounds ? kNoLength * bounds->diameter() : 0.0;
  for (std::size_t k = 0; k < path.size_default(); ++k) {
    if (extent(path[k]) > 1e-3 * least) segments.emplace_back(path[k].duplicate());
  }
  const double closing = extent(path.closingSegment());
  if (path.closed() && segments.size() > 1 && closing <= least) {
    if (closing > 1e-3 * least) segments.pop_back();
    segments.back()->setFinal(path.initialPoint());
  }
  return segments;
}

const Geom::EllipticalArc* as_arc(const Geom::Curve& segment) {
  const auto* arc = dynamic_cast<const Geom::EllipticalArc*>(&segment);
  return arc && !arc->isChord() ? arc : nullptr;
}

int pieces_of(const Geom::Curve& segment) {
  const auto* arc = as_arc(segment);
  return arc ? std::max(1, int(std::ceil(arc->angularExtent() * 4 / std::numbers::pi - 1e-6))) : 1;
}

/// The piece [t0, t1] of an arc, of equal angle for equal t: control points at 4/3 tan(angle/4)
/// along the tangents of the unit circle, mapped to the ellipse.
grid::CubicBezier arc_piece(const Geom::EllipticalArc& arc, double t0, double t1) {
  const double start = arc.initialAngle().radians();
  const double from = start + t0 * arc.sweepAngle(), to = start + t1 * arc.sweepAngle();
  const double k = 4.0 / 3.0 * std::tan((to - from) / 4);
  const Geom::Affine ellipse = arc.unitCircleTransform();
  const Geom::Point a(std::cos(from), std::sin(from)), b(std::cos(to), std::sin(to));
  return {{point(t0 == 0 ? arc.initialPoint() : a * ellipse),
           point(Geom::Point(a[Geom::X] - k * a[Geom::Y], a[Geom::Y] + k * a[Geom::X]) * ellipse),
           point(Geom::Point(b[Geom::X] + k * b[Geom::Y], b[Geom::Y] - k * b[Geom::X]) * ellipse),
           point(t1 == 1 ? arc.finalPoint() : b * ellipse)}};
}

grid::CubicBezier as_cubic(const Geom::Curve& segment) {
  const auto* bezier = dynamic_cast<const Geom::BezierCurve*>(&segment);
  const auto control = [&](unsigned i) { return point((*bezier)[i]); };
  if (bezier && bezier->order() == 3) return {{control(0), control(1), control(2), control(3)}};
  const grid::Point a = point(segment.initialPoint()), b = point(segment.finalPoint());
  if (bezier && bezier->order() == 2) {
    const grid::Point c = control(1);
    return {{a, a + 2.0 / 3.0 * (c - a), b + 2.0 / 3.0 * (c - b), b}};
  }
  return grid::straight(a, b);
}

/// Transformed as Béziers, which is exact: 2geom's own transform of arcs loses digits, or throws,
/// where it flattens them.
grid::CubicBezier placed(grid::CubicBezier piece, const Geom::Affine& to_picture) {
  for (grid::Point& p : piece.control) p = point(Geom::Point(p.x, p.y) * to_picture);
  return piece;
}

void append(const Geom::Curve& segment, int pieces, const Geom::Affine& to_picture, Chain& chain) {
  const auto* arc = as_arc(segment);
  for (int k = 0; k < pieces; ++k) {
    const double t0 = double(k) / pieces, t1 = double(k + 1) / pieces;
    const grid::CubicBezier piece = arc           ? arc_piece(*arc, t0, t1)
                                    : pieces == 1 ? as_cubic(segment)
                                                  : as_cubic(segment).piece(t0, t1);
    chain.push_back(placed(piece, to_picture));
  }
}

}  // namespace

bool is_shape(pugi::xml_node element) {
  constexpr std::array<std::string_view, 7> kShapes = {"path", "rect",     "circle", "ellipse",
                                                       "line", "polyline", "polygon"};
  return std::ranges::find(kShapes, kind(element)) != kShapes.end();
}

Geom::PathVector shape_paths(const SvgDocument& document, const SvgView& whole,
                             pugi::xml_node element) {
  return ShapeReader(document, whole, element).read();
}

Chain chain(const Placed& path) {
  Chain all;
  for (const auto& segment : segments_of(path.path)) {
    append(*segment, pieces_of(*segment), path.to_picture, all);
  }
  return all;
}

std::pair<Chain, Chain> corresponding_chains(const Placed& source, const Placed& target) {
  const Segments from = segments_of(source.path), to = segments_of(target.path);
  if (from.size() != to.size()) {
    std::pair<Chain, Chain> chains{chain(source), chain(target)};
    if (chains.first.size() == chains.second.size() && !chains.second.empty()) {
      const grid::CubicBezier last = chains.second.back();
      chains.second.back() = last.piece(0.0, 0.5);
      chains.second.push_back(last.piece(0.5, 1.0));
    }
    return chains;
  }
  std::pair<Chain, Chain> chains;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const int pieces = std::max(pieces_of(*from[k]), pieces_of(*to[k]));
    append(*from[k], pieces, source.to_picture, chains.first);
    append(*to[k], pieces, target.to_picture, chains.second);
  }
  return chains;
}

}  // namespace drumhead::driver
