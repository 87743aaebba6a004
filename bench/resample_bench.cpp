// SPDX-License-Identifier: MIT
// Our resampler beside other libraries' samplers, all by the same backward map: signal to noise
// against a brute force picture of 16 × 16 samples a pixel, and output pixels per second, as rows
// of JSON (results.h).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>

#include "results.h"
#include "samplers.h"
#include "support/scene_problem.h"
#include "support/warped_lattice.h"

namespace drumhead::bench {
namespace {

using kernels::Position;
using tests::WarpedLattice;

constexpr int kSize = 1024, kChannels = 3, kRounds = 5, kSamples = 16;
const Position kCentre{kSize / 2.0, kSize / 2.0};

/// Rings around the centre, from 0 to 0.35 cycles a pixel at the middles of the edges: nearly all
/// that pixels can hold, and beyond what they can once it is compressed. The channels differ in
/// phase.
double rings(Position p, int channel) {
  const double r2 = (p.x - kCentre.x) * (p.x - kCentre.x) + (p.y - kCentre.y) * (p.y - kCentre.y);
  return 0.5 + 0.5 * std::cos(M_PI * 0.35 * r2 / (kSize / 2.0) + 2.0 * channel);
}

/// The output pixels that are rendered, and the part of them (its middle) that the oracle is made
/// for.
struct Case {
  const char* name;
  WarpedLattice lattice;
  int width, judged;
  int left() const { return (kSize - width) / 2; }
};

WarpedLattice affine(double degrees, double scale) {
  const double c = scale * std::cos(degrees * M_PI / 180),
               s = scale * std::sin(degrees * M_PI / 180);
  return tests::warped_by(64, 64, kSize / 64.0, {0, 0}, [=](Position p) {
    const double x = p.x - kCentre.x, y = p.y - kCentre.y;
    return Position{kCentre.x + c * x - s * y, kCentre.y + s * x + c * y};
  });
}

/// The study's roundabout, solved: inner circle turned by 90°, outer one held.
WarpedLattice roundabout() {
  constexpr int n = 256;
  const auto scene = scenes::roundabout(90.0, scenes::kStudyOffset);
  multigrid::Solution s =
      multigrid::solve(scenes::problem(scene, n, 10.0),
                       {.curve_method = multigrid::CurveMethod::averaged, .threads = 1});
  for (auto* field : {&s.u_px, &s.v_px}) {
    for (double& x : *field) x *= kSize;
  }
  return {n, n, double(kSize) / n, {0, 0}, std::move(s.u_px), std::move(s.v_px)};
}

std::vector<Position> sources(const WarpedLattice& lattice, int left, int top, int width,
                              int height) {
  std::vector<Position> source(std::size_t(width) * std::size_t(height));
  kernels::backward_map(lattice.view(),
                        {source.data(), nullptr, nullptr, width, height, width, left, top}, 1);
  return source;
}

/// The mean of the rings over each pixel of the judged square, from 16 × 16 exact source positions:
/// the backward map of the same lattice, 16 times as large.
Pixels oracle(const Case& c) {
  WarpedLattice fine = c.lattice;
  fine.cell_px *= kSamples;
  fine.origin_px = {fine.origin_px.x * kSamples, fine.origin_px.y * kSamples};
  for (auto* field : {&fine.u, &fine.v}) {
    for (double& x : *field) x *= kSamples;
  }
  Pixels truth{c.judged, c.judged, kChannels, {}};
  truth.data.resize(std::size_t(c.judged * c.judged * kChannels));
  const int first = (kSize - c.judged) / 2, columns = c.judged * kSamples;
  constexpr int kRows = 16;  // of pixels at a time
  for (int row = 0; row < c.judged; row += kRows) {
    const auto source =
        sources(fine, first * kSamples, (first + row) * kSamples, columns, kRows * kSamples);
    for (std::size_t k = 0; k < source.size(); ++k) {
      const std::size_t a = k % std::size_t(columns) / kSamples;
      const std::size_t b = std::size_t(row) + k / std::size_t(columns) / kSamples;
      const Position p{source[k].x / kSamples, source[k].y / kSamples};
      for (int channel = 0; channel < kChannels; ++channel) {
        truth.data[(b * std::size_t(c.judged) + a) * kChannels + std::size_t(channel)] +=
            float(rings(p, channel) / (kSamples * kSamples));
      }
    }
  }
  return truth;
}

/// dB over the judged square, peak 1.
double psnr(const Case& c, const Pixels& out, const Pixels& truth) {
  const int inset = (c.width - c.judged) / 2;
  double squares = 0.0;
  for (int b = 0; b < c.judged; ++b) {
    for (int k = 0; k < c.judged * kChannels; ++k) {
      const double d = out.data[std::size_t(((b + inset) * c.width + inset) * kChannels + k)] -
                       truth.data[std::size_t(b * c.judged * kChannels + k)];
      squares += d * d;
    }
  }
  return -10.0 * std::log10(squares / double(truth.data.size()));
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Seconds that all threads of this program worked: other programs do not count.
double worked() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

template <class Run>
double seconds_of(const Run& run) {
  const double start = worked();
  run();
  return worked() - start;
}

void run(const Case& c, const Pixels& picture, const std::vector<Sampler>& others,
         Results& results) {
  const Pixels truth = oracle(c);
  Pixels out{c.width, c.width, kChannels, {}};
  out.data.resize(std::size_t(c.width * c.width * kChannels));
  const std::ptrdiff_t stride = std::ptrdiff_t(kSize) * kChannels;
  const kernels::ImageView source{picture.data.data(), kSize, kSize, kChannels, stride};
  const kernels::ImageTarget target{
      out.data.data(), c.width, c.width, kChannels, std::ptrdiff_t(c.width) * kChannels,
      c.left(),        c.left()};
  const auto ours = [&] {
    kernels::Resampler(source, c.lattice.view(), {.threads = 1}).render(target);
  };
  std::vector<Position> map;
  const auto inverse = [&] { map = sources(c.lattice, c.left(), c.left(), c.width, c.width); };
  const double megapixels = 1e-6 * c.width * c.width;
  const auto print = [&](const std::string& who, const std::string& filter, double decibels,
                         const std::vector<double>& seconds, const std::vector<double>& our) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < seconds.size(); ++k) ratios.push_back(seconds[k] / our[k]);
    Json row{{"warp", c.name}, {"sampler", who}, {"filter", filter}};
    if (decibels > 0.0) row["psnr_db"] = decibels;
    row["megapixels_per_second"] = megapixels / median(seconds);
    row["by_ours"] = median(ratios);
    results.row("resample", row);
  };

