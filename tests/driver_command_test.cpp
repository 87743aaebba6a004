// SPDX-License-Identifier: MIT
// The executable on bad input: exit code 2, one line that names file, place and bound, no file left
// behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "driver_scratch.h"
#include "image.h"
#include "interrupt.h"
#include "progress.h"

namespace drumhead::driver {
namespace {

using Words = std::vector<std::string>;

class DriverCommand : public testing::Test {
 protected:
  DriverCommand() {
    Image image{OIIO::ImageSpec(40, 40, 3, OIIO::TypeDesc::UINT8), std::vector<float>(4800, 0.5f)};
    write_image(image, scratch / "photo.png");
    scratch.write("curves.svg",
                  drawing(40, 40,
                          "<g id='source'><path id='a' d='M10 10 L30 10'/></g>"
                          "<g id='target'><path id='a-target' d='M10 12 L30 12'/></g>"));
  }

  /// Runs and demands exit code 2, one line with all of `parts`, and no new file.
  void expect_refused(const Words& words, const Words& parts) {
    const Words before = scratch.files();
    const RunResult result = run_drumhead(scratch, words);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(result.err.starts_with("drumhead: ")) << result.err;
    for (const std::string& part : parts) {
      EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n  in " << result.err;
    }
    EXPECT_EQ(scratch.files(), before);
  }

  Scratch scratch;
};

TEST_F(DriverCommand, RefusesAnUnpairedPath) {
  scratch.write("bad.svg", drawing(40, 40, "<g id='source'>\n<path id='brow' d='M1 1 L9 9'/></g>"));
  expect_refused({"warp", "photo.png", "bad.svg", "-o", "out.png"},
                 {"bad.svg:3: path 'brow'", "has no target"});
}

TEST_F(DriverCommand, RefusesBrokenPathData) {
  scratch.write("bad.svg", drawing(40, 40, "<g id='pin'><path id='p7' d='M1 1 L9 x9'/></g>"));
  expect_refused({"warp", "photo.png", "bad.svg", "-o", "out.png"},
                 {"bad.svg:2: path 'p7': broken path data at 'x9'"});
}

TEST_F(DriverCommand, WarnsOfADrawingBeforeItRefusesIt) {
  scratch.write("bad.svg", drawing(40, 80, "<g id='source'><path id='brow' d='M1 1 L9 9'/></g>"));
  const RunResult result =
      run_drumhead(scratch, {"warp", "photo.png", "bad.svg", "-o", "out.png", "--quiet"});
  EXPECT_EQ(result.exit_code, 2);
  const auto warning = result.err.find("warning: bad.svg: the drawing is 40 x 80 and is stretched");
  const auto error = result.err.find("has no target");
  EXPECT_LT(warning, error) << result.err;
  EXPECT_NE(error, std::string::npos) << result.err;
}

TEST_F(DriverCommand, WarnsOfAnInstructionSetThatIsNone) {
  setenv("DRUMHEAD_ISA", "mmx", 1);
  const RunResult result =
      run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "-o", "out.png", "--quiet"});
  unsetenv("DRUMHEAD_ISA");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.err.starts_with(
      "drumhead: warning: DRUMHEAD_ISA=mmx: not one of scalar, sse2, avx2, avx512; using "))
      << result.err;
}

TEST_F(DriverCommand, RefusesHalfFloatMapsAndSaysWhy) {
  expect_refused(
      {"warp", "photo.png", "curves.svg", "--backward-map", "b.exr", "--map-depth", "half"},
      {"--map-depth half: must be float", "half keeps 11"});
  scratch.write("scene.toml",
                "picture = \"photo.png\"\ncurves = \"curves.svg\"\nmap_depth = \"half\"\n");
  expect_refused({"warp", "scene.toml"}, {"scene.toml:3: map_depth", "must be float"});
}

TEST_F(DriverCommand, RefusesMapsThatAreNoExrAndConventionsThatAreNone) {
  expect_refused({"warp", "photo.png", "curves.svg", "--forward-map", "f.png"},
                 {"--forward-map f.png", "must be the path of an .exr file"});
  expect_refused({"warp", "photo.png", "curves.svg", "--lattice-vtk", "l.vtk"},
                 {"--lattice-vtk l.vtk", "must be the path of a .vtu or .vts file"});
  expect_refused({"warp", "photo.png", "curves.svg", "--map-convention", "uv"},
                 {"--map-convention uv", "must be one of: st, pixel, displacement"});
  expect_refused(
      {"warp", "photo.png", "curves.svg", "--forward-map", "m.exr", "--backward-map", "m.exr"},
      {"m.exr", "must not be the same file"});
}

TEST_F(DriverCommand, RefusesAMissingPicture) {
  expect_refused({"warp", "none.png", "curves.svg", "-o", "out.png"}, {"none.png", "no such file"});
}

TEST_F(DriverCommand, RefusesMissingCurves) {
  expect_refused({"warp", "photo.png", "none.svg", "-o", "out.png"},
                 {"none.svg: cannot be read: no such file"});
  expect_refused({"warp", "photo.png", "-o", "out.png"}, {"photo.png: no CURVES.svg was given"});
}

TEST_F(DriverCommand, RefusesZeroCells) {
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--cells", "0"},
                 {"--cells 0: must be a whole number from 1 to 16384"});
}

TEST_F(DriverCommand, RefusesNanInAScene) {
  scratch.write("scene.toml", "picture = \"photo.png\"\ncurves = \"curves.svg\"\nkappa = nan\n");
  expect_refused({"warp", "scene.toml", "-o", "out.png"},
                 {"scene.toml:3: kappa = nan: must be a number, 0 or above, or inf"});
}

