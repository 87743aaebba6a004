// SPDX-License-Identifier: MIT
// The executable end to end: picture and curves in, picture, overlay, lattice and report out.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "driver_scratch.h"
#include "image.h"

namespace drumhead::driver {
namespace {

using Json = nlohmann::json;

constexpr int kWidth = 96, kHeight = 64;

class DriverWarp : public testing::Test {
 protected:
  DriverWarp() {
    Image image{OIIO::ImageSpec(kWidth, kHeight, 3, OIIO::TypeDesc::UINT8), {}};
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        image.pixels.insert(image.pixels.end(),
                            {float(x) / 255, float(y) / 255, float(x * y % 256) / 255});
      }
    }
    write_image(image, scratch / "photo.png");
  }

  void draw(const std::string& elements) {
    scratch.write("curves.svg", drawing(kWidth, kHeight, elements));
  }

  /// A square of 20 pixels around the centre, moved to the right by `shift`.
  void draw_shift(double shift) {
    const std::string square = "M38 22 h20 v20 h-20 z";
    draw("<g id='source'><path id='a' d='" + square +
         "'/></g>\n<g id='target' transform='translate(" + std::to_string(shift) +
         ")'><path id='a-target' d='" + square + "'/></g>");
  }

  Scratch scratch;
};

TEST_F(DriverWarp, PinsAloneReturnThePicture) {
  draw("<g id='pin'><circle cx='48' cy='32' r='20'/></g>");
  const RunResult result = run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells",
                                                  "24", "-o", "out.png", "--report", "r.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(read_image(scratch / "out.png").pixels, read_image(scratch / "photo.png").pixels);
  const Json report = Json::parse(read_text(scratch / "r.json"));
  EXPECT_EQ(report["status"], "converged");
  EXPECT_EQ(report["folds"]["folded_cells"], 0);
}

TEST_F(DriverWarp, ACurveIsCarriedToItsTarget) {
  draw_shift(10);
  const RunResult result =
      run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells", "48", "-o", "out.png",
                             "--lattice", "l.exr", "--report", "r.json", "--overlay", "o.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(scratch.files(), (std::vector<std::string>{"curves.svg", "l.exr", "o.png", "out.png",
                                                       "photo.png", "r.json"}));
  // Red codes the column: the square's interior moves with its outline.
  const Image out = read_image(scratch / "out.png");
  ASSERT_EQ(out.width(), kWidth);
  EXPECT_NEAR(out.pixels[(32 * kWidth + 58) * 3] * 255, 48, 1.0);
  EXPECT_NEAR(out.pixels[(32 * kWidth + 58) * 3 + 1] * 255, 32, 1.0);

  const Json report = Json::parse(read_text(scratch / "r.json"));
  ASSERT_EQ(report["curves"].size(), 1u);
  EXPECT_EQ(report["curves"][0]["name"], "a");
  EXPECT_NEAR(report["curves"][0]["length_px"], 80, 1e-6);
  EXPECT_LT(report["curves"][0]["gap_rms_px"], 0.5);

  const Image lattice = read_image(scratch / "l.exr");
  EXPECT_EQ(lattice.width(), report["lattice"]["nx"].get<int>() + 1);
  EXPECT_EQ(lattice.height(), report["lattice"]["ny"].get<int>() + 1);
  EXPECT_EQ(lattice.spec.channelnames, (std::vector<std::string>{"u", "v"}));
  const double cell = report["lattice"]["cell_px"];
  const int i = int(std::lround((48 - report["lattice"]["origin_px"][0].get<double>()) / cell));
  const int j = int(std::lround((32 - report["lattice"]["origin_px"][1].get<double>()) / cell));
  const float* node = &lattice.pixels[std::size_t(j * lattice.width() + i) * 2];
  EXPECT_NEAR(node[0], 10, 0.5);
  EXPECT_NEAR(node[1], 0, 0.5);
  EXPECT_EQ(lattice.pixels[0], 0.0f);

  EXPECT_EQ(read_image(scratch / "o.png").width(), 11 * kWidth);  // small pictures are enlarged
}