  ours();
  const double decibels = psnr(c, out, truth);
  std::vector<double> mine, invert;
  for (int round = 0; round < kRounds; ++round) {
    mine.push_back(seconds_of(ours));
    invert.push_back(seconds_of(inverse));
  }
  print("drumhead, map included", "by the Jacobian", decibels, mine, mine);
  print("drumhead, the map alone", "–", 0.0, invert, mine);
  for (const Sampler& other : others) {
    other.sample(map, out);
    const double theirs = psnr(c, out, truth);
    std::vector<double> seconds, paired;
    for (int round = 0; round < kRounds; ++round) {
      paired.push_back(seconds_of(ours));
      seconds.push_back(seconds_of([&] { other.sample(map, out); }));
    }
    print(other.library, other.filter, theirs, seconds, paired);
  }
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) try {
  using namespace drumhead::bench;
  Pixels picture{kSize, kSize, kChannels, {}};
  for (int b = 0; b < kSize; ++b) {
    for (int a = 0; a < kSize; ++a) {
      for (int channel = 0; channel < kChannels; ++channel) {
        picture.data.push_back(float(rings({a + 0.5, b + 0.5}, channel)));
      }
    }
  }
  const auto others = samplers(picture);
  Results results(argc, argv);
  const Case cases[] = {{"turned by 30°", affine(30, 1), 704, 640},
                        {"roundabout 90°, solved", roundabout(), 832, 640},
                        {"compressed 4 times", affine(10, 0.25), 176, 160},
                        {"compressed 8 times", affine(10, 0.125), 88, 80}};
  for (const Case& c : cases) run(c, picture, others, results);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "resample_bench: %s\n", error.what());
  return 1;
}
