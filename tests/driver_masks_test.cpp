// SPDX-License-Identifier: MIT
// Masks as files: depths, formats and channels that mean the same, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "driver_scratch.h"
#include "image.h"
#include "masks.h"
#include "scene.h"

namespace drumhead::driver {
namespace {

constexpr int kSide = 8;
// One cell a pixel.
const grid::Lattice kPixels{kSide, kSide, 1.0, {0.0, 0.0}, kSide};

/// Greys from 0 to 1 row after row, in steps that 8 bits hold.
float ramp(std::size_t k) { return float(4 * k) / 255.0f; }

class DriverMasks : public testing::Test {
 protected:
  /// A mask of `channels` equal channels.
  std::filesystem::path write(const std::string& name, OIIO::TypeDesc depth, int channels = 1) {
    Image image{OIIO::ImageSpec(kSide, kSide, channels, depth), {}};
    for (std::size_t k = 0; k < kSide * kSide; ++k)
      for (int c = 0; c < channels; ++c) image.pixels.push_back(ramp(k));
    write_image(image, scratch / name);
    return scratch / name;
  }

  grid::Material material(const Options& options) {
    grid::Material material{.mu = options.mu, .kappa = options.kappa};
    apply_masks(options, kSide, kSide, kPixels, material);
    return material;
  }
  std::string refusal(const Options& options) {
    return message_of([&] { material(options); });
  }

