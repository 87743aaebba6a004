// SPDX-License-Identifier: MIT
// A clean plate under a cut-out: how the two are blended, where the run shows it, what is refused.
#include <gtest/gtest.h>

#include <filesystem>

#include "driver_scratch.h"
#include "plate.h"

namespace drumhead::driver {
namespace {

constexpr int kWidth = 40, kHeight = 30;

Image filled(int width, int height, const std::vector<float>& pixel, OIIO::TypeDesc depth) {
  Image image{OIIO::ImageSpec(width, height, int(pixel.size()), depth), {}};
  if (pixel.size() % 2 == 0) {
    image.spec.alpha_channel = int(pixel.size()) - 1;
    image.spec.attribute("oiio:UnassociatedAlpha", 1);
  }
  for (int k = 0; k < width * height; ++k)
    image.pixels.insert(image.pixels.end(), pixel.begin(), pixel.end());
  return image;
}

TEST(DriverPlate, ACutOutLiesOverItWithItsAlpha) {
  // Colours multiplied by alpha: half a red over an opaque blue, a clear pixel, an opaque one.
  const Image plate = filled(3, 1, {0.0f, 0.25f, 0.5f, 1.0f}, OIIO::TypeDesc::FLOAT);
  std::vector<float> rows{0.5f, 0, 0, 0.5f, 0, 0, 0, 0, 0.75f, 0.5f, 0.25f, 1};
  lay_over(plate, {0, 0, 3, 1}, 0, rows);
  EXPECT_EQ(rows,
            (std::vector<float>{0.5f, 0.125f, 0.25f, 1, 0, 0.25f, 0.5f, 1, 0.75f, 0.5f, 0.25f, 1}));
}

TEST(DriverPlate, EndsWithThePictureInALargerFrame) {
  Image plate = filled(2, 2, {0.0f, 1.0f}, OIIO::TypeDesc::FLOAT);
  for (std::size_t k = 0; k < 4; ++k) plate.pixels[2 * k] = 0.25f * float(k + 1);
  const Frame frame{-1, -1, 4, 4};
  std::vector<float> rows(2 * 4 * 2, 0.0f);  // the frame's middle rows, the picture's
  lay_over(plate, frame, 1, rows);
  EXPECT_EQ(rows, (std::vector<float>{0, 0, 0.25f, 1, 0.5f, 1, 0, 0, 0, 0, 0.75f, 1, 1, 1, 0, 0}));
}

class DriverPlateRun : public testing::Test {
 protected:
  DriverPlateRun() {
    // A square of 10 pixels, cut out, that moves by 10 to the right.
    Image cut_out = filled(kWidth, kHeight, {0, 0, 0, 0}, OIIO::TypeDesc::UINT8);
    for (int y = 10; y < 20; ++y)
      for (int x = 10; x < 20; ++x) {
        float* const p = &cut_out.pixels[std::size_t((y * kWidth + x) * 4)];
        p[0] = p[3] = 1.0f;
      }
    write_image(cut_out, scratch / "cut.png");
    Image plate = filled(kWidth, kHeight, {0, 0, 0}, OIIO::TypeDesc::UINT8);
    for (std::size_t k = 0; k < plate.pixels.size(); ++k)
      plate.pixels[k] = float(k * 7 % 251) / 255.0f;
    write_image(plate, scratch / "plate.png");
    const std::string square = "M9 9 h12 v12 h-12 z";
    scratch.write("curves.svg", drawing(kWidth, kHeight,
                                        "<g id='source'><path id='a' d='" + square +
                                            "'/></g>\n<g id='target' transform='translate(10)'>"
                                            "<path id='a-target' d='" +
                                            square + "'/></g>"));
  }

  void expect_refused(const std::string& plate, const std::string& picture,
                      const std::string& message) {
    const RunResult result =
        run_drumhead(scratch, {"warp", picture, "curves.svg", "--plate", plate, "-o", "out.png"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out.png"));
  }

  Scratch scratch;
};

TEST_F(DriverPlateRun, StandsStillUnderTheWarpedCutOut) {
  scratch.write("scene.toml",
                "picture = \"cut.png\"\ncurves = \"curves.svg\"\nplate = \"plate.png\"\n"
                "cells = 40\noutput = \"out.png\"\n");
  ASSERT_EQ(run_drumhead(scratch, {"warp", "scene.toml"}).exit_code, 0);
  const Image out = read_image(scratch / "out.png"), plate = read_image(scratch / "plate.png");
  ASSERT_EQ(out.channels(), 4);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto at = std::size_t(y * kWidth + x);
      const float* const p = &out.pixels[at * 4];
      EXPECT_EQ(p[3], 1.0f);
      const bool outside = x < 18 || x > 31 || y < 8 || y > 21;
      const bool inside = x > 21 && x < 28 && y > 11 && y < 18;
      for (std::size_t c = 0; outside && c < 3; ++c)
        EXPECT_EQ(p[c], plate.pixels[at * 3 + c]) << x << ' ' << y;
      if (inside) {
        EXPECT_NEAR(p[0], 1.0f, 0.01) << x << ' ' << y;
        EXPECT_NEAR(p[1], 0.0f, 0.01) << x << ' ' << y;
      }
    }
  }
}

TEST_F(DriverPlateRun, IsRefusedWhereItCannotLieUnderThePicture) {
  expect_refused("none.png", "cut.png", "none.png: cannot be read: no such file");
  expect_refused("plate.png", "plate.png", "plate.png: a plate is seen through alpha");
  write_image(filled(kWidth, 31, {0, 0, 0}, OIIO::TypeDesc::UINT8), scratch / "tall.png");
  expect_refused("tall.png", "cut.png",
                 "tall.png: 40 x 31 pixels: must be of the picture's size, 40 x 30");
  write_image(filled(kWidth, kHeight, {0}, OIIO::TypeDesc::UINT8), scratch / "grey.png");
  expect_refused("grey.png", "cut.png",
                 "grey.png: 2 channels with alpha: must be the picture's, 4");
  write_image(filled(kWidth, kHeight, {0, 0, 0}, OIIO::TypeDesc::FLOAT), scratch / "light.exr");
  expect_refused("light.exr", "cut.png", "light.exr: holds light, the picture sRGB codes");
  const RunResult replaced = run_drumhead(
      scratch, {"warp", "cut.png", "curves.svg", "--plate", "plate.png", "-o", "plate.png"});
  EXPECT_EQ(replaced.exit_code, 2);
  EXPECT_NE(replaced.err.find("plate.png: an output must not replace an input"), std::string::npos);
}

TEST_F(DriverPlateRun, IsDecodedWhereThePictureIsLight) {
  Image cut_out = filled(kWidth, kHeight, {0, 0, 0, 0}, OIIO::TypeDesc::FLOAT);
  cut_out.spec.erase_attribute("oiio:UnassociatedAlpha");
  write_image(cut_out, scratch / "cut.exr");
  write_image(filled(kWidth, kHeight, {0.5f, 1, 0}, OIIO::TypeDesc::UINT16), scratch / "half.png");
  ASSERT_EQ(run_drumhead(scratch, {"warp", "cut.exr", "curves.svg", "--plate", "half.png", "-o",
                                   "out.exr", "--cells", "20"})
                .exit_code,
            0);
  const Image out = read_image(scratch / "out.exr");
  EXPECT_NEAR(out.pixels[0], 0.2140, 1e-4);  // ((0.5 + 0.055)/1.055)^2.4
  EXPECT_EQ(out.pixels[1], 1.0f);
}

}  // namespace
}  // namespace drumhead::driver
