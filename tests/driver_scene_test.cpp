// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "command_line.h"
#include "curve_settings.h"
#include "driver_scratch.h"
#include "scene.h"

namespace drumhead::driver {
namespace {

Options read(const std::string& text) {
  const Scratch scratch;
  Options options;
  read_scene(scratch.write("scene.toml", text), options);
  return options;
}

std::string error_of(const std::string& text) {
  return message_of([&] { read(text); });
}

Options from_command_line(std::vector<std::string> words) {
  words.insert(words.begin(), {"drumhead", "warp"});
  std::vector<char*> arguments;
  arguments.reserve(words.size());
  for (std::string& word : words) arguments.push_back(word.data());
  return read_command_line(int(arguments.size()), arguments.data()).value();
}

TEST(DriverScene, EveryKeyIsRead) {
  const Scratch scratch;
  const auto file = scratch.write("scene.toml", R"(
picture = "a.jpg"
curves = "sub/b.svg"
plate = "sub/c.png"
cells = 100
margin = 0
model = "harmonic"
mu = 2
kappa = inf
weight = 1e3
exact = true
solver = "coloured-kaczmarz"
curve_method = "conforming"
tolerance = 0.5
threads = 3
output = "/tmp/c.png"
overlay = "d.png"
lattice = "e.exr"
report = "f.json"
quiet = true
[[curve]]
name = "brow"
weight = 5
[[curve]]
name = "jaw"
turn = -270
weight = "inf"
)");
  Options o;
  read_scene(file, o);
  EXPECT_EQ(o.picture, scratch / "a.jpg");
  EXPECT_EQ(o.curves, scratch / "sub/b.svg");
  EXPECT_EQ(o.plate, scratch / "sub/c.png");
  EXPECT_EQ(o.lattice.cells, 100);
  EXPECT_EQ(o.lattice.margin, 0);
  EXPECT_EQ(o.model, kernels::Model::harmonic);
  EXPECT_EQ(o.mu, 2);
  EXPECT_TRUE(std::isinf(o.kappa));
  EXPECT_EQ(o.weight, 1000);
  EXPECT_TRUE(o.exact);
  EXPECT_EQ(o.solver, multigrid::Solver::coloured_kaczmarz);
  EXPECT_EQ(o.curve_method, multigrid::CurveMethod::conforming);
  EXPECT_EQ(o.tolerance_px, 0.5);
  EXPECT_EQ(o.threads, 3);
  EXPECT_EQ(o.output, "/tmp/c.png");
  EXPECT_EQ(o.overlay, scratch / "d.png");
  EXPECT_EQ(o.lattice_file, scratch / "e.exr");
  EXPECT_EQ(o.report, scratch / "f.json");
  EXPECT_TRUE(o.quiet);
  ASSERT_EQ(o.overrides.size(), 2u);
  EXPECT_EQ(o.overrides[0].weight, 5);
  EXPECT_FALSE(o.overrides[0].turn_degrees);
  EXPECT_EQ(o.overrides[1].turn_degrees, -270);
  EXPECT_TRUE(std::isinf(*o.overrides[1].weight));
}

TEST(DriverScene, EveryFlagHasAKeyAndEveryKeyIsInTheHelp) {
  const Scratch scratch;
  const RunResult help = run_drumhead(scratch, {"warp", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const Key& key : keys()) {
    const std::string name = !key.flag ? key.name == "picture" ? "PICTURE" : "CURVES.svg"
                                       : flag_name(key) + (key.value.empty() ? "" : " ");
    EXPECT_NE(help.out.find(" " + name), std::string::npos) << name;
  }
}

struct Wrong {
  std::string text, error;
};

TEST(DriverScene, ErrorsNameFileLineAndBound) {
  for (const auto& [text, error] : std::vector<Wrong>{
           {"cells = 0", "scene.toml:1: cells = 0: must be a whole number from 1 to 16384"},
           {"\ncells = 16385",
            "scene.toml:2: cells = 16385: must be a whole number from 1 to 16384"},
           {"cells = 1.5", "cells = 1.5: must be a whole number"},
           {"cells = \"12\"", "cells = '12': must be a whole number"},
           {"\n\nkappa = nan", "scene.toml:3: kappa = nan: must be a number, 0 or above, or inf"},
           {"kappa = -1", "kappa = -1"},
           {"margin = inf", "margin = inf: must be a finite number, 0 or above"},
           {"margin = nan", "margin = nan: must be"},
           {"mu = 0", "mu = 0: must be a finite number above 0"},
           {"weight = 0.0", "weight = 0.0: must be a number above 0, or inf"},
           {"tolerance = 0", "tolerance = 0: must be a finite number above 0, or auto"},
           {"tolerance = \"lots\"", "must be a finite number above 0, or auto"},
           {"threads = 0", "threads = 0: must be a whole number from 1"},
           {"cell_size = inf", "cell_size = inf: must be a finite number above 0"},
           {"cells = 5\ncell_size = 5", "scene.toml:2: cell_size: give either cells or cell_size"},
           {"model = \"rubber\"", "model = 'rubber': must be one of: crpm, harmonic, arap"},
           {"eps = 1", "eps = 1: must be a number from 0 to below 1"},
           {"exact = 1", "exact = 1: must be true or false"},
           {"solver = \"cg\"", "solver = 'cg': must be one of: gcr, kaczmarz, coloured-kaczmarz"},
           {"curve_method = \"cut\"",
            "curve_method = 'cut': must be one of: auto, averaged, conforming"},
           {"overlay = \"a.jpg\"", "overlay = 'a.jpg': must be the path of a .png file"},
           {"output = \"\"", "output = '': must be the path of a file"},
           {"kapa = 1",
            "scene.toml:1: kapa = 1: unknown key; a scene has picture, curves, plate, cells"},
           {"[kappa]\na = 1", "scene.toml:1: kappa: must be a number"},
           {"mu = [1, 2]", "scene.toml:1: mu: must be"},
           {"mu = 1\nmu = 2", "scene.toml:2: "},
           {"mu = = 2", "scene.toml:1: "},
           {"curve = 3", "scene.toml:1: curve: must be tables, [[curve]]"},
           {"[[curve]]\nweight = 1", "scene.toml:1: [[curve]] without a name"},
           {"[[curve]]\nname = \"a\"\nweight = nan", "scene.toml:3: weight = nan: must be"},
           {"[[curve]]\nname = \"a\"\nturn = inf", "scene.toml:3: turn = inf: must be"},
           {"[[curve]]\nname = \"a\"\nwight = 1", "scene.toml:3: wight = 1: unknown key"},
           {"[[curve]]\nname = \"a\"\n[[curve]]\nname = \"a\"",
            "curve 'a' was already given at"}}) {
    const std::string message = error_of(text);
    EXPECT_NE(message.find(error), std::string::npos) << text << "\n  " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  Options options;
  EXPECT_NE(message_of([&] { read_scene("nowhere.toml", options); }).find("nowhere.toml: "),
            std::string::npos);
}

TEST(DriverScene, FlagsOverruleTheScene) {
  const Scratch scratch;
  const std::string file =
      scratch.write("s.toml", "picture = \"a.png\"\ncell_size = 3\nkappa = 4\nquiet = true");
  const Options o = from_command_line({file, "--cells", "10", "-o", "here.png", "--mu", "3"});
  EXPECT_EQ(o.picture, scratch / "a.png");
  EXPECT_EQ(o.lattice.cell_px, 0);
  EXPECT_EQ(o.lattice.cells, 10);
  EXPECT_EQ(o.kappa, 4);
  EXPECT_EQ(o.mu, 3);
  EXPECT_EQ(o.output, "here.png");
  EXPECT_TRUE(o.quiet);
}

TEST(DriverScene, FlagsTakeTheNamedValues) {
  const Options o = from_command_line({"12.png", "b.svg", "--kappa", "inf", "--weight=inf",
                                       "--tolerance", "auto", "--exact", "--solver", "minres",
                                       "--curve-method", "conforming", "--output", "1"});
  EXPECT_EQ(o.picture, "12.png");
  EXPECT_EQ(o.curves, "b.svg");
  EXPECT_EQ(o.output, "1");
  EXPECT_TRUE(std::isinf(o.kappa));
  EXPECT_TRUE(std::isinf(o.weight));
  EXPECT_EQ(o.tolerance_px, 0);
  EXPECT_TRUE(o.exact);
  EXPECT_EQ(o.solver, multigrid::Solver::minres);
  EXPECT_EQ(o.curve_method, multigrid::CurveMethod::conforming);
}

TEST(DriverScene, WrongFlagsNameTheFlag) {
  for (const auto& given :
       std::vector<std::pair<std::string, std::string>>{{"--cells", "0"},
                                                        {"--cells", "2.0"},
                                                        {"--cells", "many"},
                                                        {"--cells", ""},
                                                        {"--margin", "-1"},
                                                        {"--kappa", "nan"},
                                                        {"--mu", "inf"},
                                                        {"--mu", "1e999"},
                                                        {"--weight", "-inf"},
                                                        {"--tolerance", "0"},
                                                        {"--solver", "GCR"},
                                                        {"--curve-method", "exact"},
                                                        {"--threads", "-2"},
                                                        {"--model", "rubber"},
                                                        {"--eps", "-0.1"},
                                                        {"--lattice", "a.png"}}) {
    const std::string flag = given.first, value = given.second;
    const std::string message = message_of([&] {
      from_command_line({"a.png", "b.svg", flag, value});
    });
    std::string expected = flag;
    expected.append(" ").append(value).append(": must be ");
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  }
  EXPECT_NE(message_of([] {
              from_command_line({"a.png", "--cells", "2", "--cell-size", "2"});
            }).find("give either --cells or --cell-size"),
            std::string::npos);
}

SvgCurve segment(const std::string& name, grid::Point a, grid::Point b, bool pin = false) {
  SvgCurve curve;
  curve.pair.name = name;
  curve.pair.source = curve.pair.target = {grid::straight(a, b)};
  curve.pin = pin;
  curve.place = "a.svg:7: path '" + name + "'";
  return curve;
}

TEST(DriverScene, WeightsAndTurnsReachTheirCurves) {
  Options options;
  options.weight = 10;
  options.overrides = {{"b", 3.0, {}, "s.toml:1"}, {"c", {}, 90.0, "s.toml:4"}};
  const auto pairs =
      apply_settings(options, {segment("a", {}, {1, 1}), segment("b#1", {}, {1, 1}),
                               segment("b#2", {}, {1, 1}), segment("c", {}, {1, 1}, true)});
  EXPECT_EQ(pairs[0].weight, 10);
  EXPECT_EQ(pairs[1].weight, 3);
  EXPECT_EQ(pairs[2].weight, 3);
  EXPECT_TRUE(std::isinf(pairs[3].weight));
  EXPECT_EQ(pairs[3].turn_degrees, 90);
  EXPECT_NE(message_of([&] {
              apply_settings(options, {segment("b", {}, {1, 1})});
            }).find("s.toml:4: [[curve]] 'c': "),
            std::string::npos);
}

TEST(DriverScene, ASourceMustStayInTheLatticeBetweenItsEndsToo) {
  const grid::Lattice lattice = grid::make_lattice(100, 50, {.cells = 10, .margin = 0});
  check_inside(lattice, {segment("edge", {0, 0}, {100, 50})});
  SvgCurve bulge = segment("bulge", {10, 10}, {20, 10});
  bulge.pair.source[0].control[1].y = bulge.pair.source[0].control[2].y = -10;
  EXPECT_EQ(
      message_of([&] { check_inside(lattice, {bulge}); }),
      "a.svg:7: path 'bulge': leaves the lattice at (15.0, -5.0) px; it must stay within x 0.0 "
      "to 100.0 and y 0.0 to 50.0 px (see --margin)");
  bulge.pair.source[0].control[1].y = bulge.pair.source[0].control[2].y = -3;
  check_inside(lattice, {bulge});
}

}  // namespace
}  // namespace drumhead::driver
