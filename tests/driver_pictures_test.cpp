// SPDX-License-Identifier: MIT
// The pictures of a run, made through warps that are written down instead of solved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "canvas.h"
#include "driver_scratch.h"
#include "field_pictures.h"
#include "light.h"
#include "overlay.h"
#include "render.h"

namespace drumhead::driver {
namespace {

/// Node displacements (u, v) of a rest position, on a lattice with the default margin.
template <class Displacement>
multigrid::Solution warp_of(int width, int height, int cells, const Displacement& displacement) {
  multigrid::Solution solution;
  solution.lattice = grid::make_lattice(width, height, {.cells = cells});
  for (int j = 0; j <= solution.lattice.ny; ++j) {
    for (int i = 0; i <= solution.lattice.nx; ++i) {
      const grid::Point d = displacement(solution.lattice.rest_px(i, j));
      solution.u_px.push_back(d.x);
      solution.v_px.push_back(d.y);
    }
  }
  return solution;
}

multigrid::Solution identity(int width, int height) {
  return warp_of(width, height, 16, [](grid::Point) { return grid::Point{0, 0}; });
}

/// x → centre + factor (x − centre), y alike.
multigrid::Solution zoom(int width, int height, double factor_x, double factor_y) {
  return warp_of(width, height, 16, [&](grid::Point p) {
    return grid::Point{(factor_x - 1) * (p.x - width / 2.0), (factor_y - 1) * (p.y - height / 2.0)};
  });
}

Image render(const Image& picture, const multigrid::Solution& solution, const Frame& frame,
             kernels::Border border = kernels::Border::clamp) {
  const Renderer renderer(picture, solution, frame, border, 1);
  return {renderer.spec(), renderer.rows(0, frame.height), picture.decoded};
}

Image grey_picture(int width, int height, const OIIO::TypeDesc& depth, auto value) {
  Image image{OIIO::ImageSpec(width, height, 1, depth), {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.pixels.push_back(value(x, y));
  }
  return image;
}

/// Bytes of a canvas as its file has them.
struct Bytes {
  Image image;
  std::array<int, 3> at(int x, int y) const {
    const float* p = &image.pixels[(std::size_t(y) * std::size_t(image.width()) + std::size_t(x)) *
                                   std::size_t(image.channels())];
    const auto byte = [](float v) { return int(std::lround(255 * v)); };
    return {byte(p[0]), byte(p[1]), byte(p[2])};
  }
};
Bytes bytes_of(const Canvas& canvas) {
  const Scratch scratch;
  canvas.write_png(scratch / "canvas.png");
  return {read_image(scratch / "canvas.png")};
}

TEST(DriverLight, EveryCodeOf16BitsSurvivesDecodingAndEncoding) {
  for (int code = 0; code < 65536; ++code) {
    const double e = code / 65535.0;
    const double l = e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
    ASSERT_NEAR(decode_srgb(float(e)), l, 1e-7) << code;
    ASSERT_EQ(std::lround(encode_srgb(decode_srgb(float(e))) * 65535.0), code);
  }
  EXPECT_EQ(encode_srgb(std::nanf("")), 0.0f);
  EXPECT_EQ(encode_srgb(2.0f), 1.0f);
}

TEST(DriverLight, AStillWarpReturnsEveryDepthBitForBitInLinearLightToo) {
  for (const auto depth : {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16}) {
    for (const int channels : {1, 3, 4}) {
      const Scratch scratch;
      Image image{OIIO::ImageSpec(40, 30, channels, depth), {}};
      image.spec.attribute("oiio:UnassociatedAlpha", 1);
      const double most = depth == OIIO::TypeDesc::UINT8 ? 255 : 65535;
      for (int k = 0; k < 40 * 30 * channels; ++k) {
        const double value = std::fmod(k * 7919.0, most + 1) / most;
        // Where alpha is small, colours multiplied by it and divided again stay exact in float.
        image.pixels.push_back(float(value) *
                               (channels == 4 && k % 4 != 3
                                    ? float(std::fmod((k / 4 * 4 + 3) * 7919.0, most + 1) / most)
                                    : 1.0f));
      }
      write_image(image, scratch / "in.tif");
      const Image picture = read_image(scratch / "in.tif", {.linear_light = true});
      ASSERT_TRUE(picture.decoded);
      write_image(render(picture, identity(40, 30), {0, 0, 40, 30}), scratch / "out.tif");
      EXPECT_EQ(read_image(scratch / "out.tif").pixels, read_image(scratch / "in.tif").pixels);
    }
  }
}

TEST(DriverLight, FineLinesMergeToTheirMeanLightAndFloatPicturesAreLeftAlone) {
  const auto lines = [](int x, int) { return x % 2 ? 1.0f : 0.0f; };
  const auto centre = [&](const char* name, const OIIO::TypeDesc& depth, bool linear) {
    const Scratch scratch;
    write_image(grey_picture(64, 64, depth, lines), scratch / name);
    const Image picture = read_image(scratch / name, {.linear_light = linear});
    write_image(render(picture, zoom(64, 64, 0.25, 0.25), {0, 0, 64, 64}), scratch / "b.exr");
    write_image(render(picture, zoom(64, 64, 0.25, 0.25), {0, 0, 64, 64}), scratch / name);
    return read_image(scratch / name).pixels[32 * 64 + 32];
  };
  EXPECT_NEAR(centre("a.png", OIIO::TypeDesc::UINT16, false), 0.5, 0.01);
  EXPECT_NEAR(centre("a.png", OIIO::TypeDesc::UINT16, true), 0.735, 0.01);  // encode(1/2)
  EXPECT_NEAR(centre("a.exr", OIIO::TypeDesc::FLOAT, true), 0.5, 0.01);
}

TEST(DriverRender, BandsJoinedAreTheWholePicture) {
  const Image picture = grey_picture(70, 150, OIIO::TypeDesc::FLOAT,
                                     [](int x, int y) { return float((x * 31 + y * 17) % 64); });
  const auto solution = zoom(70, 150, 0.7, 1.3);
  const Renderer renderer(picture, solution, {0, 0, 70, 150}, kernels::Border::mirror, 2);
  std::vector<float> joined;
  for (int top = 0; top < 150; top += 64) {
    const auto band = renderer.rows(top, std::min(64, 150 - top));
    joined.insert(joined.end(), band.begin(), band.end());
  }
  EXPECT_EQ(joined, renderer.rows(0, 150));
}

TEST(DriverRender, BeyondThePictureLiesWhatTheBorderSays) {
  const Scratch scratch;
  write_image(grey_picture(20, 10, OIIO::TypeDesc::UINT8,
                           [](int x, int y) { return float(10 * y + x) / 255; }),
              scratch / "a.png");
  const auto solution = identity(20, 10);
  const Frame frame = frame_of(read_image(scratch / "a.png"), solution.lattice, true);
  ASSERT_LT(frame.left, -1);
  ASSERT_GT(frame.left + frame.width, 21);
  const auto at = [&](kernels::Border border, bool alpha, int x, int y, int channel) {
    const Image picture = read_image(scratch / "a.png", {.need_alpha = alpha});
    const Image out = render(picture, solution, frame, border);
    const int k = (y - frame.top) * frame.width + x - frame.left;
    return std::lround(255 * out.pixels[std::size_t(k * out.channels() + channel)]);
  };
  using kernels::Border;
  EXPECT_EQ(at(Border::clamp, false, -2, 4, 0), 40);
  EXPECT_EQ(at(Border::mirror, false, -2, 4, 0), 41);
  EXPECT_EQ(at(Border::mirror, false, 21, 9, 0), 108);
  EXPECT_EQ(at(Border::transparent, true, -2, 4, 1), 0);
  EXPECT_EQ(at(Border::transparent, true, 3, 4, 0), 43);
  EXPECT_EQ(at(Border::transparent, true, 3, 4, 1), 255);
}

TEST(DriverRender, AnExpandedExrKeepsThePictureAsItsDisplayWindow) {
  const Scratch scratch;
  const Image picture = grey_picture(32, 16, OIIO::TypeDesc::FLOAT, [](int x, int) { return x; });
  const auto solution = identity(32, 16);
  const Frame frame = frame_of(picture, solution.lattice, true);
  const Image warped = render(picture, solution, frame);
  write_image(warped, scratch / "a.exr");
  write_image(warped, scratch / "a.tif");
  const Image exr = read_image(scratch / "a.exr");
  EXPECT_EQ(exr.spec.x, frame.left);
  EXPECT_EQ(exr.spec.y, frame.top);
  EXPECT_EQ(exr.width(), frame.width);
  EXPECT_EQ(exr.spec.full_x, 0);
  EXPECT_EQ(exr.spec.full_width, 32);
  EXPECT_EQ(exr.spec.full_height, 16);
  EXPECT_EQ(exr.pixels, warped.pixels);
  EXPECT_EQ(read_image(scratch / "a.tif").pixels, warped.pixels);
}

TEST(DriverRender, AnExpandedDomainThatIsTooLargeIsRefused) {
  const Image picture = grey_picture(30, 30, OIIO::TypeDesc::UINT8, [](int, int) { return 0.f; });
  const auto lattice = grid::make_lattice(30, 30, {.cells = 2, .margin = 3000.0});
  EXPECT_NE(message_of([&] { frame_of(picture, lattice, true); }).find("at most 65535"),
            std::string::npos);
}

TEST(DriverCheckerboard, SquaresMoveWithTheWarpAndAreGreyOutside) {
  const int side = 240;  // squares of 10 pixels; enlarged five times
  Canvas still({0, 0, side, side}, Canvas::kFileSide), moved({0, 0, side, side}, Canvas::kFileSide);
  draw_checkerboard(identity(side, side), side, side, 1, still);
  draw_checkerboard(warp_of(side, side, 16,
                            [](grid::Point) {
                              return grid::Point{10, 0};
                            }),
                    side, side, 1, moved);
  const Bytes a = bytes_of(still), b = bytes_of(moved);
  ASSERT_EQ(a.image.width(), 5 * side);
  EXPECT_EQ(a.at(25, 25), (std::array{245, 245, 245}));
  EXPECT_EQ(a.at(75, 25), (std::array{49, 89, 42}));  // 0.15 + 0.65·15.1/240, .35, 0.15 + …
  for (int x = 60; x < 1200; x += 7) EXPECT_EQ(b.at(x, 30), a.at(x - 50, 30)) << x;
  EXPECT_EQ(b.at(25, 25), (std::array{153, 153, 153}));
}

TEST(DriverJacobian, ColoursAreThoseOfItsScale) {
  const auto centre = [](double factor_x, double factor_y) {
    Canvas canvas({0, 0, 500, 500}, Canvas::kFileSide, kLegendStrip);
    draw_jacobian(zoom(500, 500, factor_x, factor_y), {}, 1, canvas);
    return bytes_of(canvas).at(250, 250);
  };
  EXPECT_EQ(centre(1, 1), (std::array{247, 247, 247}));
  EXPECT_EQ(centre(2, 0.5), centre(1, 1));
  EXPECT_EQ(centre(1, 2), (std::array{245, 153, 97}));
  EXPECT_EQ(centre(2, 2), (std::array{148, 10, 26}));
  EXPECT_EQ(centre(3, 3), centre(2, 2));
  EXPECT_EQ(centre(0.5, 1), (std::array{92, 158, 230}));
}

TEST(DriverJacobian, ASingleFoldedCellIsRingedAtEverySize) {
  const auto rings = [](int side, bool fold) {
    auto solution = identity(side, side);
    const grid::Lattice& lattice = solution.lattice;
    const int node = lattice.ny / 2 * (lattice.nx + 1) + lattice.nx / 2;
    if (fold) solution.u_px[std::size_t(node)] = 1.5 * lattice.cell_px;
    Canvas canvas({0, 0, side, side}, Canvas::kFileSide, kLegendStrip);
    draw_jacobian(solution, {}, 1, canvas);
    const Bytes bytes = bytes_of(canvas);
    int yellow = 0;
    for (int y = 0; y < canvas.rows(); ++y) {
      for (int x = 0; x < canvas.columns(); ++x) {
        yellow += bytes.at(x, y) == std::array{255, 217, 0};
      }
    }
    return yellow / (canvas.unit() * canvas.unit());
  };
  EXPECT_EQ(rings(200, false), 0);
  // A ring covers about 110 square units. The node folds the cells on both sides of it, which share
  // a ring where they are small.
  for (const int side : {64, 600, 1800}) {
    EXPECT_GT(rings(side, true), 80) << side;
    EXPECT_LT(rings(side, true), 330) << side;
  }
}

TEST(DriverOverlay, CoversTheSameShareOfThePictureAtEverySize) {
  const auto share = [](int width, int height, int cells) {
    const auto solution = warp_of(width, height, cells, [](grid::Point) { return grid::Point{}; });
    const Image black =
        grey_picture(width, height, OIIO::TypeDesc::UINT8, [](int, int) { return 0.0f; });
    Canvas canvas({0, 0, width, height}, Canvas::kFileSide);
    canvas.add_rows(black.spec, false, black.pixels);
    draw_overlay(solution, {}, canvas);
    const Bytes bytes = bytes_of(canvas);
    double light = 0;
    for (int y = 0; y < canvas.rows(); ++y) {
      for (int x = 0; x < canvas.columns(); ++x) light += bytes.at(x, y)[0] / 153.0;
    }
    return light / canvas.columns() / canvas.rows();
  };
  for (const int side : {64, 300, 1000, 2400}) {
    EXPECT_NEAR(share(side, side * 3 / 4, 256), 0.08, 0.03) << side;
  }
  EXPECT_NEAR(share(1000, 750, 8), 0.02, 0.01);  // never more lines than the lattice has
}

TEST(DriverCanvas, ATallPictureKeepsRoomForTheLegend) {
  const Canvas canvas({0, 0, 20, 2000}, Canvas::kFileSide, kLegendStrip);
  EXPECT_EQ(canvas.columns(), 20);
  EXPECT_GE(bytes_of(canvas).image.width(), 480);
}

TEST(DriverCanvas, ALargePictureIsMadeSmallerByTheMeanOfWholeBlocks) {
  const Image picture =
      grey_picture(30, 20, OIIO::TypeDesc::UINT8, [](int x, int y) { return float((x + y) % 2); });
  Canvas canvas({0, 0, 30, 20}, 10);
  canvas.add_rows(picture.spec, false, picture.pixels);
  const Bytes bytes = bytes_of(canvas);
  ASSERT_EQ(canvas.columns(), 10);
  ASSERT_EQ(canvas.rows(), 7);
  for (int x = 0; x < 10; ++x) {
    for (int y = 0; y < 6; ++y) EXPECT_EQ(bytes.at(x, y)[0], (x + y) % 2 ? 142 : 113);
    EXPECT_EQ(bytes.at(x, 6)[0], 128);  // two rows of three
  }
}

}  // namespace
}  // namespace drumhead::driver