  Scratch scratch;
};

TEST_F(DriverMasks, DepthsAndFormatsMeanTheSame) {
  for (const auto& file :
       {write("a.png", OIIO::TypeDesc::UINT8), write("b.png", OIIO::TypeDesc::UINT16),
        write("c.exr", OIIO::TypeDesc::FLOAT), write("d.tif", OIIO::TypeDesc::FLOAT, 3),
        write("e.png", OIIO::TypeDesc::UINT8, 3)}) {
    Options options;
    options.mu_mask = {.file = file, .black = 1.0, .white = 11.0};
    options.kappa_mask = {.file = file, .black = 0.0, .white = 1e4};
    const grid::Material m = material(options);
    ASSERT_EQ(m.mu_cells.size(), 64u);
    for (std::size_t k = 0; k < 64; ++k) {
      EXPECT_NEAR(m.mu_cells[k], 1.0f + 10.0f * ramp(k), 1e-4) << file;
      EXPECT_NEAR(m.kappa_cells[k], 1e4f * ramp(k), 0.1) << file;
    }
  }
}

TEST_F(DriverMasks, BlackAndWhiteHaveTheirFallbacks) {
  Options options;
  options.kappa = 3.0;
  options.mu_mask.file = options.kappa_mask.file = scratch / "two.png";
  Image image{OIIO::ImageSpec(kSide, kSide, 1, OIIO::TypeDesc::UINT8), std::vector<float>(64, 0)};
  image.pixels[9] = 1.0f;
  write_image(image, scratch / "two.png");
  const grid::Material m = material(options);
  EXPECT_EQ(m.mu_cells[0], 1.0f);
  EXPECT_EQ(m.mu_cells[9], 100.0f);
  EXPECT_EQ(m.kappa_cells[0], 3.0f);
  EXPECT_EQ(m.kappa_cells[9], 1000.0f);
}

TEST_F(DriverMasks, TransparentIsBlackAndADrawingIsRasterised) {
  // Rasterised drawings have at least 1024 pixels a side.
  scratch.write("mask.svg", drawing(1024, 1024, "<rect width='512' height='1024' fill='#fff'/>"));
  Options options;
  options.kappa_mask = {.file = scratch / "mask.svg", .black = 0.5, .white = 7.0};
  grid::Material m;
  apply_masks(options, 1024, 1024, {2, 1, 512.0, {0.0, 0.0}, 1024.0}, m);
  EXPECT_EQ(m.kappa_cells, (std::vector<float>{7.0f, 0.5f}));
}

TEST_F(DriverMasks, RefusesAMaskOfAnotherSize) {
  Options options;
  options.mu_mask.file = write("mask.png", OIIO::TypeDesc::UINT8);
  grid::Material m;
  EXPECT_EQ(
      message_of([&] { apply_masks(options, 9, 8, kPixels, m); }),
      (scratch / "mask.png").string() + ": 8 x 8 pixels: must be of the picture's size, 9 x 8");
}

TEST_F(DriverMasks, RefusesPixelsWithoutAValue) {
  Image image{OIIO::ImageSpec(kSide, kSide, 1, OIIO::TypeDesc::FLOAT), std::vector<float>(64, 0)};
  Options options;
  options.kappa_mask.file = scratch / "m.exr";
  const std::string file = options.kappa_mask.file.string();
  image.pixels[10] = std::numeric_limits<float>::quiet_NaN();
  write_image(image, scratch / "m.exr");
  EXPECT_EQ(refusal(options), file + ": pixel (2, 1) = nan: must be from 0 to 1");
  image.pixels[10] = -0.25f;
  write_image(image, scratch / "m.exr");
  EXPECT_EQ(refusal(options), file + ": pixel (2, 1) = -0.25: must be from 0 to 1");
  Image red{OIIO::ImageSpec(kSide, kSide, 3, OIIO::TypeDesc::UINT8), std::vector<float>(192, 0)};
  red.pixels[3 * 11] = 1.0f;
  write_image(red, scratch / "m.png");
  options.kappa_mask.file = scratch / "m.png";
  EXPECT_EQ(refusal(options),
            (scratch / "m.png").string() + ": pixel (3, 1) is coloured: must be grey");
}

TEST_F(DriverMasks, RefusesWhatTheCoefficientCannotBe) {
  Options options;
  options.kappa_mask = {.file = write("m.png", OIIO::TypeDesc::UINT8), .black = 0.0};
  options.kappa_mask.scale = grid::MaskScale::log;
  EXPECT_NE(refusal(options).find("m.png: black = 0: must be finite and above 0 on a log"),
            std::string::npos);
  options.kappa_mask = {.file = scratch / "m.png"};
  options.kappa = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(options).find("m.png: black = inf: must be finite"), std::string::npos);
  options.kappa = 1.0;
  options.model = kernels::Model::harmonic;
  EXPECT_NE(refusal(options).find("m.png: kappa_mask: the harmonic membrane has no kappa"),
            std::string::npos);
}

TEST_F(DriverMasks, RefusesTheKeysOfAMaskThatIsNotThere) {
  Options options;
  options.kappa_mask.white = 5.0;
  EXPECT_EQ(refusal(options), "kappa_white: there is no kappa_mask");
  options.kappa_mask = {};
  options.mu_mask.scale = grid::MaskScale::log;
  EXPECT_EQ(refusal(options), "mu_scale: there is no mu_mask");
}

TEST_F(DriverMasks, SceneKeysAreTheFlags) {
  Options options;
  read_scene(scratch.write("s.toml",
                           "mu_mask = \"sub/a.png\"\nmu_black = 0.5\nmu_white = 2\n"
                           "mu_scale = \"log\"\nkappa_mask = \"b.exr\"\nkappa_black = 0\n"
                           "kappa_white = 1e4\nkappa_scale = \"linear\"\n"),
             options);
  EXPECT_EQ(options.mu_mask.file, scratch / "sub/a.png");
  EXPECT_EQ(options.mu_mask.black, 0.5);
  EXPECT_EQ(options.mu_mask.white, 2.0);
  EXPECT_EQ(options.mu_mask.scale, grid::MaskScale::log);
  EXPECT_EQ(options.kappa_mask.file, scratch / "b.exr");
  EXPECT_EQ(options.kappa_mask.black, 0.0);
  EXPECT_EQ(options.kappa_mask.white, 1e4);
  EXPECT_EQ(options.kappa_mask.scale, grid::MaskScale::linear);
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {"mu_black = 0", "mu_black = 0: must be a finite number above 0"},
           {"mu_white = inf", "mu_white = inf: must be a finite number above 0"},
           {"kappa_black = -1", "kappa_black = -1: must be a finite number, 0 or above"},
           {"kappa_white = inf", "kappa_white = inf: must be a finite number, 0 or above"},
           {"mu_scale = \"sqrt\"", "mu_scale = 'sqrt': must be one of: linear, log"},
           {"kappa_mask = \"\"", "kappa_mask = '': must be the path of a file"}}) {
    Options wrong;
    const auto file = scratch.write("w.toml", text);
    const std::string message = message_of([&] { read_scene(file, wrong); });
    EXPECT_NE(message.find("w.toml:1: " + error), std::string::npos) << error;
  }
}

