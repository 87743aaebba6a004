// SPDX-License-Identifier: MIT
// The maps as files: each convention by its formula, header, padded frame, folds, round trip.
#include "maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "driver_scratch.h"
#include "image.h"
#include "support/warped_lattice.h"

namespace drumhead::driver {
namespace {

using kernels::Position;
using tests::WarpedLattice;

constexpr int kWidth = 60, kHeight = 40;
constexpr Frame kPicture{0, 0, kWidth, kHeight}, kPadded{-8, -8, kWidth + 16, kHeight + 16};

/// Smooth, without folds, held at the edge of 76 × 56 pixels.
WarpedLattice wave() {
  return tests::warped_by(38, 28, 2.0, {-8, -8}, [](Position p) {
    const double x = (p.x + 8) / 76, y = (p.y + 8) / 56, pi = std::acos(-1.0);
    const double bump = std::sin(pi * x) * std::sin(pi * y);
    return Position{p.x + 6 * bump * bump, p.y - 4 * bump * std::sin(2 * pi * x)};
  });
}

WarpedLattice identity() {
  return tests::warped_by(38, 28, 2.0, {-8, -8}, [](Position p) { return p; });
}

WarpedLattice folded() { return tests::random_lattice(19, 14, 4.0, {-8, -8}, 0.9, 7); }

struct Map {
  Image file;
  Frame frame;
  /// Channel c at pixel (a, b) of the picture's frame.
  double at(int a, int b, int c) const {
    return file.pixels[std::size_t(((b - frame.top) * frame.width + a - frame.left) * 2 + c)];
  }
};

class DriverMaps : public testing::Test {
 protected:
  using Write = void (*)(const kernels::LatticeMapView&, const MapFormat&, int,
                         const std::filesystem::path&, const MapProgress&);
  Map written(Write write, const WarpedLattice& lattice, MapConvention convention,
              const Frame& frame = kPicture) {
    write(lattice.view(), {convention, kWidth, kHeight, frame}, 2, scratch / "map.exr", {});
    return {read_image(scratch / "map.exr"), frame};
  }

