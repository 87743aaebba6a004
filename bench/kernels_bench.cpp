// SPDX-License-Identifier: MIT
// Every kernel, on every instruction set, on lattices for L2, L3 and DRAM, as a share of the speed
// of memory (roofline.h). Every result is first compared with the scalar one, bit for bit; a wrong
// one fails the program.
#include <unistd.h>

#include <bit>
#include <fstream>
#include <functional>
#include <memory>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/transfer.h>

#include "bench_level.h"
#include "competitors.h"
#include "kernel_rows.h"
#include "roofline.h"

namespace drumhead::bench {
namespace {

using kernels::Isa;
using kernels::Plane;
using kernels::Unknowns;

struct Size {
  const char* memory;
  int n;
};

/// Lattices whose twelve float fields take 3/4 of L2, half of L3, and four times L3.
std::vector<Size> sizes() {
  // A virtual machine's sysconf names the whole processor's L3, its sysfs this machine's share.
  const auto cache = [](int index, int name, long otherwise) {
    std::ifstream file("/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(index) +
                       "/size");
    long kib = 0;
    if (file >> kib) return double(kib) * 1024.0;
    const long bytes = sysconf(name);
    return double(bytes > 0 ? bytes : otherwise);
  };
  const double l2 = cache(2, _SC_LEVEL2_CACHE_SIZE, 1 << 20);
  const double l3 = cache(3, _SC_LEVEL3_CACHE_SIZE, 1 << 25);
  const auto side = [](double bytes) { return int(std::sqrt(bytes / 48.0)); };
  return {{"L2", side(0.75 * l2)}, {"L3", side(0.5 * l3)}, {"DRAM", side(4.0 * l3)}};
}

/// A kernel on a level: what it does and what it moves; the value it returns is part of the check.
template <class T>
struct Kernel {
  const char* name;
  Mix mix;
  std::function<double(BenchLevel<T>&)> run;
};

template <class T>
double relax(BenchLevel<T>& level, bool curve, bool down, bool up) {
  const Unknowns<const T> coarse_d = level.coarse_d.view();
  const Unknowns<T> coarse_f = level.coarse_f.view();
  kernels::relax<T>(level.system(curve), {.from_zero = down}, up ? &coarse_d : nullptr,
                    down ? &coarse_f : nullptr, level.scratch);
  return 0.0;
}

template <class T>
Kernel<T> product() {
  return {"Hessian–vector product", {6, 3, 0}, [](BenchLevel<T>& l) {
            kernels::apply_hessian<T>(l.membrane(), l.d.view(), l.out.view());
            return 0.0;
          }};
}

template <class T>
std::vector<Kernel<T>> relaxations() {
  return {{"relaxation", {6, 0, 3}, [](auto& l) { return relax(l, false, false, false); }},
          {"relaxation with curve rows",
           {6, 0, 3},
           [](auto& l) { return relax(l, true, false, false); }},
          {"relaxation from zero, residual restricted",
           {6, 3.75, 0},
           [](auto& l) { return relax(l, false, true, false); }},
          {"relaxation of a prolonged correction", {6.75, 0, 3}, [](auto& l) {
             return relax(l, false, false, true);
           }}};
}

/// The paper's relaxations (kernels/kaczmarz.h), with the curve rows of a circle.
template <class T>
std::vector<Kernel<T>> kaczmarz() {
  using Level = BenchLevel<T>;
  return {{"damped Kaczmarz",
           {7, 3, 3},
           [](Level& l) {
             kernels::damped_kaczmarz<T>(l.kaczmarz(T(0.375)), l.e.view(), l.eq.data());
             return 0.0;
           }},
          {"coloured Kaczmarz", {7, 0, 3}, [](Level& l) {
             kernels::coloured_kaczmarz<T>(l.kaczmarz(T(1.45)), kernels::Reach::everywhere);
             return 0.0;
           }}};
}

template <class T>
std::vector<Kernel<T>> operators() {
  using Level = BenchLevel<T>;
  const auto linear_residual = [](Level& l) {
    kernels::linear_residual<T>(l.membrane(), l.f.view(), l.d.view(), l.out.view());
    return 0.0;
  };
  const auto force = [](Level& l) {
    kernels::force<T>(l.membrane(), l.out.view());
    return 0.0;
  };
  const auto energy = [](Level& l) {
    const kernels::EnergySums sums = kernels::energy<T>(l.membrane(), l.d.view(), T(0.5));
    return sums.elastic + sums.volume_merit;
  };
  const auto norm = [](Level& l) { return kernels::residual_norm2<T>(l.system(), l.scratch); };
  return {{"fused residual", {9, 3, 0}, linear_residual},
          {"residual norm", {9, 0, 0}, norm},
          {"force", {3, 3, 0}, force},
          {"energy at a step", {6, 0, 0}, energy}};
}

template <class T>
std::vector<Kernel<T>> fields() {
  using Level = BenchLevel<T>;
  return {{"injection (one field)",
           {0.25, 0.25, 0},
           [](Level& l) {
             kernels::inject_nodes<T>(l.d.x.view(), l.coarse_f.x.view());
             return 0.0;
           }},
          {"prolongation (one field)",
           {0.25, 1, 0},
           [](Level& l) {
             kernels::prolong_nodes<T>(l.coarse_d.x.view(), l.out.x.view());
             return 0.0;
           }},
          {"mean of cells",
           {1, 0.25, 0},
           [](Level& l) {
             kernels::mean_cells<T>(l.d.p.view(), l.coarse_f.p.view());
             return 0.0;
           }},
          {"interpolation of cells",
           {0.25, 1, 0},
           [](Level& l) {
             kernels::interpolate_cells<T>(l.coarse_d.p.view(), l.out.p.view());
             return 0.0;
           }},
          {"dot product (three fields)",
           {6, 0, 0},
           [](Level& l) { return kernels::dot<T>(l.d.view(), l.f.view()); }},
          {"vector update (three fields)", {3, 0, 3}, [](Level& l) {
             kernels::combine<T>(T(0.25), l.f.view(), T(0.5), l.d.view());
             return 0.0;
           }}};
}

/// The level of a size, kept until another is wanted.
template <class T>
BenchLevel<T>& level_of(int n) {
  static std::unique_ptr<BenchLevel<T>> level;
  if (!level || level->n != n) {
    level.reset();
    level = std::make_unique<BenchLevel<T>>(n);
  }
  return *level;
}

template <class T>
std::vector<std::uint64_t> result(const Kernel<T>& kernel, BenchLevel<T>& level, Isa isa,
                                  int threads) {
  kernels::use_isa(isa);
  omp_set_num_threads(threads);
  level.reset();
  const double value = kernel.run(level);
  std::vector<std::uint64_t> all = level.digest();
  all.push_back(std::bit_cast<std::uint64_t>(value));
  return all;
}

/// The row's keys, which the reporter reads back.
std::string label(const std::string& kernel, const Size& size, const std::string& isa,
                  int threads) {
  return Json{{"kernel", kernel},
              {"n", size.n},
              {"memory", size.memory},
              {"isa", isa},
              {"threads", threads}}
      .dump();
}

void count(benchmark::State& state, double seconds, std::size_t nodes) {
  state.SetIterationTime(seconds);
  state.counters["ns"] = 1e9 * seconds / double(nodes);
}

template <class T>
void run_kernel(benchmark::State& state, const Kernel<T>& kernel, Size size, Isa isa, int threads,
                bool work_units) {
  BenchLevel<T>& level = level_of<T>(size.n);
  const std::vector<std::uint64_t> scalar = result(kernel, level, Isa::scalar, 1);
  const bool right = result(kernel, level, isa, threads) == scalar;
  const Streams streams(kernel.mix, level.nodes(), sizeof(T));
  for (auto _ : state) {
    const auto run = [&] { benchmark::DoNotOptimize(kernel.run(level)); };
    const auto stream = [&] { streams.run(threads); };
    const Paired pair(threads, run, stream);
    count(state, pair.first(), level.nodes());
    state.counters["bytes_per_node"] = kernel.mix.traffic() * sizeof(T);
    state.counters["ratio"] = pair.ratio();
    if (work_units) {
      const Kernel<T> unit = product<T>();
      state.counters["work_units"] = Paired(
                                         threads, [&] { unit.run(level); }, run)
                                         .ratio();
    }
    if (threads == 1) continue;
    const auto alone = [&](auto&& loop) {
      return [&loop] {
        omp_set_num_threads(1);
        loop();
      };
    };
    const auto together = [&] {
      omp_set_num_threads(threads);
      run();
    };
    state.counters["gain"] = Paired(threads, together, alone(run)).ratio();
    state.counters["stream_gain"] = Paired(threads, stream, [&] { streams.run(1); }).ratio();
  }
  omp_set_num_threads(1);
  const char* number = sizeof(T) == 8 ? ", double" : "";
  state.SetLabel(label(std::string(kernel.name) + number, size, std::string(name(isa)), threads));
  if (!right) state.SkipWithError("not the scalar result");
}

template <class T>
void add(const Kernel<T>& kernel, Size size, Isa isa, int threads, bool work_units = false) {
  const std::string full = std::string(kernel.name) + "/" + size.memory + "/" +
                           std::string(name(isa)) + (sizeof(T) == 8 ? "/double" : "/float") + "/" +
                           std::to_string(threads);
  benchmark::RegisterBenchmark(full.c_str(),
                               [=](benchmark::State& state) {
                                 run_kernel<T>(state, kernel, size, isa, threads, work_units);
                               })
      ->Iterations(1)
      ->UseManualTime();
}

/// The curve rows alone: time per cut cell, there and back.
void run_curve(benchmark::State& state, Size size) {
  kernels::use_isa(kernels::available_isas().back());
  BenchLevel<float>& level = level_of<float>(size.n);
  level.reset();
  const kernels::LevelSystem<float> s = level.system(true);
  const auto rows = [&] {
    for (const bool reverse : {false, true})
      for (int j = 0; j < size.n; ++j)
        kernels::relax_cuts_row<float>(s.membrane, s.cuts, s.fq, s.dq, s.d, s.f, reverse, j);
  };
  for (auto _ : state) {
    const Paired pair(1, rows, [] {});
    count(state, pair.first(), std::size_t(s.cuts.count));
  }
  state.SetLabel(label("curve rows there and back, per cut cell", size, "–", 1));
}

/// A competitor's product of the same matrix; `against` is its time by ours in alternation.
void run_competitor(benchmark::State& state, Contender which, Size size) {
  kernels::use_isa(kernels::available_isas().back());
  // A matrix of this size is many times the cache already: more of it would tell nothing new.
  if (which != Contender::plain_loop) size.n = std::min(size.n, 600);
  const Competitor competitor(which, size.n);
  for (auto _ : state) {
    const Paired pair(
        1, [&] { competitor.run_ours(); }, [&] { competitor.run(); });
    count(state, pair.second(), competitor.nodes());
    state.counters["against"] = pair.ratio();
  }
  state.SetLabel(label(competitor.name(), size, "native", 1));
  if (!competitor.right()) state.SkipWithError("not our product");
}

void register_all() {
  for (const Size& size : sizes()) {
    for (const Isa isa : kernels::available_isas()) {
      add(product<float>(), size, isa, 1);
      for (const auto& kernel : operators<float>()) add(kernel, size, isa, 1, true);
      for (const auto& kernel : relaxations<float>()) add(kernel, size, isa, 1, true);
      for (const auto& kernel : kaczmarz<float>()) add(kernel, size, isa, 1, true);
      for (const auto& kernel : fields<float>()) add(kernel, size, isa, 1);
    }
    const Isa best = kernels::available_isas().back();
    if (std::string_view(size.memory) == "DRAM") {
      add(product<float>(), size, best, 2);
      add(operators<float>().front(), size, best, 2);
      for (const auto& kernel : relaxations<float>()) add(kernel, size, best, 2);
    }
    benchmark::RegisterBenchmark((std::string("curve/") + size.memory).c_str(),
                                 [=](benchmark::State& state) { run_curve(state, size); })
        ->Iterations(1)
        ->UseManualTime();
    for (const Contender which : contenders()) {
      benchmark::RegisterBenchmark(
          (std::string("competitor/") + size.memory + "/" + std::to_string(int(which))).c_str(),
          [=](benchmark::State& state) { run_competitor(state, which, size); })
          ->Iterations(1)
          ->UseManualTime();
    }
    add(product<double>(), size, best, 1);
    add(relaxations<double>().front(), size, best, 1, true);
  }
}

}  // namespace
}  // namespace drumhead::bench

int main(int argc, char** argv) {
  // One thread unless a row says otherwise: the kernels ask OpenMP.
  omp_set_num_threads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  drumhead::bench::register_all();
  drumhead::bench::Results results(argc, argv);
  drumhead::bench::RowReporter reporter(results);
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return reporter.failures() == 0 ? 0 : 1;
}
