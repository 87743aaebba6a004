// SPDX-License-Identifier: MIT
#pragma once
// The speed of memory, measured beside a kernel. A mix says how many values a kernel loads, stores
// and updates per node; Streams moves the same bytes with instructions of the same width and no
// formula, field by field in pieces of a kilobyte (faster in DRAM than longer pieces). Kernel and
// streams run in turn, so that whatever else the machine does meets both; what counts is the median
// of the pairs' ratios. On one thread the clock is the thread's own, which stands still while
// others have the core.
#include <omp.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#include <drumhead/kernels/isa.h>

namespace drumhead::bench {

/// Values per node that a kernel has to move at least: each field once, however often it reads it.
struct Mix {
  double loads = 0.0;    ///< read only
  double stores = 0.0;   ///< written only; the cache reads the line first (write-allocate)
  double updates = 0.0;  ///< read and written

  /// Through the bus: a store and an update are read and written back.
  double traffic() const { return loads + 2.0 * (stores + updates); }
  double resident() const { return loads + stores + updates; }
};

enum class Move { load, store, update };

// A batch as one register. The empty asm takes the loaded value, so that the load stays, and hides
// the stored one, so that no memset is made of the loop.
#define DRUMHEAD_STREAM(name, isa, type, reg)                                     \
  __attribute__((target(isa))) inline void name(Move move, char* at, char* end) { \
    typedef type V __attribute__((may_alias));                                    \
    V* p = reinterpret_cast<V*>(at);                                              \
    V* const stop = reinterpret_cast<V*>(end);                                    \
    V value{};                                                                    \
    if (move == Move::load) {                                                     \
      for (; p != stop; p += 4)                                                   \
        for (int n = 0; n < 4; ++n) asm volatile("" ::reg(p[n]));                 \
    } else if (move == Move::store) {                                             \
      for (; p != stop; p += 4) {                                                 \
        asm volatile("" : "+" reg(value));                                        \
        for (int n = 0; n < 4; ++n) p[n] = value;                                 \
      }                                                                           \
    } else {                                                                      \
      for (; p != stop; p += 4)                                                   \
        for (int n = 0; n < 4; ++n) {                                             \
          V v = p[n];                                                             \
          asm volatile("" : "+" reg(v));                                          \
          p[n] = v;                                                               \
        }                                                                         \
    }                                                                             \
  }
typedef float Bytes16 __attribute__((vector_size(16)));
typedef float Bytes32 __attribute__((vector_size(32)));
typedef float Bytes64 __attribute__((vector_size(64)));
DRUMHEAD_STREAM(move_scalar, "sse2", float, "x")
DRUMHEAD_STREAM(move_sse2, "sse2", Bytes16, "x")
DRUMHEAD_STREAM(move_avx2, "avx2", Bytes32, "x")
DRUMHEAD_STREAM(move_avx512, "avx512f", Bytes64, "v")
#undef DRUMHEAD_STREAM

/// Fields of one value per node (a part of one for fractions of a mix) and the loop over them.
class Streams {
 public:
  Streams(const Mix& mix, std::size_t nodes, std::size_t value_bytes) {
    add(Move::load, mix.loads, nodes * value_bytes);
    add(Move::update, mix.updates, nodes * value_bytes);
    add(Move::store, mix.stores, nodes * value_bytes);
    pieces_ = (nodes * value_bytes + kPiece - 1) / kPiece;
  }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  /// All fields once, with the instructions of the instruction set in use.
  void run(int threads) const {
    if (threads == 1) return run(0, pieces_);
#pragma omp parallel num_threads(threads)
    {
      const auto n = std::size_t(omp_get_num_threads()), me = std::size_t(omp_get_thread_num());
      run(pieces_ * me / n, pieces_ * (me + 1) / n);
    }
  }

 private:
  static constexpr std::size_t kPiece = 1024, kUnit = 256, kAlignment = 4096;
  struct Free {
    void operator()(char* at) const { ::operator delete(at, std::align_val_t(kAlignment)); }
  };
  struct Field {
    std::unique_ptr<char, Free> memory;
    char* begin;
    std::size_t piece;  ///< bytes of a piece of nodes
    Move move;
  };

  void add(Move move, double count, std::size_t bytes) {
    for (double left = count; left > 1e-9; left -= 1.0) {
      const auto units = std::size_t(std::min(left, 1.0) * double(kPiece / kUnit) + 0.5);
      const std::size_t piece = std::max<std::size_t>(units, 1) * kUnit;
      const std::size_t size = (bytes + kPiece - 1) / kPiece * piece + kAlignment;
      Field field{{}, nullptr, piece, move};
      field.memory.reset(static_cast<char*>(::operator new(size, std::align_val_t(kAlignment))));
      // Not all at the same place of a page, where loads and stores would be taken for one another.
      field.begin = field.memory.get() + fields_.size() * 7 % 16 * kUnit;
      std::fill_n(field.memory.get(), size, char(0));
      fields_.push_back(std::move(field));
    }
  }

  void run(std::size_t begin, std::size_t end) const {
    using kernels::Isa;
    const Isa isa = kernels::current_isa();
    const auto move = isa == Isa::avx512 ? move_avx512
                      : isa == Isa::avx2 ? move_avx2
                      : isa == Isa::sse2 ? move_sse2
                                         : move_scalar;
    for (std::size_t piece = begin; piece < end; ++piece)
      for (const Field& field : fields_) {
        char* const at = field.begin + piece * field.piece;
        move(field.move, at, at + field.piece);
      }
  }

  std::vector<Field> fields_;
  std::size_t pieces_ = 0;
};

/// Seconds: of this thread, or of the wall clock if several work.
inline double seconds_now(int threads) {
  if (threads > 1)
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Two loops run in turn. Each leg repeats its loop until it lasts a few milliseconds.
class Paired {
 public:
  static constexpr int kPairs = 15;
  static constexpr double kLegSeconds = 3e-3;

  template <class F, class G>
  Paired(int threads, F&& first, G&& second) {
    const auto leg = [&](auto& loop, int repeats) {
      const double start = seconds_now(threads);
      for (int n = 0; n < repeats; ++n) loop();
      return (seconds_now(threads) - start) / repeats;
    };
    const auto repeats = [&](auto& loop) {
      loop();
      return std::max(1, int(kLegSeconds / std::max(leg(loop, 1), 1e-7)));
    };
    const int n_first = repeats(first), n_second = repeats(second);
    for (int pair = 0; pair < kPairs; ++pair) {
      double a = 0.0, b = 0.0;
      if (pair % 2 == 0) a = leg(first, n_first);
      b = leg(second, n_second);
      if (pair % 2 != 0) a = leg(first, n_first);
      first_.push_back(a);
      second_.push_back(b);
      ratio_.push_back(b / a);
    }
  }

  double first() const { return median(first_); }  ///< seconds of one run of the first loop
  double second() const { return median(second_); }
  double ratio() const { return median(ratio_); }  ///< second / first, of each pair

 private:
  std::vector<double> first_, second_, ratio_;
};

}  // namespace drumhead::bench
