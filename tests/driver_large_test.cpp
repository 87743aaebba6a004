// SPDX-License-Identifier: MIT
// A picture of 8192 × 8192 pixels of 16 bits goes through within the memory that pictures.h states.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "driver_scratch.h"
#include "image.h"

namespace drumhead::driver {
namespace {

using Json = nlohmann::json;

constexpr int kSide = 8192;
// Program and libraries, solver at 256 cells, bands on their way through threads and formats.
constexpr double kBeside = 300e6;

/// Every code once a row or more, another row every time.
std::uint16_t code(int x, int y, int c) { return std::uint16_t(x * 8 + y * 5 + c * 20000); }

class DriverLarge : public testing::Test {
 protected:
  DriverLarge() {
    OIIO::ImageSpec spec(kSide, kSide, 3, OIIO::TypeDesc::UINT16);
    spec.attribute("compression", "none");
    ImageWriter writer(spec, false, scratch / "photo.tif");
    const int step = band_rows(kSide);
    for (int top = 0; top < kSide; top += step) {
      std::vector<float> rows;
      rows.reserve(std::size_t(step) * kSide * 3);
      for (int y = top; y < top + step; ++y) {
        for (int x = 0; x < kSide; ++x) {
          for (int c = 0; c < 3; ++c) rows.push_back(float(code(x, y, c)) / 65535);
        }
      }
      writer.write(std::move(rows));
    }
    writer.close();
  }

  /// Moves a square of 2000 pixels by `shift` pixels.
  Json warp(int shift, const std::vector<std::string>& flags) {
    scratch.write("curves.svg",
                  drawing(kSide, kSide,
                          "<g id='source'><path id='a' d='M3000 3000 h2000 v2000 h-2000 z'/></g>"
                          "<g id='target' transform='translate(" +
                              std::to_string(shift) +
                              ")'><path id='a' d='M3000 3000 h2000 v2000 h-2000 z'/></g>"));
    std::vector<std::string> words{"warp", "photo.tif", "curves.svg", "--report", "r.json"};
    words.insert(words.end(), flags.begin(), flags.end());
    const RunResult result = run_drumhead(scratch, words);
    EXPECT_LE(result.exit_code, 1) << result.err;
    return Json::parse(read_text(scratch / "r.json"));
  }

  Scratch scratch;
};

TEST_F(DriverLarge, TheWarpedPictureCostsTheSourceInFloatAndLittleMore) {
  const Json report = warp(300, {"-o", "out.tif"});
  const double source = 4.0 * kSide * kSide * 3;
  EXPECT_LT(report["memory"]["peak_rss_bytes"].get<double>(), source + kBeside);
  // Under the corner nothing moved; under the square's middle the shift.
  const auto input = OIIO::ImageInput::open((scratch / "out.tif").string());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT16);
  ASSERT_EQ(input->spec().height, kSide);
  std::vector<std::uint16_t> row(std::size_t(kSide) * 3);
  ASSERT_TRUE(input->read_scanline(4000, 0, OIIO::TypeDesc::UINT16, row.data()));
  EXPECT_NEAR(row[4300 * 3], code(4000, 4000, 0), 40);  // five pixels
}

TEST_F(DriverLarge, AStrongCompressionAddsAThirdAndAPageFourBytesAPixel) {
  // Space between the square and the picture's edge is squeezed to a quarter.
  const Json report = warp(2700, {"-o", "out.tif", "--overlay", "o.png", "--page", "page.html"});
  const double source = 4.0 * kSide * kSide * 3;
  EXPECT_LT(report["memory"]["peak_rss_bytes"].get<double>(),
            source * 4 / 3 + 4.0 * kSide * kSide + kBeside);
}

}  // namespace
}  // namespace drumhead::driver
