// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "driver_scratch.h"
#include "image.h"
#include "svg_picture.h"

namespace drumhead::driver {
namespace {

/// Every channel of every pixel different, in steps that 8 bits hold; alpha from 0 to 1.
Image picture(int width, int height, int channels, const OIIO::TypeDesc& depth) {
  Image image{OIIO::ImageSpec(width, height, channels, depth), {}};
  for (int k = 0; k < width * height * channels; ++k) {
    image.pixels.push_back(float(k * 37 % 256) / 255);
  }
  return image;
}

void write_raw(const Image& image, const std::filesystem::path& file) {
  const auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output && output->open(file.string(), image.spec) &&
              output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data()) && output->close());
}

std::vector<float> read_raw(const std::filesystem::path& file) {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(file.string(), &hints);
  std::vector<float> pixels(std::size_t(input->spec().image_pixels()) * input->spec().nchannels);
  input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels.data());
  return pixels;
}

void expect_unchanged(const Image& stored, const std::string& name, float tolerance = 0) {
  SCOPED_TRACE(name);
  const Scratch scratch;
  write_raw(stored, scratch / ("in" + name));
  const std::vector<float> expected = read_raw(scratch / ("in" + name));
  const Image image = read_image(scratch / ("in" + name));
  write_image(image, scratch / ("out" + name));
  const Image again = read_image(scratch / ("out" + name));
  EXPECT_EQ(again.spec.format, image.spec.format);
  const std::vector<float> actual = read_raw(scratch / ("out" + name));
  ASSERT_EQ(actual.size(), expected.size());
  const int channels = stored.channels(), alpha = image.spec.alpha_channel;
  for (std::size_t k = 0; k < actual.size(); ++k) {
    // Where alpha is 0 the colour is lost.
    const bool seen = alpha < 0 || expected[k / channels * channels + alpha] > 0;
    if (!seen) continue;
    EXPECT_NEAR(actual[k], expected[k], tolerance) << k;
  }
}

TEST(DriverImage, WhatIsReadAndWrittenIsTheSamePictureOfTheSameDepth) {
  using OIIO::TypeDesc;
  for (const int channels : {1, 2, 3, 4}) {
    for (const auto depth : {TypeDesc::UINT8, TypeDesc::UINT16}) {
      Image image = picture(7, 5, channels, depth);
      if (channels == 2) image.spec.alpha_channel = 1;
      image.spec.attribute("oiio:UnassociatedAlpha", 1);
      expect_unchanged(image, ".png");
      expect_unchanged(image, ".tif");
    }
  }
  for (const auto depth : {TypeDesc::HALF, TypeDesc::FLOAT}) {
    expect_unchanged(picture(7, 5, 3, depth), ".exr");
    expect_unchanged(picture(7, 5, 4, depth), ".exr");
  }
}

TEST(DriverImage, ColoursAreMultipliedByAlphaInMemory) {
  const Scratch scratch;
  Image stored{OIIO::ImageSpec(1, 1, 4, OIIO::TypeDesc::UINT8), {1, 0.4f, 0.2f, 0.2f}};
  stored.spec.attribute("oiio:UnassociatedAlpha", 1);
  write_raw(stored, scratch / "a.png");
  const Image image = read_image(scratch / "a.png");
  EXPECT_NEAR(image.pixels[0], 0.2, 1e-6);
  EXPECT_NEAR(image.pixels[1], 0.08, 1e-6);
  EXPECT_NEAR(image.pixels[3], 0.2, 1e-6);
}

TEST(DriverImage, ExifOrientationIsApplied) {
  // Upright 3 × 2:  0 1 2 / 3 4 5, stored as EXIF describes for each orientation.
  const std::vector<std::vector<int>> stored = {
      {0, 1, 2, 3, 4, 5}, {2, 1, 0, 5, 4, 3}, {5, 4, 3, 2, 1, 0}, {3, 4, 5, 0, 1, 2},
      {0, 3, 1, 4, 2, 5}, {2, 5, 1, 4, 0, 3}, {5, 2, 4, 1, 3, 0}, {3, 0, 4, 1, 5, 2}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    SCOPED_TRACE(orientation);
    const Scratch scratch;
    const bool turned = orientation >= 5;
    Image image{OIIO::ImageSpec(turned ? 2 : 3, turned ? 3 : 2, 1, OIIO::TypeDesc::UINT8), {}};
    for (const int value : stored[std::size_t(orientation - 1)]) {
      image.pixels.push_back(float(value) / 255);
    }
    image.spec.attribute("Orientation", orientation);
    write_raw(image, scratch / "a.tif");
    const Image upright = read_image(scratch / "a.tif");
    ASSERT_EQ(upright.width(), 3);
    ASSERT_EQ(upright.height(), 2);
    for (int k = 0; k < 6; ++k) EXPECT_EQ(std::lround(upright.pixels[std::size_t(k)] * 255), k);
    EXPECT_EQ(upright.spec.get_int_attribute("Orientation"), 1);
  }
}