TEST_F(DriverWarp, ConformingCurvesAreExactWhereBothAreAskedFor) {
  draw_shift(10);
  auto run = [&](const std::string& method) {
    const RunResult result = run_drumhead(
        scratch, {"warp", "photo.png", "curves.svg", "--cells", "48", "-o", "out.png", "--report",
                  "r.json", "--exact", "--kappa", "inf", "--curve-method", method});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Json::parse(read_text(scratch / "r.json"));
  };
  const Json conforming = run("conforming");
  EXPECT_EQ(conforming["curve_method"], "conforming");
  EXPECT_EQ(conforming["exact"], true);
  EXPECT_EQ(conforming["energy"]["volume"], 0.0);  // kappa is not capped
  EXPECT_EQ(run("auto")["curve_method"], "averaged");
}

TEST_F(DriverWarp, ASoftCurveIsMetPartlyByEitherWay) {
  draw_shift(10);
  auto run = [&](const std::string& method, const std::string& weight) {
    const RunResult result =
        run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells", "48", "-o", "out.png",
                               "--report", "r.json", "--weight", weight, "--curve-method", method});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Json report = Json::parse(read_text(scratch / "r.json"));
    EXPECT_EQ(report["curve_method"], method);
    return report;
  };
  const Json soft = run("conforming", "100"), averaged = run("averaged", "100"),
             stiff = run("conforming", "1e5");
  const double gap = soft["curves"][0]["gap_rms_px"];
  EXPECT_GT(gap, 0.2);
  EXPECT_LT(gap, 5.0);
  EXPECT_NEAR(gap, averaged["curves"][0]["gap_rms_px"].get<double>(), 0.1 * gap);
  EXPECT_GT(soft["energy"]["constraint"], 1e-4);
  EXPECT_LT(stiff["curves"][0]["gap_rms_px"], 0.05 * gap);
}

TEST_F(DriverWarp, ASceneDoesWhatItsFlagsDo) {
  draw_shift(6);
  scratch.write("scene.toml",
                "picture = \"photo.png\"\ncurves = \"curves.svg\"\ncells = 32\nkappa = 10\n"
                "output = \"scene.png\"\nthreads = 1\n");
  EXPECT_EQ(run_drumhead(scratch, {"warp", "scene.toml"}).exit_code, 0);
  EXPECT_EQ(run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells", "32", "--kappa",
                                   "10", "--threads", "2", "-o", "flags.png"})
                .exit_code,
            0);
  EXPECT_EQ(read_image(scratch / "scene.png").pixels, read_image(scratch / "flags.png").pixels);
}

TEST_F(DriverWarp, ExpandShowsTheWholePaddedDomain) {
  draw("<g id='pin'><circle cx='48' cy='32' r='20'/></g>");
  const RunResult result =
      run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells", "24", "--expand",
                             "--border", "transparent", "-o", "out.png", "--report", "r.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = Json::parse(read_text(scratch / "r.json"));
  const int left = report["frame"][0], top = report["frame"][1];
  const Image in = read_image(scratch / "photo.png"), out = read_image(scratch / "out.png");
  EXPECT_EQ(out.width(), report["frame"][2]);
  EXPECT_EQ(out.height(), report["frame"][3]);
  EXPECT_EQ(double(left), report["lattice"]["origin_px"][0]);
  ASSERT_EQ(out.channels(), 4);
  for (int y = top; y < top + out.height(); ++y) {
    for (int x = left; x < left + out.width(); ++x) {
      const float* p = &out.pixels[std::size_t((y - top) * out.width() + x - left) * 4];
      const bool inside = x >= 0 && x < kWidth && y >= 0 && y < kHeight;
      ASSERT_EQ(p[3], inside ? 1.0f : 0.0f) << x << ' ' << y;
      if (inside) {
        ASSERT_EQ(p[2], in.pixels[std::size_t(y * kWidth + x) * 3 + 2]);
      }
    }
  }
}