class DriverMaskedWarp : public testing::Test {
 protected:
  /// A photo of 64² pixels, a square that shrinks to half its width, and a mask that is white on
  /// it.
  DriverMaskedWarp() {
    Image photo{OIIO::ImageSpec(64, 64, 1, OIIO::TypeDesc::UINT8), {}};
    Image mask = photo;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        photo.pixels.push_back(float(x) / 255.0f);
        mask.pixels.push_back(x >= 20 && x < 44 && y >= 20 && y < 44 ? 1.0f : 0.0f);
      }
    write_image(photo, scratch / "photo.png");
    write_image(mask, scratch / "mask.png");
    scratch.write(
        "curves.svg",
        drawing(64, 64,
                "<g id='source'><path id='a' d='M20 24 v16'/><path id='b' d='M44 24 v16'/>"
                "</g><g id='target'><path id='a' d='M26 24 v16'/>"
                "<path id='b' d='M38 24 v16'/></g>"));
  }

  RunResult run(std::vector<std::string> more) {
    more.insert(more.begin(), {"warp", "photo.png", "curves.svg", "--cells", "32", "--quiet"});
    return run_drumhead(scratch, more);
  }
  /// What a refused run says; it must leave no file behind.
  std::string refused(std::vector<std::string> more) {
    more.insert(more.end(), {"-o", "out.png"});
    const auto before = scratch.files();
    const RunResult result = run(more);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(scratch.files(), before);
    return result.err;
  }
  /// Area of the masked square after the warp by that before, from the lattice's displacements.
  double area(const std::vector<std::string>& more) {
    std::vector<std::string> words{"--margin", "0", "--lattice", "l.exr", "--kappa", "0.1"};
    words.insert(words.end(), more.begin(), more.end());
    const RunResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Image lattice = read_image(scratch / "l.exr");  // cells of 2 pixels
    const auto at = [&](int i, int j) {
      const float* u = &lattice.pixels[std::size_t(j * lattice.width() + i) * 2];
      return grid::Point{2.0 * i + double(u[0]), 2.0 * j + double(u[1])};
    };
    double twice = 0.0;
    for (int j = 10; j < 22; ++j)
      for (int i = 10; i < 22; ++i)
        twice += grid::cross(at(i + 1, j + 1) - at(i, j), at(i, j + 1) - at(i + 1, j));
    return 0.5 * twice / (24.0 * 24.0);
  }

  Scratch scratch;
};

TEST_F(DriverMaskedWarp, WhereKappaIsHighAreaIsKept) {
  EXPECT_LT(area({}), 0.65);
  EXPECT_NEAR(area({"--kappa-mask", "mask.png", "--kappa-white", "1e4"}), 1.0, 0.02);
}

TEST_F(DriverMaskedWarp, AStifferSquareBulgesLess) {
  EXPECT_LT(area({"--mu-mask", "mask.png", "--mu-white", "1e4"}), area({}) - 0.02);
}

TEST_F(DriverMaskedWarp, RefusesBadMasksWithExitCode2) {
  EXPECT_NE(refused({"--mu-mask", "none.png"}).find("none.png: cannot be read: no such file"),
            std::string::npos);
  EXPECT_NE(refused({"--kappa-mask", "curves.svg"}).find("curves.svg: 1024 x 1024 pixels: must be"),
            std::string::npos);
  EXPECT_NE(refused({"--mu-mask", "mask.png", "--mu-black", "0"})
                .find("--mu-black 0: must be a finite number above 0"),
            std::string::npos);
  EXPECT_NE(refused({"--kappa-mask", "mask.png", "--kappa-black=-1"})
                .find("--kappa-black -1: must be a finite number, 0 or above"),
            std::string::npos);
  EXPECT_NE(refused({"--kappa-mask", "mask.png", "--report", "mask.png"})
                .find("mask.png: an output must not replace an input"),
            std::string::npos);
}

}  // namespace
}  // namespace drumhead::driver
