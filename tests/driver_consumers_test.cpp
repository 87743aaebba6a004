// SPDX-License-Identifier: MIT
// Other programs sample the picture by our backward map, each in the convention that it takes, and
// must arrive at our warped picture; by a map with an axis, a half pixel or a direction wrong they
// must not. tests/install.sh tests installs them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#if DRUMHEAD_TEST_OPENCV
#include <opencv2/imgproc.hpp>
#endif

#include "driver_scratch.h"
#include "float_exr.h"
#include "image.h"

namespace drumhead::driver {
namespace {

constexpr int kWidth = 240, kHeight = 160, kEdge = 12;
// The picture's waves are 40 pixels long, of amplitude 0.2: bilinear interpolation misses them by
// at most 2 · 0.2 (2π/40)²/8 = 1.3e-3 and half a pixel by up to 0.2 (2π/40)/2 = 1.6e-2. Bounds on
// the RMS difference (measured: 3.0e-4 … 4.2e-4, and 7.9e-3 for half a pixel):
constexpr double kAgrees = 6e-4, kDiffers = 6e-3;

/// Runs in the scratch folder: photo.png through `map` into a picture; empty where the program
/// failed.
using Sample = std::function<std::vector<float>(const Scratch& scratch, const std::string& map)>;

struct Consumer {
  const char* name;
  const char* convention;
  bool (*present)();
  Sample sample;
};

void PrintTo(const Consumer& consumer, std::ostream* stream) { *stream << consumer.name; }

bool answers(const std::string& program, const std::string& flag, const std::string& name) {
  const Scratch scratch;
  const RunResult result = run_program(scratch, {program, flag});
  return result.exit_code == 0 && (result.out + result.err).find(name) != std::string::npos;
}

/// Runs one command after the other and reads result.png.
std::vector<float> result_of(const Scratch& scratch,
                             const std::vector<std::vector<std::string>>& commands) {
  for (const auto& command : commands) {
    const RunResult result = run_program(scratch, command);
    EXPECT_EQ(result.exit_code, 0) << command[0] << ": " << result.out << result.err;
    if (result.exit_code != 0) return {};
  }
  return read_image(scratch / "result.png").pixels;
}

std::vector<float> st_warp(const Scratch& scratch, const std::string& map) {
  return result_of(scratch, {{"oiiotool", "photo.png", map, "--st_warp:flip_t=1", "-d", "uint16",
                              "-o", "result.png"}});
}

// libvips reads EXR as half, which is too coarse: TIFF carries the floats.
std::vector<float> mapim(const Scratch& scratch, const std::string& map) {
  return result_of(scratch, {{"oiiotool", map, "-o", "map.tif"},
                             {"vips", "mapim", "photo.png", "result.png", "map.tif"}});
}

// ImageMagick moves by (value − ½) · 2 · 64 pixels; its 16 bits are steps of 0.002 pixels.
std::vector<float> displace(const Scratch& scratch, const std::string& map) {
  return result_of(scratch, {{"oiiotool", map, "--mulc", "0.0078125", "--addc", "0.5", "--ch",
                              "R,G,B=0", "-d", "uint16", "-o", "map.png"},
                             {"convert", "photo.png", "map.png", "-virtual-pixel", "edge",
                              "-interpolate", "bilinear", "-compose", "displace", "-define",
                              "compose:args=64x64", "-composite", "result.png"}});
}

#if DRUMHEAD_TEST_OPENCV
std::vector<float> remap(const Scratch& scratch, const std::string& map) {
  Image photo = read_image(scratch / "photo.png"), positions = read_image(scratch / map);
  std::vector<float> result(photo.pixels.size());
  const cv::Mat source(kHeight, kWidth, CV_32FC3, photo.pixels.data());
  const cv::Mat xy(kHeight, kWidth, CV_32FC2, positions.pixels.data());
  cv::Mat out(kHeight, kWidth, CV_32FC3, result.data());
  cv::remap(source, out, xy, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}
constexpr bool kOpenCv = true;
#else
std::vector<float> remap(const Scratch&, const std::string&) { return {}; }
constexpr bool kOpenCv = false;
#endif

const Consumer kConsumers[] = {
    {"OpenImageIO_st_warp", "st", [] { return answers("oiiotool", "--help", "--st_warp"); },
     st_warp},
    {"libvips_mapim", "pixel", [] { return answers("vips", "--version", "vips"); }, mapim},
    {"OpenCV_remap", "pixel", [] { return kOpenCv; }, remap},
    {"ImageMagick_displace", "displacement",
     [] { return answers("convert", "-version", "ImageMagick"); }, displace},
};

class DriverSampled : public testing::Test {
 protected:
  void SetUp() override {
    Image photo{OIIO::ImageSpec(kWidth, kHeight, 3, OIIO::TypeDesc::UINT16), {}};
    for (int b = 0; b < kHeight; ++b) {
      for (int a = 0; a < kWidth; ++a) {
        const double x = a * 2 * M_PI / 40, y = b * 2 * M_PI / 40;
        photo.pixels.push_back(float(0.25 + 0.5 * a / kWidth + 0.2 * std::sin(y + 1)));
        photo.pixels.push_back(float(0.25 + 0.5 * b / kHeight + 0.2 * std::sin(x)));
        photo.pixels.push_back(float(0.5 + 0.2 * std::sin(x) * std::cos(y)));
      }
    }
    write_image(std::move(photo), scratch / "photo.png");
  }

  /// photo.png through curves into ours.png and map.exr.
  void warp(const std::string& elements, const std::vector<std::string>& flags) {
    scratch.write("curves.svg", drawing(kWidth, kHeight, elements));
    std::vector<std::string> words = {"warp", "photo.png",      "curves.svg", "--cells",
                                      "60",   "--backward-map", "map.exr"};
    words.insert(words.end(), flags.begin(), flags.end());
    const RunResult result = run_drumhead(scratch, words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }

  Scratch scratch;
};

/// A square moves by 18 pixels and turns by 20°; the rest of the picture follows.
constexpr const char* kTurnedSquare =
    "<g id='source'><path id='a' d='M95 60 h40 v40 h-40 z'/></g>"
    "<g id='target' transform='rotate(20 115 80) translate(16 9)'>"
    "<path id='a-target' d='M95 60 h40 v40 h-40 z'/></g>";

class DriverConsumers : public DriverSampled, public testing::WithParamInterface<Consumer> {
 protected:
  void SetUp() override {
    if (!GetParam().present()) {
      GTEST_SKIP() << GetParam().name << " is not installed (sh tests/install.sh tests)";
    }
    DriverSampled::SetUp();
  }

  void warp_by(const std::string& elements) {
    warp(elements, {"-o", "ours.png", "--forward-map", "forward.exr", "--map-convention",
                    GetParam().convention});
  }

  /// RMS difference between our picture and the consumer's by `map`, without the picture's edge:
  /// where a source lies beyond it, each program has its own rule.
  double difference(const std::string& map) {
    const auto ours = read_image(scratch / "ours.png").pixels;
    const auto theirs = GetParam().sample(scratch, map);
    EXPECT_EQ(theirs.size(), ours.size());
    if (theirs.size() != ours.size()) return NAN;
    double squares = 0.0, count = 0.0;
    for (int b = kEdge; b < kHeight - kEdge; ++b) {
      for (int k = (b * kWidth + kEdge) * 3; k < ((b + 1) * kWidth - kEdge) * 3; ++k) {
        const double d = theirs[std::size_t(k)] - ours[std::size_t(k)];
        squares += d * d;
        count += 1.0;
      }
    }
    return std::sqrt(squares / count);
  }

  /// map.exr with every (R, G) changed, as changed.exr.
  std::string changed(const std::function<void(float& r, float& g)>& change) {
    Image map = read_image(scratch / "map.exr");
    for (std::size_t k = 0; k < map.pixels.size(); k += 2) {
      change(map.pixels[k], map.pixels[k + 1]);
    }
    const Frame frame{0, 0, kWidth, kHeight};
    write_float_exr({frame, frame, {"R", "G"}, {}}, scratch / "changed.exr",
                    [&](int first, int rows, float* pixels) {
                      std::copy_n(map.pixels.data() + first * kWidth * 2, rows * kWidth * 2,
                                  pixels);
                    });
    return "changed.exr";
  }
};

TEST_P(DriverConsumers, TheIdentityReturnsThePicture) {
  warp_by("<g id='pin'><circle cx='100' cy='80' r='30'/></g>");
  EXPECT_LT(difference("map.exr"), 1e-4);
}

TEST_P(DriverConsumers, AWarpReturnsOurPicture) {
  warp_by(kTurnedSquare);
  EXPECT_LT(difference("map.exr"), kAgrees);
}

TEST_P(DriverConsumers, AWrongMapDoesNot) {
  warp_by(kTurnedSquare);
  const std::string convention = GetParam().convention;
  const float half_x = convention == "st" ? 0.5f / kWidth : 0.5f;
  const float half_y = convention == "st" ? 0.5f / kHeight : 0.5f;
  // Reflects G at the middle of the picture.
  const float twice_middle = convention == "st"      ? 1.0f
                             : convention == "pixel" ? float(kHeight - 1)
                                                     : 0.0f;
  EXPECT_GT(difference(changed([](float& r, float& g) { std::swap(r, g); })), kDiffers);
  EXPECT_GT(difference(changed([&](float& r, float&) { r += half_x; })), kDiffers);
  EXPECT_GT(difference(changed([&](float&, float& g) { g += half_y; })), kDiffers);
  EXPECT_GT(difference(changed([&](float&, float& g) { g = twice_middle - g; })), kDiffers);
  EXPECT_GT(difference("forward.exr"), kDiffers);
  // What was changed is what differed.
  EXPECT_LT(difference(changed([](float&, float&) {})), kAgrees);
}

// The data window is the whole padded domain, as compositors keep it for what moves in from
// outside.
TEST_F(DriverSampled, StWarpByAnExpandedMapReturnsTheExpandedPicture) {
  if (!answers("oiiotool", "--help", "--st_warp")) {
    GTEST_SKIP() << "oiiotool is not installed (sh tests/install.sh tests)";
  }
  warp(kTurnedSquare, {"--expand", "-o", "ours.exr"});
  ASSERT_EQ(run_program(scratch,
                        {"oiiotool", "photo.png", "map.exr", "--st_warp:flip_t=1", "-o", "r.exr"})
                .exit_code,
            0);
  const Image ours = read_image(scratch / "ours.exr"), theirs = read_image(scratch / "r.exr");
  ASSERT_EQ((std::array{ours.spec.x, ours.spec.full_x, ours.spec.full_width}),
            (std::array{-24, 0, kWidth}));
  const auto value = [](const Image& image, int a, int b, int channel) {
    const int pixel = (b - image.spec.y) * image.width() + a - image.spec.x;
    return image.pixels[std::size_t(pixel * image.channels() + channel)];
  };
  double squares = 0.0;
  for (int b = kEdge; b < kHeight - kEdge; ++b) {
    for (int a = kEdge; a < kWidth - kEdge; ++a) {
      for (int channel = 0; channel < 3; ++channel) {
        squares += std::pow(value(theirs, a, b, channel) - value(ours, a, b, channel), 2);
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / ((kWidth - 2 * kEdge) * (kHeight - 2 * kEdge) * 3)), kAgrees);
}

INSTANTIATE_TEST_SUITE_P(All, DriverConsumers, testing::ValuesIn(kConsumers),
                         [](const auto& consumer) { return std::string(consumer.param.name); });

}  // namespace
}  // namespace drumhead::driver