TEST_F(DriverCommand, RefusesMembranesOutsideTheirDomain) {
  expect_refused(
      {"warp", "photo.png", "curves.svg", "-o", "out.png", "--model", "arap", "--kappa", "inf"},
      {"kappa of model arap", "at most 1e6"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--model", "fold-free",
                  "--kappa", "101"},
                 {"kappa of model fold-free = 101", "at most 100"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--eps", "0.1"},
                 {"eps: only the models arap and fold-free have one"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--model", "rubber"},
                 {"--model rubber: must be one of: crpm, harmonic, arap"});
  expect_refused(
      {"warp", "photo.png", "curves.svg", "-o", "out.png", "--model", "stvk", "--solver", "minres"},
      {"solver minres: must be gcr for model stvk"});
}

TEST_F(DriverCommand, RefusesAnUnwritableOutputBeforeItWorks) {
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "no/such/folder/out.png"},
                 {"no/such/folder/out.png: cannot be written: No such file or directory"});
  std::filesystem::create_directory(scratch / "folder.png");
  expect_refused({"warp", "photo.png", "curves.svg", "--report", "good.json", "-o", "folder.png"},
                 {"folder.png: cannot be written: not a regular file"});
}

TEST_F(DriverCommand, RefusesACurveOutsideTheLattice) {
  scratch.write("bad.svg", drawing(40, 40, "<g id='pin'><path id='far' d='M1 1 L50 9'/></g>"));
  expect_refused(
      {"warp", "photo.png", "bad.svg", "-o", "out.png", "--cells", "10", "--margin", "0"},
      {"bad.svg:2: path 'far': leaves the lattice at (50.0, 9.0) px",
       "x 0.0 to 40.0 and y 0.0 to 40.0 px"});
}

TEST_F(DriverCommand, RefusesOutputsThatWouldReplaceOneAnotherOrAnInput) {
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "./photo.png"},
                 {"./photo.png: an output must not replace an input"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--overlay", "./out.png"},
                 {"out.png: two outputs must not be the same file"});
  scratch.write("scene.toml", "picture = \"photo.png\"\ncurves = \"curves.svg\"\n");
  expect_refused({"warp", "scene.toml", "--report", "scene.toml"},
                 {"scene.toml: an output must not replace an input"});
}

TEST_F(DriverCommand, RefusesUnknownWordsAndMissingOnes) {
  expect_refused({}, {"no command"});
  expect_refused({"wrap", "photo.png", "curves.svg"}, {"no command 'wrap'; there is warp"});
  expect_refused({"wrap"}, {"wrap"});
  expect_refused({"warp"}, {"no PICTURE"});
  expect_refused({"warp", "photo.png", "curves.svg"}, {"no output"});
  expect_refused({"warp", "photo.png", "curves.svg", "--frobnicate"}, {"--frobnicate"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o"}, {"--output"});
  expect_refused({"warp", "photo.png", "curves.svg", "more.svg", "-o", "out.png"},
                 {"'more.svg': too many"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.nothing"},
                 {"out.nothing: no picture format"});
}

TEST_F(DriverCommand, RefusesPicturesThatItCannotMake) {
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--border", "torus"},
                 {"--border torus: must be one of: clamp, mirror, transparent"});
  expect_refused({"warp", "photo.png", "curves.svg", "--jacobian", "j.jpg"},
                 {"--jacobian j.jpg: must be the path of a .png file"});
  expect_refused({"warp", "photo.png", "curves.svg", "--page", "page.pdf"},
                 {"--page page.pdf: must be the path of an .html file"});
  expect_refused({"warp", "photo.png", "curves.svg", "--checkerboard", "no/folder/c.png"},
                 {"no/folder/c.png: cannot be written: No such file or directory"});
  expect_refused({"warp", "photo.png", "curves.svg", "-o", "out.png", "--cells", "2", "--margin",
                  "3000", "--expand"},
                 {"expand: the padded domain has ", "a side must have at most 65535"});
}

TEST_F(DriverCommand, LeavesAnOldOutputAloneWhenItRefuses) {
  scratch.write("out.png", "old");
  scratch.write("bad.svg", drawing(40, 40, ""));
  expect_refused({"warp", "photo.png", "bad.svg", "-o", "out.png"}, {"bad.svg: no curves"});
  EXPECT_EQ(read_text(scratch / "out.png"), "old");
}

TEST(DriverProgress, TimeLeftIsSaidInTheUnitThatFits) {
  EXPECT_EQ(duration_in_words(-1), "0 s");
  EXPECT_EQ(duration_in_words(59.4), "59 s");
  EXPECT_EQ(duration_in_words(125), "2:05 min");
  EXPECT_EQ(duration_in_words(3720), "1:02 h");
}

TEST_F(DriverCommand, SaysItsVersion) {
  const RunResult result = run_drumhead(scratch, {"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("drumhead 0.")) << result.out;
}

volatile std::sig_atomic_t ends = 0;
extern "C" void count_end(int) { ends = ends + 1; }

TEST(SolveInterrupt, NotesTheFirstSignalAndLeavesOthersAsTheyWere) {
  const auto before = std::signal(SIGINT, count_end);
  {
    const SolveInterrupt interrupt;
    EXPECT_FALSE(interrupt.asked());
    std::raise(SIGINT);
    EXPECT_TRUE(interrupt.asked());
    EXPECT_EQ(ends, 0);
    std::raise(SIGINT);
    EXPECT_EQ(ends, 1);
  }
  std::raise(SIGINT);
  EXPECT_EQ(ends, 2);
  EXPECT_FALSE(SolveInterrupt().asked());
  std::signal(SIGINT, before);
}

}  // namespace
}  // namespace drumhead::driver
