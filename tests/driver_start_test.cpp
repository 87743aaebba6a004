// SPDX-License-Identifier: MIT
// --start: a run that goes on from the lattice of an earlier one.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "driver_scratch.h"
#include "image.h"

namespace drumhead::driver {
namespace {

using Json = nlohmann::json;

using Words = std::vector<std::string>;

class DriverStart : public testing::Test {
 protected:
  /// `way`: flags that say how curves are met.
  explicit DriverStart(const Words& way = {"--curve-method", "averaged"}) : way_(way) {
    write_image({OIIO::ImageSpec(96, 64, 1, OIIO::TypeDesc::UINT8), std::vector<float>(96 * 64)},
                scratch / "photo.png");
    EXPECT_EQ(run(10.0, {"--lattice", "ten.exr"}).exit_code, 0);
  }

  /// A square around the centre, moved to the right by `shift`.
  RunResult run(double shift, const Words& flags) {
    const std::string square = "' d='M38 22 h20 v20 h-20 z'/></g>";
    const std::string layers = "<g id='source'><path id='a" + square +
                               "<g id='target' transform='translate(" + std::to_string(shift) +
                               ")'><path id='a-target" + square;
    scratch.write("curves.svg", drawing(96, 64, layers));
    Words words = {"warp",     "photo.png", "curves.svg", "--cells", "96",
                   "--report", "r.json",    "-o",         "out.png", "--quiet"};
    for (const Words& more : {way_, flags}) words.insert(words.end(), more.begin(), more.end());
    return run_drumhead(scratch, words);
  }
  std::size_t levels() { return Json::parse(read_text(scratch / "r.json"))["levels"].size(); }

  Scratch scratch;

 private:
  Words way_;
};

class DriverStartByAllWays : public DriverStart, public testing::WithParamInterface<Words> {
 protected:
  DriverStartByAllWays() : DriverStart(GetParam()) {}
};
INSTANTIATE_TEST_SUITE_P(
    Ways, DriverStartByAllWays,
    testing::Values(Words{"--curve-method", "averaged"}, Words{"--curve-method", "conforming"},
                    Words{"--curve-method", "conforming", "--weight", "1000"}));

TEST_P(DriverStartByAllWays, FollowsADraggedCurveOnTheFinestLatticeAlone) {
  ASSERT_GT(levels(), 1u);
  const RunResult moved =
      run(11.0, {"--start", "ten.exr", "--tolerance", "0.01", "--lattice", "moved.exr"});
  EXPECT_EQ(moved.exit_code, 0) << moved.err;
  EXPECT_EQ(moved.err, "");
  EXPECT_EQ(levels(), 1u);
  ASSERT_EQ(run(11.0, {"--tolerance", "0.01", "--lattice", "eleven.exr"}).exit_code, 0);
  const Image followed = read_image(scratch / "moved.exr"),
              fresh = read_image(scratch / "eleven.exr"), before = read_image(scratch / "ten.exr");
  ASSERT_EQ(followed.pixels.size(), fresh.pixels.size());
  double left = 0.0, dragged = 0.0;
  for (std::size_t k = 0; k < fresh.pixels.size(); ++k) {
    left += std::pow(followed.pixels[k] - fresh.pixels[k], 2);
    dragged += std::pow(before.pixels[k] - fresh.pixels[k], 2);
  }
  EXPECT_LT(std::sqrt(left), 0.1 * std::sqrt(dragged));
}

// The tolerance is then a tenth of the error that the file's header tells.
TEST_P(DriverStartByAllWays, NeedsNoTolerance) {
  EXPECT_EQ(run(10.5, {"--start", "ten.exr", "--page", "page.html"}).exit_code, 0);
  EXPECT_EQ(levels(), 1u);
  const Json error = Json::parse(read_text(scratch / "r.json"))["error_px"];
  EXPECT_GT(error["discretisation_rms"], 0.0);
  EXPECT_TRUE(error["discretisation_max"].is_null()) << "the file does not tell it";
}

TEST_F(DriverStart, RefusesWhatIsNoLatticeOfTheScene) {
  const RunResult wider = run(10.0, {"--start", "ten.exr", "--margin", "0.3"});
  EXPECT_EQ(wider.exit_code, 2);
  EXPECT_NE(wider.err.find("ten.exr: "), std::string::npos) << wider.err;
  EXPECT_NE(wider.err.find("nodes: must be those of the scene's lattice"), std::string::npos)
      << wider.err;
  ASSERT_EQ(run(10.0, {"--lattice-cells", "cells.exr"}).exit_code, 0);
  const RunResult cells = run(10.0, {"--start", "cells.exr"});
  EXPECT_EQ(cells.exit_code, 2);
  EXPECT_NE(cells.err.find("must have the channels u and v"), std::string::npos) << cells.err;
  EXPECT_EQ(run(10.0, {"--start", "none.exr"}).exit_code, 2);
}

TEST_F(DriverStart, RefusesAValueThatIsNotFinite) {
  Image lattice = read_image(scratch / "ten.exr");
  lattice.pixels[7] = std::nanf("");
  write_image(lattice, scratch / "holed.exr");
  const RunResult result = run(10.0, {"--start", "holed.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("holed.exr: a value is not finite"), std::string::npos) << result.err;
}

TEST_F(DriverStart, GoesNotWithExactCurves) {
  const RunResult exact = run(10.0, {"--start", "ten.exr", "--exact"});
  EXPECT_EQ(exact.exit_code, 2);
  EXPECT_NE(exact.err.find("start: not with exact curves"), std::string::npos) << exact.err;
}

}  // namespace
}  // namespace drumhead::driver