TEST(DriverImage, AFormatWithoutAlphaGetsThePictureOverWhite) {
  const Scratch scratch;
  Image image{OIIO::ImageSpec(8, 8, 4, OIIO::TypeDesc::UINT8), std::vector<float>(256, 0.0f)};
  write_image(image, scratch / "a.jpg");
  const Image written = read_image(scratch / "a.jpg");
  EXPECT_EQ(written.channels(), 3);
  EXPECT_NEAR(written.pixels[0], 1, 0.01);
}

TEST(DriverImage, ADeepPictureFitsIntoAShallowFormat) {
  const Scratch scratch;
  write_image(picture(16, 16, 3, OIIO::TypeDesc::UINT16), scratch / "a.jpg");
  EXPECT_EQ(read_image(scratch / "a.jpg").spec.format, OIIO::TypeDesc::UINT8);
}

TEST(DriverImage, ValuesThatAreNotFiniteAreReplaced) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Image image{OIIO::ImageSpec(2, 2, 1, OIIO::TypeDesc::FLOAT), {NAN, kInfinity, -kInfinity, 7e20f}};
  EXPECT_EQ(make_finite(image), 3U);
  EXPECT_EQ(image.pixels, (std::vector<float>{0.0f, 65504.0f, -65504.0f, 7e20f}));
}

TEST(DriverImage, UnreadablePicturesAreNamed) {
  const Scratch scratch;
  scratch.write("text.png", "this is no picture");
  EXPECT_NE(message_of([&] {
              read_image(scratch / "none.png");
            }).find("none.png: cannot be read: no such file"),
            std::string::npos);
  EXPECT_NE(
      message_of([&] { read_image(scratch / "text.png"); }).find("text.png: cannot be read: "),
      std::string::npos);
  EXPECT_NE(message_of([&] { read_image(scratch.folder()); }).find("not a regular file"),
            std::string::npos);
  EXPECT_NE(
      message_of([&] { check_writable_format("a.nothing"); }).find("a.nothing: no picture format"),
      std::string::npos);
}

TEST(DriverImage, ADrawingIsRasterisedWithItsCurvesHidden) {
  const Scratch scratch;
  const auto file = scratch.write("a.svg", R"(
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
     width="2000" height="100" viewBox="0 0 20 10">
  <rect width="20" height="10" fill="#00ff00"/>
  <g id="source"><rect id="half" width="10" height="10" fill="#ff0000"/></g>
  <rect id="b-target" width="20" height="10" fill="#0000ff"/>
  <use xlink:href="#half" x="10"/>
</svg>)");
  const Image image = rasterise(file);
  EXPECT_EQ(image.width(), 2000);
  EXPECT_EQ(image.height(), 1000);  // the viewBox is stretched, the height is not believed
  const auto pixel = [&](int x, int y) {
    return &image.pixels[(std::size_t(y) * 2000 + std::size_t(x)) * std::size_t(image.channels())];
  };
  EXPECT_EQ(pixel(500, 500)[0], 0);
  EXPECT_EQ(pixel(500, 500)[1], 1);
  EXPECT_EQ(pixel(1500, 500)[0], 1);  // art may use a shape of a hidden layer
  EXPECT_EQ(scratch.files(), std::vector<std::string>{"a.svg"});
}

TEST(DriverImage, ASmallDrawingIsEnlarged) {
  const Scratch scratch;
  const Image image =
      rasterise(scratch.write("a.svg", drawing(30, 10, "<rect width='5' height='5'/>")));
  EXPECT_EQ(image.width(), 1024);
  EXPECT_EQ(image.height(), 341);
}

}  // namespace
}  // namespace drumhead::driver
