// SPDX-License-Identifier: MIT
// What the resampler's pictures are worth: beside a brute force oracle of 16 × 16 samples a pixel,
// and where the truth is known beside that.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <drumhead/kernels/resample.h>

#include "support/warped_lattice.h"

namespace drumhead::tests {
namespace {

using Field = std::function<double(Position)>;

// Rings whose frequency grows linearly from 0 in the centre to `limit` cycles per pixel at
// `radius`.
Field zone_plate(Position centre, double radius, double limit) {
  return [=](Position p) {
    const double r = std::hypot(p.x - centre.x, p.y - centre.y);
    return 0.5 + 0.5 * std::cos(M_PI * limit * r * r / radius);
  };
}

Picture sampled(int width, int height, const Field& field) {
  Picture picture(width, height, 1);
  for (int b = 0; b < height; ++b) {
    for (int a = 0; a < width; ++a) picture.at(a, b) = float(field({a + 0.5, b + 0.5}));
  }
  return picture;
}

// A picture as a field: its pixels as squares. Right for the oracle where an output pixel holds
// many.
Field squares(const Picture& picture) {
  return [&picture](Position p) {
    const int a = std::clamp(int(std::floor(p.x)), 0, picture.width - 1);
    return double(picture.at(a, std::clamp(int(std::floor(p.y)), 0, picture.height - 1)));
  };
}

double supersampled(const Field& source, const std::function<Position(Position)>& inverse, int a,
                    int b) {
  double sum = 0.0;
  for (int k = 0; k < 256; ++k) {
    const int column = k % 16, row = k / 16;
    sum += source(inverse({a + (column + 0.5) / 16.0, b + (row + 0.5) / 16.0}));
  }
  return sum / 256.0;
}

// x ↦ M (x − about) + about, M given by its rows.
struct Affine {
  double xx, xy, yx, yy;
  Position about;
  Position operator()(Position p) const {
    const double dx = p.x - about.x, dy = p.y - about.y;
    return {about.x + xx * dx + xy * dy, about.y + yx * dx + yy * dy};
  }
  Affine inverse() const {
    const double det = xx * yy - xy * yx;
    return {yy / det, -xy / det, -yx / det, xx / det, about};
  }
};

Affine turned_scaled(double degrees, double scale_x, double scale_y, Position about) {
  const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
  return {scale_x * c, -scale_y * s, scale_x * s, scale_y * c, about};
}

Picture warped(const Picture& picture, const Affine& warp, Picture out,
               const kernels::ResampleOptions& options = {}) {
  const double cell = 16.0;
  const int nx = int(std::ceil(picture.width / cell)), ny = int(std::ceil(picture.height / cell));
  return rendered(picture, warped_by(nx, ny, cell, {0.0, 0.0}, warp), std::move(out), options);
}

// Peak signal to noise in dB over the pixels of `out` that `within` accepts (by their source
// position).
double psnr(const Picture& out, const Affine& warp, const std::function<double(int, int)>& truth,
            const std::function<bool(Position)>& within) {
  const Affine inverse = warp.inverse();
  double squares_sum = 0.0;
  int n = 0;
  for (int b = 0; b < out.height; ++b) {
    for (int a = 0; a < out.width; ++a) {
      const int x = a + out.left, y = b + out.top;
      if (!within(inverse({x + 0.5, y + 0.5}))) continue;
      const double error = out.at(a, b) - truth(x, y);
      squares_sum += error * error;
      ++n;
    }
  }
  return -10.0 * std::log10(squares_sum / n);
}

constexpr int kSize = 512;
const Position kCentre{256.0, 256.0};

bool inside(Position p) { return p.x > 20 && p.x < kSize - 20 && p.y > 20 && p.y < kSize - 20; }
bool in_disc(Position p) { return std::hypot(p.x - kCentre.x, p.y - kCentre.y) < 240.0; }

TEST(ResampleQuality, RotationAndMagnificationKeepASmoothPicture) {
  // Rings up to a quarter of the sampling rate, half the band limit; the truth is the formula
  // itself, at the pixel's centre. Slight compression must not fall behind where the prefilter sets
  // in.
  const Field field = zone_plate(kCentre, 256.0, 0.25);
  const Picture picture = sampled(kSize, kSize, field);
  const struct {
    double degrees, scale, decibels, box_decibels;
  } cases[] = {{30, 1.0, 40.0, 36.5},    {45, 1.0, 40.0, 36.5},     {0, 3.0, 68.0, 68.0},
               {17, 2.3, 58.0, 58.5},    {30, 1 / 1.1, 40.0, 34.5}, {30, 1 / 1.2, 38.5, 35.0},
               {30, 1 / 1.4, 32.5, 35.0}};
  for (const auto& c : cases) {
    const Affine warp = turned_scaled(c.degrees, c.scale, c.scale, kCentre);
    const Affine inverse = warp.inverse();
    const Picture out = warped(picture, warp, Picture(256, 48, 1, 256, 256));
    const auto truth = [&](int a, int b) { return field(inverse({a + 0.5, b + 0.5})); };
    const auto box = [&](int a, int b) { return supersampled(field, inverse, a, b); };
    EXPECT_GT(psnr(out, warp, truth, in_disc), c.decibels) << c.degrees << " " << c.scale;
    EXPECT_GT(psnr(out, warp, box, in_disc), c.box_decibels) << c.degrees << " " << c.scale;
  }
}

TEST(ResampleQuality, CompressionDoesNotAlias) {
  const Picture plate = sampled(kSize, kSize, zone_plate(kCentre, 256.0, 0.5));
  const struct {
    double degrees, scale, box_decibels, grey_decibels;
  } cases[] = {{0, 0.125, 31.0, 40.0}, {30, 0.125, 32.0, 39.5}, {45, 0.125, 31.5, 39.5},
               {0, 0.25, 25.5, 35.0},  {30, 0.25, 28.0, 35.5},  {45, 0.25, 28.0, 35.5}};
  for (const auto& c : cases) {
    const Affine warp = turned_scaled(c.degrees, c.scale, c.scale, kCentre);
    const Affine inverse = warp.inverse();
    const Picture out = warped(plate, warp, Picture(kSize, kSize, 1));
    const auto box = [&](int a, int b) { return supersampled(squares(plate), inverse, a, b); };
    EXPECT_GT(psnr(out, warp, box, in_disc), c.box_decibels) << c.degrees << " " << c.scale;
    // Above 1.3 times the output's band limit nothing but grey is right.
    const auto beyond = [&](Position p) {
      return in_disc(p) && std::hypot(p.x - kCentre.x, p.y - kCentre.y) > 1.3 * 256.0 * c.scale;
    };
    const auto grey = [](int, int) { return 0.5; };
    EXPECT_GT(psnr(out, warp, grey, beyond), c.grey_decibels) << c.degrees << " " << c.scale;
  }
}

TEST(ResampleQuality, CompressionInOneDirectionIsFilteredInThatDirection) {
  const Picture plate = sampled(kSize, kSize, zone_plate(kCentre, 256.0, 0.25));
  const Affine warp = turned_scaled(30.0, 1.0, 0.125, kCentre), inverse = warp.inverse();
  const Picture out = warped(plate, warp, Picture(kSize, kSize, 1));
  const auto box = [&](int a, int b) { return supersampled(squares(plate), inverse, a, b); };
  EXPECT_GT(psnr(out, warp, box, in_disc), 26.5);
}

TEST(ResampleQuality, CheckerboardsUnderEightfoldCompressionAreGrey) {
  for (int side : {1, 2, 3}) {
    const Picture board = sampled(
        kSize, kSize, [&](Position p) { return double((int(p.x) / side + int(p.y) / side) % 2); });
    const Affine warp = turned_scaled(0.0, 0.125, 0.125, kCentre);
    const Picture out = warped(board, warp, Picture(kSize, kSize, 1));
    EXPECT_GT(psnr(
                  out, warp, [](int, int) { return 0.5; }, inside),
              80.0)
        << side;
  }
}

TEST(ResampleQuality, ThePyramidCostsNextToNothing) {
  const Picture plate = sampled(kSize, kSize, zone_plate(kCentre, 256.0, 0.5));
  for (double degrees : {0.0, 30.0, 45.0}) {
    for (double scale : {0.25, 0.125, 0.06}) {
      const Affine warp = turned_scaled(degrees, scale, scale, kCentre);
      const auto at_detail = [&](double detail) {
        return warped(plate, warp, Picture(kSize, kSize, 1), {.detail = detail});
      };
      const Picture without = at_detail(16.0);
      const auto truth = [&](int a, int b) { return without.at(a, b); };
      EXPECT_GT(psnr(at_detail(2.0), warp, truth, in_disc), 53.0) << degrees << " " << scale;
      EXPECT_GT(psnr(at_detail(4.0), warp, truth, in_disc), 59.0) << degrees << " " << scale;
    }
  }
}

// White noise, which hides nothing, shrunk by a little more each time: through the onset of the
// prefilter, the narrow and the wide footprints and four levels of the pyramid.
TEST(ResampleQuality, TheFilterChangesWithoutSteps) {
  const Picture picture = noise(128, 128, 1, 5);
  double last = 0.0, worst = 0.0;
  for (double scale = 0.9; scale < 20.0; scale *= 1.001) {
    const Affine warp = turned_scaled(13.0, 1.0 / scale, 1.0 / scale, {64.0, 64.0});
    const Picture out = warped(picture, warp, Picture(1, 1, 1, 64, 64), {.threads = 1});
    if (scale > 0.9) worst = std::max(worst, std::abs(out.at(0, 0) - last));
    last = out.at(0, 0);
  }
  EXPECT_LT(worst, 4e-3);
}

}  // namespace
}  // namespace drumhead::tests
