// SPDX-License-Identifier: MIT
// The gallery: every scene of driver/examples, run as it stands in a copy of its folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "driver_scratch.h"

namespace drumhead::driver {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class DriverExamples : public testing::Test {
 protected:
  DriverExamples() {
    // The scenes write to ../../build/demo.
    fs::create_directories(scratch / "driver/examples");
    fs::create_directories(scratch / "build/demo");
    const fs::path examples = fs::path(DRUMHEAD_TEST_DATA) / "../../driver/examples";
    for (const auto& file : fs::directory_iterator(examples)) {
      if (!file.is_regular_file()) continue;
      fs::copy(file.path(), scratch / "driver/examples");
      if (file.path().extension() == ".toml") scenes.push_back(file.path().stem());
    }
    std::ranges::sort(scenes);  // a scene that starts from another's lattice comes after it
  }

  Json report(const std::string& scene) {
    const RunResult result =
        run_drumhead(scratch, {"warp", "driver/examples/" + scene + ".toml", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << scene;
    EXPECT_EQ(result.err, "") << scene;
    return Json::parse(read_text(scratch / ("build/demo/" + scene + ".json")));
  }

  Scratch scratch;
  std::vector<std::string> scenes;
};

TEST_F(DriverExamples, AllConvergeAndMeetTheirCurves) {
  ASSERT_GE(scenes.size(), 12u);
  for (const std::string& scene : scenes) {
    const Json r = report(scene);
    EXPECT_EQ(r["status"], "converged") << scene;
    for (const Json& curve : r["curves"]) {
      // Soft is the face's brow alone; the portrait's 128 cells are the coarsest lattice.
      const bool soft = scene == "face" && curve["name"] == "brow";
      EXPECT_LT(curve["gap_rms_px"].get<double>(), soft ? 20.0 : 2.0) << scene << curve["name"];
    }
    EXPECT_TRUE(fs::exists(scratch / ("build/demo/" + scene + ".png"))) << scene;
    const int folded = r["folds"]["folded_cells"];
    // What the gallery says of folds.
    if (scene == "portrait" || scene == "roundabout" || scene == "jacket-released") {
      EXPECT_EQ(folded, 0) << scene;
    }
    if (scene == "portrait-crpm" || scene == "jacket") {
      EXPECT_GT(folded, 100) << scene;
    }
  }
}

// Its last linear solution is 0, which is no error of 0.
TEST_F(DriverExamples, ARunThatStallsDoesNotClaimThatNothingIsLeft) {
  const RunResult result =
      run_drumhead(scratch, {"warp", "driver/examples/jacket.toml", "--model", "neohookean",
                             "--curve-method", "averaged", "--cells", "96", "--quiet"});
  EXPECT_EQ(result.exit_code, 1);
  const Json r = Json::parse(read_text(scratch / "build/demo/jacket.json"));
  EXPECT_EQ(r["status"], "stalled");
  EXPECT_TRUE(r["error_px"]["algebraic_rms"].is_null()) << r["error_px"];
}

}  // namespace
}  // namespace drumhead::driver