TEST_F(DriverWarp, ATerminalSeesEveryPhaseWithItsTimeLeft) {
  Image large{OIIO::ImageSpec(3600, 2400, 3, OIIO::TypeDesc::UINT8), {}};
  for (int k = 0; k < 3600 * 2400 * 3; ++k) {
    large.pixels.push_back(float(k * 2654435761u >> 24) / 255);
  }
  write_image(large, scratch / "photo.png");
  draw_shift(10);
  const RunResult result = run_program(
      scratch,
      {"script", "-qec", std::string(DRUMHEAD_EXECUTABLE) + " warp photo.png curves.svg -o out.png",
       "typescript"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* phase : {"reading photo.png ", "cutting 1 curves", "solving ",
                            "rendering and writing ", " s left", "converged in "}) {
    EXPECT_NE(result.out.find(phase), std::string::npos) << phase;
  }
}

std::set<std::string> names(const Json& object) {
  std::set<std::string> all;
  for (const auto& [key, value] : object.items()) all.insert(key);
  return all;
}

TEST_F(DriverWarp, TheReportHasItsKeysAndNothingThatIsNotFinite) {
  using Names = std::set<std::string>;
  draw_shift(6);
  ASSERT_EQ(run_drumhead(scratch,
                         {"warp", "photo.png", "curves.svg", "--cells", "32", "--report", "r.json"})
                .exit_code,
            0);
  const std::string text = read_text(scratch / "r.json");
  const Json r = Json::parse(text);
  EXPECT_EQ(names(r), (Names{"version",           "status",   "model",  "exact",   "solver",
                             "curve_method",      "lattice",  "levels", "frame",   "work_units",
                             "work_unit_seconds", "error_px", "curves", "folds",   "energy",
                             "seconds",           "memory",   "isa",    "threads", "notes"}));
  EXPECT_EQ(names(r["lattice"]), (Names{"nx", "ny", "cell_px", "origin_px", "levels"}));
  ASSERT_FALSE(r["levels"].empty());
  EXPECT_EQ(names(r["levels"].back()), (Names{"nx", "ny", "newton"}));
  EXPECT_EQ(
      names(r["levels"].back()["newton"].at(0)),
      (Names{"theta", "step", "krylov", "residual", "dx_rms_px", "dx_max_px", "inverted_cells"}));
  EXPECT_EQ(names(r["error_px"]),
            (Names{"algebraic_rms", "algebraic_max", "discretisation_rms", "discretisation_max"}));
  EXPECT_EQ(names(r["curves"].at(0)),
            (Names{"name", "length_px", "gap_rms_px", "gap_max_px", "worst_px"}));
  EXPECT_EQ(names(r["folds"]),
            (Names{"inverted_cells", "folded_cells", "min_J", "min_corner_J", "places_px"}));
  EXPECT_EQ(names(r["energy"]), (Names{"total", "elastic", "volume", "constraint", "volume_gap"}));
  EXPECT_EQ(names(r["seconds"]), (Names{"read", "cut", "solve", "render", "write", "total"}));
  EXPECT_EQ(names(r["memory"]), (Names{"solver_bytes", "bytes_per_node", "peak_rss_bytes"}));
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST_F(DriverWarp, MapsAndLatticeAreWrittenAndTheReportHasTheirRoundTrip) {
  draw_shift(10);
  scratch.write("scene.toml",
                "picture = \"photo.png\"\ncurves = \"curves.svg\"\ncells = 48\n"
                "backward_map = \"b.exr\"\nforward_map = \"f.exr\"\n"
                "map_convention = \"pixel\"\nlattice_cells = \"c.exr\"\n"
                "lattice_vtk = \"l.vts\"\nreport = \"r.json\"\n");
  const RunResult result = run_drumhead(scratch, {"warp", "scene.toml"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto at = [&](const Image& map, int x, int y, int c) {
    return map.pixels[std::size_t((y * kWidth + x) * 2 + c)];
  };
  const Image backward = read_image(scratch / "b.exr"), forward = read_image(scratch / "f.exr");
  EXPECT_NEAR(at(backward, 58, 32, 0), 48, 0.5);
  EXPECT_NEAR(at(backward, 58, 32, 1), 32, 0.5);
  EXPECT_NEAR(at(forward, 48, 32, 0), 58, 0.5);
  EXPECT_NEAR(at(forward, 48, 32, 1), 32, 0.5);

  const Json report = Json::parse(read_text(scratch / "r.json"));
  const Json& maps = report["maps"];
  EXPECT_EQ(maps["convention"], "pixel");
  EXPECT_EQ(maps["frame"], Json::array({0, 0, kWidth, kHeight}));
  EXPECT_LT(maps["round_trip_px"]["max"], 1e-4);
  EXPECT_GT(maps["round_trip_px"]["sampled_max"], maps["round_trip_px"]["max"]);
  EXPECT_LT(maps["round_trip_px"]["sampled_rms"], 0.1);

  // The least J of the cells is the report's, and their pressure is the membrane's: P = kappa (J −
  // 1).
  const Image cells = read_image(scratch / "c.exr");
  ASSERT_EQ(cells.width(), report["lattice"]["nx"].get<int>());
  const int J = cells.spec.channelindex("J"), P = cells.spec.channelindex("P");
  float least = 1.0f, farthest = 0.0f;
  for (std::size_t k = 0; k < cells.pixels.size(); k += 3) {
    const float j = cells.pixels[k + std::size_t(J)], p = cells.pixels[k + std::size_t(P)];
    least = std::min(least, j);
    farthest = std::max(farthest, std::abs(p - (j - 1)));
  }
  EXPECT_NEAR(least, report["folds"]["min_J"].get<double>(), 1e-6);
  EXPECT_LT(least, 0.9);
  EXPECT_LT(farthest, 0.02);
}

TEST_F(DriverWarp, FoldFreeLeavesNoFoldedCell) {
  draw_shift(24);
  const auto run = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> all{
        "warp",    "photo.png", "curves.svg", "--cells",        "48",      "--kappa", "10", "-o",
        "out.png", "--report",  "r.json",     "--curve-method", "averaged"};
    all.insert(all.end(), flags.begin(), flags.end());
    const RunResult result = run_drumhead(scratch, all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Json::parse(read_text(scratch / "r.json"));
  };
  EXPECT_GT(run({})["folds"]["folded_cells"], 0);
  const Json free = run({"--model", "fold-free", "--eps", "0.1"});
  EXPECT_EQ(free["model"], "fold-free");
  EXPECT_EQ(free["folds"]["folded_cells"], 0);
  scratch.write("scene.toml",
                "picture = \"photo.png\"\ncurves = \"curves.svg\"\ncells = 48\nkappa = 10\n"
                "model = \"fold-free\"\neps = 0.1\ncurve_method = \"averaged\"\n");
  const auto scene = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> all{"warp", "scene.toml", "-o", "s.png", "--report", "s.json"};
    all.insert(all.end(), flags.begin(), flags.end());
    const RunResult result = run_drumhead(scratch, all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Json::parse(read_text(scratch / "s.json"));
  };
  EXPECT_EQ(scene({})["folds"], free["folds"]);
  const Json automatic = scene({"--curve-method", "auto"});
  EXPECT_EQ(automatic["curve_method"], "conforming");
  EXPECT_EQ(automatic["folds"]["folded_cells"], 0);
}

TEST_F(DriverWarp, HarmonicIsTheMembraneWithoutPressure) {
  draw_shift(6);
  const auto run = [&](const std::string& flag, const std::string& value) {
    EXPECT_EQ(run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells", "32", flag,
                                     value, "-o", "out.png", "--report", "r.json"})
                  .exit_code,
              0);
    return std::pair{Json::parse(read_text(scratch / "r.json")),
                     read_image(scratch / "out.png").pixels};
  };
  const auto [harmonic, warped] = run("--model", "harmonic");
  const auto [soft, same] = run("--kappa", "0");
  EXPECT_EQ(harmonic["model"], "harmonic");
  EXPECT_EQ(soft["model"], "harmonic");
  EXPECT_EQ(harmonic["energy"], soft["energy"]);
  EXPECT_EQ(warped, same);
  const auto [elastic, bent] = run("--model", "corotated");
  EXPECT_EQ(elastic["model"], "corotated");
  EXPECT_EQ(elastic["status"], "converged");
  EXPECT_NE(bent, warped);
}

TEST_F(DriverWarp, EveryMembraneTakesConformingCells) {
  draw_shift(6);
  for (const std::string model : {"arap", "corotated", "linear", "neohookean", "stvk"}) {
    EXPECT_EQ(run_drumhead(scratch,
                           {"warp", "photo.png", "curves.svg", "--cells", "32", "--model", model,
                            "--curve-method", "conforming", "-o", "out.png", "--report", "r.json"})
                  .exit_code,
              0)
        << model;
    const Json report = Json::parse(read_text(scratch / "r.json"));
    EXPECT_EQ(report["model"], model);
    EXPECT_EQ(report["curve_method"], "conforming");
    EXPECT_EQ(report["status"], "converged") << model;
  }
}

}  // namespace
}  // namespace drumhead::driver
