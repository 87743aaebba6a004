// SPDX-License-Identifier: MIT
// The resampler: exactness, the fold rule, borders, threads and hostile lattices. How good its
// pictures are is kernels_resample_quality_test.cpp.
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/kernels/resample.h>

#include "support/refusal.h"
#include "support/warped_lattice.h"

namespace drumhead::tests {
namespace {

using kernels::Border;

WarpedLattice at_rest(int nx, int ny, double cell_px, Position origin) {
  return warped_by(nx, ny, cell_px, origin, [](Position rest) { return rest; });
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(Resample, IdentityReturnsTheInputBitForBit) {
  for (int channels = 1; channels <= 6; ++channels) {
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{
             {1, 1}, {1, 9}, {9, 1}, {2, 3}, {64, 64}, {65, 63}, {150, 71}}) {
      Picture picture = noise(width, height, channels, 7);
      picture.data[0] = -0.0f;
      picture.data.back() = std::numeric_limits<float>::infinity();
      // No number here is a dyadic fraction, and the margin differs from side to side.
      const WarpedLattice lattice = at_rest(23, 17, 9.7, {-7.3, -11.9});
      const Picture out = rendered(picture, lattice, Picture(width, height, channels));
      EXPECT_TRUE(same_bits(out.data, picture.data)) << width << "x" << height << "x" << channels;
    }
  }
}

TEST(Resample, IdentityOverThePaddedDomainContinuesTheEdgePixels) {
  const Picture picture = noise(13, 8, 3, 1);
  const Picture out =
      rendered(picture, at_rest(5, 4, 4.1, {-3.3, -2.2}), Picture(33, 20, 3, -9, -5));
  for (int b = 0; b < out.height; ++b) {
    for (int a = 0; a < out.width; ++a) {
      const int x = std::clamp(a - 9, 0, 12), y = std::clamp(b - 5, 0, 7);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(out.at(a, b, c), picture.at(x, y, c));
    }
  }
}

TEST(Resample, TranslationByWholePixelsIsExact) {
  const Picture picture = noise(90, 70, 4, 3);
  const WarpedLattice lattice = warped_by(12, 9, 10.3, {-8.2, -4.7}, [](Position p) {
    return Position{p.x + 3.0, p.y - 2.0};
  });
  const Picture out = rendered(picture, lattice, Picture(90, 70, 4));
  for (int b = 0; b < 68; ++b) {
    for (int a = 3; a < 90; ++a) {
      for (int c = 0; c < 4; ++c) ASSERT_EQ(out.at(a, b, c), picture.at(a - 3, b + 2, c));
    }
  }
}

TEST(Resample, AConstantPictureStaysConstantUnderAnyWarp) {
  for (int channels : {1, 2, 3, 4, 5}) {
    for (const auto& [width, height] :
         std::vector<std::pair<int, int>>{{1, 1}, {1, 60}, {75, 1}, {2, 2}, {80, 60}}) {
      Picture picture(width, height, channels);
      for (float& x : picture.data) x = 0.7f;
      for (double cells : {0.4, 3.0}) {
        for (Border border : {Border::clamp, Border::mirror}) {
          const Picture out = rendered(picture, random_lattice(9, 8, 10.0, {-5.0, -5.0}, cells, 5),
                                       Picture(90, 80, channels, -5, -5), {.border = border});
          for (float x : out.data) ASSERT_NEAR(x, 0.7f, 3e-6f);
        }
      }
    }
  }
}

TEST(Resample, BandsAndThreadsMakeNoDifferenceToAnyBit) {
  const Picture picture = noise(200, 170, 3, 11);
  const WarpedLattice lattice = random_lattice(20, 17, 10.0, {0.0, 0.0}, 1.5, 8);
  const Picture whole = rendered(picture, lattice, Picture(220, 190, 3, -10, -10), {.threads = 1});
  for (int threads : {2, 3, 7}) {
    const Picture again =
        rendered(picture, lattice, Picture(220, 190, 3, -10, -10), {.threads = threads});
    EXPECT_TRUE(same_bits(again.data, whole.data)) << threads;
  }
  const kernels::Resampler resampler(picture.view(), lattice.view());
  for (int top = 0; top < 190; top += 37) {
    Picture band(220, std::min(37, 190 - top), 3, -10, top - 10);
    resampler.render(band.target());
    const float* row = whole.data.data() + std::ptrdiff_t(top) * 220 * 3;
    EXPECT_EQ(0, std::memcmp(band.data.data(), row, band.data.size() * sizeof(float))) << top;
  }
}

TEST(Resample, BordersAreWhatTheirNamesSay) {
  const Picture picture = noise(5, 1, 1, 2);
  const WarpedLattice lattice = at_rest(4, 4, 10.0, {-20.0, -20.0});
  const auto row = [&](Border border) {
    return rendered(picture, lattice, Picture(25, 1, 1, -10, 0), {.border = border});
  };
  const Picture clamp = row(Border::clamp), mirror = row(Border::mirror);
  const Picture transparent = row(Border::transparent);
  for (int x = -10; x < 15; ++x) {
    const bool inside = x >= 0 && x < 5;
    const int folded = ((x % 10) + 10) % 10;
    EXPECT_EQ(clamp.at(x + 10, 0), picture.at(std::clamp(x, 0, 4), 0));
    EXPECT_EQ(mirror.at(x + 10, 0), picture.at(folded < 5 ? folded : 9 - folded, 0));
    EXPECT_EQ(transparent.at(x + 10, 0), inside ? picture.at(x, 0) : 0.0f);
  }
}

// Nearly every pixel of a strongly folded lattice lies under several cells.
TEST(BackwardMap, HasNoGapsAndLeadsBackToThePixel) {
  for (double cells : {0.0, 0.3, 1.0, 4.0}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const WarpedLattice lattice = random_lattice(13, 11, 12.7, {3.1, -2.4}, cells, seed);
      const BackwardMap map = backward(lattice, 190, 150, -5, -8);
      for (int b = 0; b < map.height; ++b) {
        for (int a = 0; a < map.width; ++a) {
          const double x = a - 5 + 0.5, y = b - 8 + 0.5;
          const Position source = map.source[map.index(a, b)];
          const Position back = kernels::forward_position(lattice.view(), source);
          const bool inside =
              x >= 3.1 && x <= 3.1 + 13 * 12.7 && y >= -2.4 && y <= -2.4 + 11 * 12.7;
          if (inside) {
            ASSERT_NE(map.side[map.index(a, b)], 0) << x << " " << y;
          }
          ASSERT_LT(std::hypot(back.x - x, back.y - y), 1e-9) << x << " " << y << " " << cells;
        }
      }
    }
  }
}

TEST(BackwardMap, FindsPixelsOnEdgesAndNodes) {
  // Every lattice line runs through pixel centres, before and after the warp.
  const WarpedLattice lattice = warped_by(8, 6, 4.0, {0.5, 0.5}, [](Position p) {
    return Position{p.x + (p.y > 10.0 ? 2.0 : 0.0), p.y};
  });
  const BackwardMap map = backward(lattice, 33, 25);
  for (int b = 0; b < 25; ++b) {
    for (int a = 2; a < 33; ++a) {
      const Position back = kernels::forward_position(lattice.view(), map.source[map.index(a, b)]);
      EXPECT_NE(map.side[map.index(a, b)], 0);
      EXPECT_NEAR(back.x, a + 0.5, 1e-12);
      EXPECT_NEAR(back.y, b + 0.5, 1e-12);
    }
  }
}

TEST(BackwardMap, OutsideIsTheIdentity) {
  const BackwardMap map =
      backward(random_lattice(4, 4, 10.0, {0.0, 0.0}, 0.3, 1), 60, 60, -10, -10);
  for (int b = 0; b < 60; ++b) {
    for (int a = 0; a < 60; ++a) {
      if (a >= 10 && a < 50 && b >= 10 && b < 50) continue;
      const Position source = map.source[map.index(a, b)];
      EXPECT_EQ(source.x, a - 10 + 0.5);
      EXPECT_EQ(source.y, b - 10 + 0.5);
      EXPECT_EQ(map.side[map.index(a, b)], 0);
    }
  }
}

TEST(BackwardMap, TheJacobianIsTheDerivativeOfTheSource) {
  const WarpedLattice lattice = warped_by(1, 1, 100.0, {0.0, 0.0}, [](Position p) {
    return Position{1.3 * p.x + 0.4 * p.y - 0.002 * p.x * p.y, 0.7 * p.y - 0.2 * p.x};
  });
  const WarpedLattice finer = warped_by(1, 1, 100.0 * 64, {0.0, 0.0}, [](Position p) {
    const double x = p.x / 64, y = p.y / 64;
    return Position{64 * (1.3 * x + 0.4 * y - 0.002 * x * y), 64 * (0.7 * y - 0.2 * x)};
  });
  const BackwardMap map = backward(lattice, 40, 20, 50, 20);
  const BackwardMap fine = backward(finer, 64 * 40, 64, 64 * 50, 64 * 30);
  for (int a = 1; a < 39; ++a) {
    const std::size_t k = map.index(a, 10), left = fine.index(64 * a + 31, 31);
    const Position p = fine.source[left], right = fine.source[left + 1];
    const Position below = fine.source[left + std::size_t(fine.width)];
    EXPECT_EQ(map.side[k], 1);
    EXPECT_NEAR(map.jacobian[4 * k], right.x - p.x, 1e-3);
    EXPECT_NEAR(map.jacobian[4 * k + 1], below.x - p.x, 1e-3);
    EXPECT_NEAR(map.jacobian[4 * k + 2], right.y - p.y, 1e-3);
    EXPECT_NEAR(map.jacobian[4 * k + 3], below.y - p.y, 1e-3);
  }
}

TEST(FoldRule, OfThreeSheetsTheLaterPositiveOneWins) {
  // Columns 0, 10, 20, 30 go to 0, 22, 8, 30: at x = 15.5 lie cells 0 and 2, and cell 1 turned
  // over.
  const double to[] = {0.0, 22.0, 8.0, 30.0};
  for (bool rows : {false, true}) {
    const WarpedLattice lattice =
        warped_by(rows ? 1 : 3, rows ? 3 : 1, 10.0, {0.0, 0.0}, [&](Position p) {
          return rows ? Position{p.x, to[int(p.y / 10)]} : Position{to[int(p.x / 10)], p.y};
        });
    const BackwardMap map = backward(lattice, rows ? 10 : 30, rows ? 30 : 10);
    const std::size_t k = rows ? map.index(5, 15) : map.index(15, 5);
    EXPECT_NEAR(rows ? map.source[k].y : map.source[k].x, 20.0 + 10.0 * (15.5 - 8.0) / 22.0, 1e-12);
    EXPECT_EQ(map.side[k], 1);
    // Before the later sheet begins only the first is positive.
    const std::size_t first = rows ? map.index(5, 6) : map.index(6, 5);
    EXPECT_NEAR(rows ? map.source[first].y : map.source[first].x, 10.0 * 6.5 / 22.0, 1e-12);
  }
}

TEST(FoldRule, APointUnderNegativeCellsOnlyIsMarked) {
  const WarpedLattice mirrored = warped_by(2, 1, 10.0, {0.0, 0.0}, [](Position p) {
    return Position{20.0 - p.x, p.y};
  });
  const BackwardMap map = backward(mirrored, 20, 10);
  for (std::size_t k = 0; k < map.source.size(); ++k) {
    EXPECT_EQ(map.side[k], -1);
    EXPECT_NEAR(map.source[k].x, 19.5 - double(k % 20), 1e-12);
  }
}

// All preimages of x in cell (i, j) by Newton's method from a grid of starts: no formula of the
// library.
void add_preimages(const WarpedLattice& lattice, int i, int j, Position x,
                   std::vector<std::pair<Position, double>>& found) {
  const auto node = [&](int di, int dj) {
    const std::size_t n = std::size_t(j + dj) * std::size_t(lattice.nx + 1) + std::size_t(i + di);
    return Position{lattice.origin_px.x + lattice.cell_px * (i + di) + lattice.u[n],
                    lattice.origin_px.y + lattice.cell_px * (j + dj) + lattice.v[n]};
  };
  const Position p = node(0, 0), q = node(1, 0), r = node(0, 1), w = node(1, 1);
  for (int start = 0; start < 25; ++start) {
    const int column = start % 5, row = start / 5;
    double s = 0.25 * column, t = 0.25 * row, J = 0.0, miss = 1.0;
    for (int step = 0; step < 30; ++step) {
      const double fx =
          (1 - s) * (1 - t) * p.x + s * (1 - t) * q.x + (1 - s) * t * r.x + s * t * w.x;
      const double fy =
          (1 - s) * (1 - t) * p.y + s * (1 - t) * q.y + (1 - s) * t * r.y + s * t * w.y;
      const double xs = (1 - t) * (q.x - p.x) + t * (w.x - r.x),
                   xt = (1 - s) * (r.x - p.x) + s * (w.x - q.x);
      const double ys = (1 - t) * (q.y - p.y) + t * (w.y - r.y),
                   yt = (1 - s) * (r.y - p.y) + s * (w.y - q.y);
      J = xs * yt - xt * ys;
      miss = std::hypot(x.x - fx, x.y - fy);
      s += (yt * (x.x - fx) - xt * (x.y - fy)) / J;
      t += (xs * (x.y - fy) - ys * (x.x - fx)) / J;
    }
    if (!(miss < 1e-9) || s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
    found.push_back({{lattice.origin_px.x + lattice.cell_px * (i + s),
                      lattice.origin_px.y + lattice.cell_px * (j + t)},
                     J / (lattice.cell_px * lattice.cell_px)});
  }
}

TEST(FoldRule, HoldsForEveryPixelOfARandomLattice) {
  const WarpedLattice lattice = random_lattice(6, 5, 9.3, {-1.7, 2.2}, 1.2, 21);
  const BackwardMap map = backward(lattice, 54, 46, -1, 3);
  int compared = 0, overlapping = 0;
  for (int b = 0; b < map.height; ++b) {
    for (int a = 0; a < map.width; ++a) {
      const Position x{a - 1 + 0.5, b + 3 + 0.5};
      std::vector<std::pair<Position, double>> found;
      bool delicate = false, later = false;
      Position winner;
      for (int j = 0; j < lattice.ny; ++j) {
        for (int i = 0; i < lattice.nx; ++i) {
          found.clear();
          add_preimages(lattice, i, j, x, found);
          for (const auto& [source, J] : found) {
            delicate = delicate || std::abs(J) < 1e-3;
            if (J <= 0.0) continue;
            overlapping += later;
            winner = source;
            later = true;
          }
        }
      }
      if (delicate || !later) continue;
      ++compared;
      const Position source = map.source[map.index(a, b)];
      ASSERT_NEAR(source.x, winner.x, 1e-8) << x.x << " " << x.y;
      ASSERT_NEAR(source.y, winner.y, 1e-8);
      ASSERT_EQ(map.side[map.index(a, b)], 1);
    }
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GT(overlapping, 500);
}

TEST(Resample, HostileLatticesGiveFinitePictures) {
  const Picture picture = noise(70, 50, 4, 9);
  std::vector<WarpedLattice> lattices;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    lattices.push_back(random_lattice(14, 10, 5.0, {0.0, 0.0}, 0.9, seed));
    lattices.push_back(random_lattice(14, 10, 5.0, {0.0, 0.0}, 300.0, seed));
    lattices.push_back(random_lattice(140, 100, 0.5, {0.0, 0.0}, 8.0, seed));
  }
  lattices.push_back(warped_by(14, 10, 5.0, {0.0, 0.0}, [](Position) {
    return Position{20.5, 20.5};
  }));
  lattices.push_back(warped_by(14, 10, 5.0, {0.0, 0.0}, [](Position p) {
    return Position{p.x, 9.5};
  }));
  lattices.push_back(warped_by(14, 10, 5.0, {0.0, 0.0}, [](Position p) {
    return Position{p.x * 1e-4, p.y * 1e4};
  }));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    lattices.push_back(random_lattice(14, 10, 5.0, {0.0, 0.0}, 0.4, 4));
    lattices.back().u[50] = bad;
    lattices.back().v[80] = -bad;
  }
  for (const WarpedLattice& lattice : lattices) {
    for (Border border : {Border::clamp, Border::mirror, Border::transparent}) {
      const Picture out =
          rendered(picture, lattice, Picture(90, 70, 4, -10, -10), {.border = border});
      for (float x : out.data) {
        ASSERT_TRUE(std::isfinite(x));
        ASSERT_LT(std::abs(x), 3.0f);
      }
    }
  }
}

TEST(ResampleRefusal, NamesValueAndBound) {
  const Picture picture = noise(6, 5, 3, 1);
  const WarpedLattice lattice = at_rest(3, 2, 2.0, {0.0, 0.0});
  const auto made = [&](auto change) {
    kernels::ImageView source = picture.view();
    kernels::LatticeMapView map = lattice.view();
    kernels::ResampleOptions options;
    change(source, map, options);
    return refusal([&] { kernels::Resampler(source, map, options); });
  };
  EXPECT_EQ(made([](auto&, auto&, auto&) {}), "");
  EXPECT_EQ(made([](auto& source, auto&, auto&) { source.channels = 0; }),
            "channels of the source = 0: must be at least 1");
  EXPECT_EQ(made([](auto& source, auto&, auto&) { source.row_stride = 17; }),
            "row_stride of the source = 17: must be at least width·channels = 18");
  EXPECT_EQ(made([](auto& source, auto&, auto&) { source.data = nullptr; }),
            "data of the source = null: must be an array");
  EXPECT_EQ(made([](auto&, auto& map, auto&) { map.nx = 0; }),
            "nx of the lattice map = 0: must be at least 1");
  EXPECT_EQ(made([](auto&, auto& map, auto&) { map.cell_px = -0.5; }),
            "cell_px of the lattice map = -0.5: must be positive and finite");
  EXPECT_EQ(made([](auto&, auto& map, auto&) { map.v = nullptr; }),
            "v of the lattice map = null: must be an array");
  EXPECT_EQ(made([](auto&, auto&, auto& options) { options.detail = 17.0; }),
            "detail = 17: must be 1…16");
  EXPECT_EQ(made([](auto&, auto&, auto& options) { options.threads = -1; }),
            "threads = -1: must be at least 0");
}

TEST(ResampleRefusal, LeavesTheTargetAsItWas) {
  const Picture picture = noise(6, 5, 3, 1);
  const WarpedLattice lattice = at_rest(3, 2, 2.0, {0.0, 0.0});
  const kernels::Resampler resampler(picture.view(), lattice.view());
  Picture out(6, 5, 4);
  EXPECT_EQ(refusal([&] { resampler.render(out.target()); }),
            "channels of the target = 4: must be the source's 3");
  for (const float value : out.data) EXPECT_EQ(value, 0.0f);
  EXPECT_EQ(refusal([&] {
              kernels::forward_map(lattice.view(), {.width = 2, .height = 2, .row_stride = 2});
            }),
            "output of the target = null: must be an array");
  EXPECT_EQ(refusal([&] {
              kernels::backward_map(lattice.view(), {.width = 2, .height = 2, .row_stride = 1});
            }),
            "row_stride of the target = 1: must be at least 2");
}

}  // namespace
}  // namespace drumhead::tests
