// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "driver_scratch.h"
#include "svg_curves.h"
#include "svg_document.h"
#include "svg_text.h"

namespace drumhead::driver {
namespace {

/// The drawing's view is (-10, 20) + 200 × 100, the picture has 400 × 200 pixels.
grid::Point in_picture(double x, double y) { return {2 * (x + 10), 2 * (y - 20)}; }

struct SvgCurves {
  std::vector<SvgCurve> curves;
  std::vector<std::string> warnings;
};

SvgCurves read_file(const std::filesystem::path& file, double width, double height) {
  SvgCurves read;
  read.curves = read_curves(SvgDocument(file), width, height,
                            [&](const std::string& warning) { read.warnings.push_back(warning); });
  return read;
}

const SvgCurves& torture() {
  static const SvgCurves curves = read_file(DRUMHEAD_TEST_DATA "/torture.svg", 400, 200);
  return curves;
}

const grid::CurvePair& pair(const SvgCurves& curves, const std::string& name) {
  for (const SvgCurve& curve : curves.curves) {
    if (curve.pair.name == name) return curve.pair;
  }
  throw std::runtime_error("no curve '" + name + "'");
}

void expect_near(grid::Point expected, grid::Point actual, double tolerance = 1e-9) {
  EXPECT_NEAR(expected.x, actual.x, tolerance);
  EXPECT_NEAR(expected.y, actual.y, tolerance);
}

/// The point of the torture file's curve at parameter t of Bézier k, against user units (x, y).
void expect_at(const std::string& name, std::size_t k, double t, double x, double y,
               double tolerance = 1e-9) {
  SCOPED_TRACE(name + ", piece " + std::to_string(k));
  const auto& source = pair(torture(), name).source;
  ASSERT_LT(k, source.size());
  expect_near(in_picture(x, y), source[k].at(t), tolerance);
}

SvgCurves read(const std::string& elements, double width = 100, double height = 100) {
  const Scratch scratch;
  return read_file(scratch.write("curves.svg", drawing(100, 100, elements)), width, height);
}

std::string error_of(const std::string& elements) {
  return message_of([&] { read(elements); });
}

std::string layers(const std::string& source, const std::string& target) {
  return "<g id='source'>" + source + "</g>\n<g id='target'>" + target + "</g>";
}

constexpr double kHalf = std::numbers::sqrt2 / 2;

TEST(DriverSvg, TransformsNestAndTheLastWrittenActsFirst) {
  expect_at("nested", 0, 0.0, 30, 40);
  expect_at("nested", 0, 1.0, 30, 50);
  expect_at("skewed", 0, 0.0, 20, 25);
  expect_at("skewed", 0, 1.0, 15, 35);
}

TEST(DriverSvg, UseIsMovedByItsOwnPlaceAndNotByThatOfItsOriginal) {
  const auto& target = pair(torture(), "nested").target;
  expect_near(in_picture(1, 2), target[0].at(0.0));
  expect_near(in_picture(1, 7), target[0].at(1.0));
  expect_near(in_picture(170, 80), pair(torture(), "sharp rect").target[0].at(0.0));
}

TEST(DriverSvg, RelativeCommandsContinueFromTheCurrentPoint) {
  const auto& first = pair(torture(), "relative#1").source;
  ASSERT_EQ(first.size(), 4u);
  expect_at("relative#1", 0, 1.0, 15, 35);
  expect_at("relative#1", 1, 1.0, 25, 35);
  expect_at("relative#1", 2, 1.0, 25, 30);
  expect_at("relative#1", 3, 1.0, 10, 30);
  expect_at("relative#2", 0, 0.0, 50, 30);
  expect_at("relative#2", 0, 1.0, 55, 35);
}

TEST(DriverSvg, SmoothCommandsReflectTheControlPoint) {
  expect_at("smooth", 1, 0.5, 35, 67.5);
  expect_at("quadratic", 0, 0.5, 65, 65);
  expect_at("quadratic", 1, 0.5, 75, 55);
}

TEST(DriverSvg, ArcsFollowTheirEllipse) {
  expect_at("arc", 0, 0.0, 100, 60);
  expect_at("arc", 2, 0.0, 110, 50);
  expect_at("arc", 3, 1.0, 120, 60);
  expect_at("large arc", 3, 0.0, 130 - 10 * kHalf, 70 + 10 * kHalf);
  expect_at("arc enlarged to its chord", 2, 0.0, 160, 50);
  expect_at("turned arc", 2, 0.0, 110, 70);
}

TEST(DriverSvg, ArcPiecesStayWithinFiveMillionthsOfTheRadius) {
  for (const grid::CubicBezier& piece : pair(torture(), "arc").source) {
    for (double t = 0; t <= 1; t += 0.0625) {
      EXPECT_NEAR(grid::length(piece.at(t) - in_picture(110, 60)), 20, 5e-6 * 20);
    }
  }
}

TEST(DriverSvg, LengthsHaveUnits) {
  expect_at("circle in units", 0, 0.0, 105.6, 96);
  expect_at("circle in units", 2, 0.0, 96, 105.6);
  expect_at("line in percent", 0, 0.0, 100, 50);
  expect_at("line in percent", 0, 1.0, 48, 37.5);
  EXPECT_DOUBLE_EQ(svg_length(" 2.54cm ", 0).value(), 96);
  EXPECT_DOUBLE_EQ(svg_length("-1e1px", 0).value(), -10);
  EXPECT_DOUBLE_EQ(svg_length("+.5Q", 0).value(), 12 / 25.4);
  for (const char* wrong : {"", "px", "nan", "inf", "1em", "1 2", "0x10", "--1", "+-1"}) {
    EXPECT_FALSE(svg_length(wrong, 0)) << wrong;
  }
}

TEST(DriverSvg, ShapesStartAndRunAsSvgSays) {
  expect_at("mirrored round rect", 0, 0.0, 58, 40);
  expect_at("mirrored round rect", 0, 1.0, 42, 40);
  expect_at("mirrored round rect", 1, 1.0, 42 - 2 * kHalf, 42 - 2 * kHalf, 1e-4);
  expect_at("turned ellipse", 0, 0.0, -90, 40);
  expect_at("turned ellipse", 2, 0.0, -95, 30);
  expect_at("polygon", 2, 0.5, 145, 85);
  expect_at("sharp rect", 2, 0.5, 170, 90);
  EXPECT_EQ(pair(torture(), "sharp rect").source.size(), 4u);
}

TEST(DriverSvg, AClosingLineThatOnlyBridgesRoundingIsNoSegment) {
  const auto& source = pair(torture(), "rounded closing").source;
  ASSERT_EQ(source.size(), 2u);
  EXPECT_EQ(source[1].at(1.0), source[0].at(0.0));
}

TEST(DriverSvg, NamesComeFromLabelThenDataNameThenIdAndFromSuffixes) {
  expect_near(in_picture(0, 26), pair(torture(), "left eye").target[0].at(0.0));
  expect_near(in_picture(2, 22), pair(torture(), "flag").target[0].at(0.0));
  EXPECT_EQ(torture().curves.size(), 20u);
  EXPECT_TRUE(torture().warnings.empty());
}

/// The start of the pin `a`, whose path is "M 30 20 L 40 60", among elements with attributes.
grid::Point moved_start(const std::string& group, const std::string& path) {
  return read("<g id='pin'><g " + group + "><path id='a' d='M 30 20 L 40 60' " + path +
              "/></g></g>")
      .curves.at(0)
      .pair.source[0]
      .at(0.0);
}

TEST(DriverSvg, TransformsActAboutTheirOrigin) {
  // A quarter turn takes (x, y) from its origin to (-y, x).
  const std::string turn = "transform='rotate(90)' ";
  expect_near({-20, 30}, moved_start("", turn));
  expect_near({10, 40}, moved_start("", turn + "transform-origin='10px 20 0'"));
  expect_near({80, 30}, moved_start("", turn + "transform-origin='50% 50%'"));
  expect_near({80, 30}, moved_start("", turn + "transform-origin='center'"));
  expect_near({30, -20}, moved_start("", turn + "transform-origin='top'"));
  expect_near({30, -20}, moved_start("", turn + "transform-origin='top center'"));
  expect_near({180, 30}, moved_start("", turn + "style='transform-origin: right bottom'"));
  expect_near({10, 10}, moved_start(turn + "style='transform-origin:25px 5px'", ""));
  expect_near({30, 20}, moved_start("", "transform-origin='7px 7px'"));
}

TEST(DriverSvg, FillBoxIsTheBoxAroundTheShapes) {
  const std::string turn = "style='transform-box: fill-box; transform-origin: 50% 50%; ";
  expect_near({55, 35}, moved_start("", turn + "transform: rotate(90deg)'"));
  expect_near({55, 35}, moved_start(turn + "transform: rotate(90deg)'", ""));
  // The box of the group is that of the path already moved: from (130, 20) to (140, 60).
  expect_near({155, 35},
              moved_start(turn + "transform: rotate(90deg)'", "transform='translate(100)'"));
}

TEST(DriverSvg, AGroupAroundOneNamelessShapeNamesIt) {
  const std::string shape = "<path d='M0 0L9 9'/>";
  const auto wrapped = [&](const std::string& name) {
    return "<g id='" + name + "'><title>t</title><g>" + shape + "</g></g>";
  };
  EXPECT_EQ(pair(read(layers(wrapped("a"), wrapped("a-target"))), "a").name, "a");
  EXPECT_EQ(pair(read(wrapped("b-source") + wrapped("b-target")), "b").name, "b");
  EXPECT_EQ(
      pair(read(layers("<path id='c1' serif:id='c' d='M0 0L9 9'/>", "<path id='c' d='M0 0L9 9'/>")),
           "c")
          .name,
      "c");
  EXPECT_NE(error_of(layers("<g id='a'>" + shape + shape + "</g>", "")).find("path: has no name"),
            std::string::npos);
  EXPECT_NE(error_of("<g id='b-source'>" + shape + shape + "</g>").find("the suffix belongs"),
            std::string::npos);
}

TEST(DriverSvg, PinsAreTheirOwnTargetsAndNeedNoName) {
  const SvgCurve& pin = torture().curves.back();
  EXPECT_TRUE(pin.pin);
  ASSERT_EQ(pin.pair.source.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(pin.pair.source[k].control, pin.pair.target[k].control);
  }
}

TEST(DriverSvg, EqualSegmentCountsPairSegmentBySegmentAndArcsByAngle) {
  const auto curves = read(layers("<path id='a' d='M0 0 A10 10 0 0 1 20 0 L 30 0'/>",
                                  "<path id='a-target' d='M0 50 L 40 50 L 60 50'/>"));
  const auto& a = pair(curves, "a");
  ASSERT_EQ(a.source.size(), a.target.size());
  expect_near({10, -10}, a.source[2].at(0.0));
  expect_near({20, 50}, a.target[2].at(0.0));
  expect_near({40, 50}, a.target.back().at(0.0));
}

TEST(DriverSvg, DifferentSegmentCountsAreLeftToArcLength) {
  // The half circle is four Béziers and so are the lines: only their number may not decide.
  const auto curves = read(layers("<path id='a' d='M0 50 A10 10 0 0 1 20 50'/>",
                                  "<path id='a-target' d='M0 50 L 1 50 L 2 50 L 3 50 L 20 50'/>"));
  const auto segments = grid::matched(pair(curves, "a"));
  double covered = 0;
  for (const grid::SegmentPair& segment : segments) covered += grid::arc_length(segment.source);
  EXPECT_NEAR(covered, 10 * std::numbers::pi, 1e-3);
  double passed = 0;
  for (const grid::SegmentPair& segment : segments) {
    passed += grid::arc_length(segment.source);
    EXPECT_NEAR(segment.target.at(1.0).x / 20, passed / covered, 1e-3);
  }
}

TEST(DriverSvg, WithoutAViewUserUnitsArePixelsAndWithOneItIsStretched) {
  const Scratch scratch;
  const std::string curve = "<g id='pin'><path d='M 1 2 L 3 4'/></g></svg>";
  const auto start = [&](const std::string& root) {
    return read_file(scratch.write("a.svg", root + curve), 400, 200)
        .curves[0]
        .pair.source[0]
        .at(0.0);
  };
  expect_near({1, 2}, start("<svg>"));
  expect_near({1, 2}, start("<svg width='100%' height='100%'>"));
  expect_near({4, 4}, start("<svg width='100px' height='100'>"));
  expect_near({400 / 96.0, 400 / 96.0}, start("<svg width='1in' height='72pt'>"));
  expect_near({0, 4}, start("<svg width='9mm' viewBox='1 0 100 100'>"));
}

TEST(DriverSvg, AnAspectThatDiffersByMoreThanAHundredthIsAWarning) {
  EXPECT_TRUE(read("<g id='pin'><path d='M1 1L2 2'/></g>", 1000, 991).warnings.empty());
  const auto warnings = read("<g id='pin'><path d='M1 1L2 2'/></g>", 1000, 985).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("100 x 100 and is stretched onto a picture of 1000 x 985 pixels"),
            std::string::npos);
}

TEST(DriverSvg, AClosedTargetThatRunsBackwardsIsAWarning) {
  const auto curves = read(layers("<path id='a' d='M10 10 L20 10 L20 20 Z'/>",
                                  "<path id='a-target' d='M10 10 L20 20 L20 10 Z'/>"));
  ASSERT_EQ(curves.warnings.size(), 1u);
  EXPECT_NE(curves.warnings[0].find("'a' runs the other way round"), std::string::npos);
}

struct Broken {
  std::string elements, error;
};

TEST(DriverSvg, ErrorsNameFileLineAndElement) {
  const std::string a = "<path id='a' d='M0 0L9 9'/>", b = "<path id='b' d='M0 0L9 9'/>";
  const std::string target_a = "<path id='a-target' d='M0 0L9 9'/>";
  std::string nested;
  for (int n = 0; n < 1000; ++n) nested = "<g>" + nested + "</g>";
  for (const auto& [elements, error] : std::vector<Broken>{
           {layers(a, ""), ":2: path 'a': 'a' has no target"},
           {layers(a, target_a + b), ":3: path 'b': 'b' has no source"},
           {layers("<path d='M0 0L9 9'/>", ""), ":2: path: has no name"},
           {layers("<path id=' ' d='M0 0L9 9'/>", ""), ":2: path: has no name"},
           {layers(a + "<path inkscape:label='a' id='c' d='M0 0L9 9'/>", target_a),
            ":2: path 'a': the name 'a' was used before"},
           {layers(a, target_a) + "<g id='pin'><path inkscape:label='a' d='M0 0L9 9'/></g>",
            ":3: path 'a': the name 'a' was used before"},
           {layers("<path id='a' d='M0 0 L 9 oops'/>", target_a),
            ":2: path 'a': broken path data at 'oops'"},
           {layers("<path id='a' d='M0 0 L 9 9 8'/>", target_a),
            ":2: path 'a': broken path data 'M0 0 L 9 9 8'"},
           {layers("<path id='a' d='L 9 9'/>", target_a), ":2: path 'a': broken path data 'L 9 9'"},
           {layers("<path id='a'/>", target_a), ":2: path 'a': has no length"},
           {layers("<path id='a' d='M5 5 L5 5'/>", target_a), ":2: path 'a': has no length"},
           {layers("<path id='a' d='M5 5 L6 6 M7 7 L8 8'/>", target_a),
            "has 2 subpaths and its target 1"},
           {layers("<circle id='a' r='-1'/>", target_a), ":2: circle 'a': r must be 0 or above"},
           {layers("<circle id='a' r='big'/>", target_a),
            ":2: circle 'a': r 'big' is not a length"},
           {layers("<polygon id='a' points='1 2 3'/>", target_a),
            "points must be pairs of numbers"},
           {layers("<path id='a' transform='turn(1)' d='M0 0L9 9'/>", target_a),
            ":2: path 'a': its transform cannot be read"},
           {layers("<path id='a' transform='scale(2)' transform-origin='1em' d='M0 0L9 9'/>", ""),
            ":2: path 'a': its transform-origin '1em' cannot be read"},
           {layers("<path id='a' style='transform:scale(2);transform-box:stroke-box'/>", ""),
            ":2: path 'a': its transform-box 'stroke-box' is not read"},
           {"<g id='pin' transform='scale(2)' style='transform-box:fill-box'><text id='t'/></g>",
            ":2: text 't': transform-box: fill-box is read of shapes and groups"},
           {layers("<use id='a' href='#nowhere'/>", target_a), "no shape of this file"},
           {layers("<svg id='a'/>", target_a), ":2: svg 'a': is not read among curves"},
           {layers(target_a, ""), "its suffix says another layer"},
           {layers("<circle id='a' r='9'/>", target_a), "'a' is open but its source is closed"},
           {"<g id='source'><g id='target'/></g>",
            ":2: g 'target': this layer lies in the layer 'source'"},
           {"<g id='a-source'>" + a + "</g>", "the suffix belongs on the name of a path"},
           {a + b, "curves.svg: no curves"},
           {"<g id='Source'>" + a + "</g>", "curves.svg: no curves"},
           {nested, "curves.svg: elements are nested deeper than 1000"},
           {"<g id='source'>", "curves.svg:3: is not well-formed XML: Start-end tags mismatch"}}) {
    const std::string message = error_of(elements);
    EXPECT_NE(message.find(error), std::string::npos) << elements << "\n  " << message;
    EXPECT_NE(message.find("curves.svg"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(DriverSvg, ArtMayHoldWhatCurvesMayNot) {
  const std::string art = "<g transform='scale(2)' style='transform-box:fill-box'><text/></g>";
  EXPECT_EQ(read(art + "<g><g id='pin'><path d='M1 1L2 2'/></g></g>").curves.size(), 1u);
  EXPECT_NE(error_of("<g style='transform:turn(1)'><path id='a-source' d='M0 0L9 9'/></g>")
                .find(":2: g: its transform cannot be read"),
            std::string::npos);
}

TEST(DriverSvg, TextAmongCurvesIsLeftOutWithAWarning) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.svg",
      "<svg><g id='pin'><title>t</title><path id='a' d='M1 1L9 9'/><text id='b'/></g></svg>");
  const SvgCurves read = read_file(file, 10, 10);
  EXPECT_EQ(read.curves.size(), 1u);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("a.svg:1: text 'b' is not a path"), std::string::npos);
}

TEST(DriverSvg, AWarningIsHeardThoughTheRestCannotBeRead) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.svg", "<svg><g id='source'><path id='a' d='M1 1L9 9'/><text id='b'/></g></svg>");
  std::string heard;
  const auto warn = [&](const std::string& warning) { heard += warning; };
  EXPECT_NE(message_of([&] { read_curves(SvgDocument(file), 10, 10, warn); }).find("no target"),
            std::string::npos);
  EXPECT_NE(heard.find("text 'b' is not a path"), std::string::npos) << heard;
}

TEST(DriverSvg, TheViewMustBeARectangle) {
  const Scratch scratch;
  for (const char* root : {"<svg viewBox='0 0 0 9'>", "<svg viewBox='0 0 9'>", "<svg viewBox='a'>",
                           "<svg width='-1' height='2'>", "<svg width='1em' height='2'>"}) {
    const auto file = scratch.write("a.svg", std::string(root) + "</svg>");
    EXPECT_NE(message_of([&] { read_file(file, 10, 10); }).find("a.svg:1: svg: "),
              std::string::npos)
        << root;
  }
}

}  // namespace
}  // namespace drumhead::driver