  Scratch scratch;
};

TEST_F(DriverMaps, StOfTheIdentityIsThePixelCentreOverTheSizeAndUp) {
  for (const DriverMaps::Write write : {write_backward_map, write_forward_map}) {
    const Map map = written(write, identity(), MapConvention::st);
    EXPECT_EQ(map.at(0, 0, 0), double(float(0.5 / 60)));
    EXPECT_EQ(map.at(0, 0, 1), double(float(39.5 / 40)));
    EXPECT_EQ(map.at(59, 39, 0), double(float(59.5 / 60)));
    EXPECT_NEAR(map.at(59, 39, 1), 0.5 / 40, 1e-7);
  }
}

TEST_F(DriverMaps, PixelOfTheIdentityIsThePixelsOwnNumber) {
  for (const DriverMaps::Write write : {write_backward_map, write_forward_map}) {
    const Map map = written(write, identity(), MapConvention::pixel);
    EXPECT_EQ(map.at(0, 0, 0), 0.0);
    EXPECT_EQ(map.at(17, 31, 0), 17.0);
    EXPECT_EQ(map.at(17, 31, 1), 31.0);
  }
}

TEST_F(DriverMaps, DisplacementOfTheIdentityIsZero) {
  for (const DriverMaps::Write write : {write_backward_map, write_forward_map}) {
    const Map map = written(write, identity(), MapConvention::displacement, kPadded);
    for (const float value : map.file.pixels) ASSERT_EQ(value, 0.0f);
  }
}

TEST_F(DriverMaps, EachConventionSaysTheSamePositions) {
  const WarpedLattice lattice = wave();
  const tests::BackwardMap source = tests::backward(lattice, kWidth, kHeight);
  for (const bool backward : {true, false}) {
    const DriverMaps::Write write = backward ? write_backward_map : write_forward_map;
    const Map st = written(write, lattice, MapConvention::st);
    const Map pixel = written(write, lattice, MapConvention::pixel);
    const Map displacement = written(write, lattice, MapConvention::displacement);
    double farthest = 0.0;
    for (int b = 0; b < kHeight; ++b) {
      for (int a = 0; a < kWidth; ++a) {
        const Position to = backward ? source.source[source.index(a, b)]
                                     : kernels::forward_position(lattice.view(), {a + .5, b + .5});
        ASSERT_NEAR(st.at(a, b, 0) * kWidth, to.x, 1e-5);
        ASSERT_NEAR((1 - st.at(a, b, 1)) * kHeight, to.y, 1e-5);
        ASSERT_NEAR(pixel.at(a, b, 0) + 0.5, to.x, 1e-5);
        ASSERT_NEAR(pixel.at(a, b, 1) + 0.5, to.y, 1e-5);
        ASSERT_NEAR(displacement.at(a, b, 0) + a + 0.5, to.x, 1e-5);
        ASSERT_NEAR(displacement.at(a, b, 1) + b + 0.5, to.y, 1e-5);
        farthest = std::max(farthest, std::abs(to.x - a - 0.5));
      }
    }
    EXPECT_GT(farthest, 4.0);  // the warp was there
  }
}

TEST_F(DriverMaps, ThePaddedFrameIsTheDataWindowAndThePictureTheDisplayWindow) {
  const Map all = written(write_backward_map, wave(), MapConvention::st, kPadded);
  const OIIO::ImageSpec& spec = all.file.spec;
  EXPECT_EQ((std::array{spec.x, spec.y, spec.width, spec.height}), (std::array{-8, -8, 76, 56}));
  EXPECT_EQ((std::array{spec.full_x, spec.full_y, spec.full_width, spec.full_height}),
            (std::array{0, 0, kWidth, kHeight}));
  // The picture's part is the same map.
  const Map inner = written(write_backward_map, wave(), MapConvention::st);
  for (int b = 0; b < kHeight; ++b) {
    for (int a = 0; a < kWidth; ++a) {
      ASSERT_EQ(all.at(a, b, 0), inner.at(a, b, 0));
      ASSERT_EQ(all.at(a, b, 1), inner.at(a, b, 1));
    }
  }
  EXPECT_NEAR(all.at(-8, -8, 0), -7.5 / kWidth, 5e-5);  // the edge is held
  EXPECT_NEAR(all.at(-8, -8, 1), 1 + 7.5 / kHeight, 5e-5);
}

TEST_F(DriverMaps, TheHeaderSaysWhatTheNumbersAre) {
  const OIIO::ImageSpec st = written(write_backward_map, wave(), MapConvention::st).file.spec;
  EXPECT_EQ(st.format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(st.channelnames, (std::vector<std::string>{"R", "G"}));
  EXPECT_EQ(st.get_string_attribute("drumhead:map"), "backward");
  EXPECT_EQ(st.get_string_attribute("drumhead:convention"), "st");
  const std::string text(st.get_string_attribute("ImageDescription"));
  EXPECT_NE(text.find("R = x / W, G = 1 - y / H"), std::string::npos) << text;
  EXPECT_NE(text.find("source position"), std::string::npos) << text;
  const OIIO::ImageSpec pixel = written(write_forward_map, wave(), MapConvention::pixel).file.spec;
  EXPECT_EQ(pixel.get_string_attribute("drumhead:map"), "forward");
  EXPECT_EQ(pixel.get_string_attribute("drumhead:convention"), "pixel");
}

TEST_F(DriverMaps, AFoldedLatticeGivesFiniteNumbersThatAPointOfItHas) {
  const WarpedLattice lattice = folded();
  const Map map = written(write_backward_map, lattice, MapConvention::pixel, kPadded);
  for (const float value : map.file.pixels) ASSERT_TRUE(std::isfinite(value));
  for (int b = kPadded.top; b < kPadded.top + kPadded.height; ++b) {
    for (int a = kPadded.left; a < kPadded.left + kPadded.width; ++a) {
      const Position to =
          kernels::forward_position(lattice.view(), {map.at(a, b, 0) + 0.5, map.at(a, b, 1) + 0.5});
      ASSERT_NEAR(to.x, a + 0.5, 5e-3) << a << ", " << b;
      ASSERT_NEAR(to.y, b + 0.5, 5e-3) << a << ", " << b;
    }
  }
}

TEST_F(DriverMaps, TheRoundTripIsRoundingForTheWarpAndInterpolationForTheFiles) {
  for (const auto convention :
       {MapConvention::st, MapConvention::pixel, MapConvention::displacement}) {
    const RoundTrip smooth = round_trip(wave().view(), {convention, kWidth, kHeight, kPadded}, 2);
    EXPECT_GT(smooth.max_px, 0.0);
    EXPECT_LT(smooth.max_px, 2e-5);  // float32 at 76 px: 4e-6, stretched at most fourfold
    EXPECT_LT(smooth.rms_px, smooth.max_px);
    // The lattice's kinks: the gradient jumps by h |u''| = 2 · 6 · 2 (π/56)² = 0.08 at most, times
    // a quarter of a pixel; twice that for the two components.
    EXPECT_GT(smooth.sampled_max_px, 1e-3);
    EXPECT_LT(smooth.sampled_max_px, 0.04);
    EXPECT_LT(smooth.sampled_rms_px, 0.4 * smooth.sampled_max_px);
  }
}

TEST_F(DriverMaps, ProgressEndsAtOneAndNeverFalls) {
  double last = 0.0;
  int calls = 0;
  const MapProgress progress = [&](double done) {
    EXPECT_GT(done, last);
    last = done;
    ++calls;
  };
  const MapFormat tall{MapConvention::st, 2048, 3000, {0, 0, 2048, 3000}};
  write_backward_map(identity().view(), tall, 2, scratch / "map.exr", progress);
  EXPECT_EQ(last, 1.0);
  EXPECT_GT(calls, 1);
}

TEST_F(DriverMaps, FoldsDoNotEnterTheRoundTrip) {
  const WarpedLattice lattice = folded();
  const RoundTrip result =
      round_trip(lattice.view(), {MapConvention::st, kWidth, kHeight, kPadded}, 1);
  EXPECT_LT(result.max_px, 1e-4);
  // Four pixels that are upright may still lie on both sides of a kink, of at most a few cells.
  EXPECT_LT(result.sampled_max_px, 2.0);
}

}  // namespace
}  // namespace drumhead::driver
