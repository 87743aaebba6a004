// SPDX-License-Identifier: MIT
#pragma once
// The only place that knows threads. Rows are handed out in contiguous chunks; what a row computes
// never depends on the chunk it is in, so results are bit-equal for any number of threads. Below
// kSerialNodes the loop runs serially: waking threads costs more than the work.
#include <omp.h>

#include <cstddef>

namespace drumhead::kernels {

/// Nodes × passes under which a loop is run by the calling thread alone: about 0.2 ms of work.
/// Waking threads costs some microseconds on an idle machine, but a time slice on a loaded one,
/// where libgomp's spinning threads wait for one another.
constexpr std::ptrdiff_t kSerialNodes = 200000;

inline int threads_for(std::ptrdiff_t nodes) {
  return nodes < kSerialNodes || omp_in_parallel() ? 1 : omp_get_max_threads();
}

/// body(first, last, thread): the rows [begin, end) of `columns` nodes, a chunk for each thread.
template <class F>
void for_chunks_of_rows(int begin, int end, int columns, F&& body) {
  const int threads = threads_for(std::ptrdiff_t(end - begin) * columns);
  if (threads == 1) return body(begin, end, 0);
#pragma omp parallel num_threads(threads)
  {
    const int n = omp_get_num_threads(), me = omp_get_thread_num();
    const auto cut = [&](int c) { return begin + int(std::ptrdiff_t(end - begin) * c / n); };
    body(cut(me), cut(me + 1), me);
  }
}

/// body(j, thread) for j in [begin, end).
template <class F>
void for_rows_on_threads(int begin, int end, int columns, F&& body) {
  for_chunks_of_rows(begin, end, columns, [&](int first, int last, int thread) {
    for (int j = first; j < last; ++j) body(j, thread);
  });
}

/// body(j) for j in [begin, end).
template <class F>
void for_rows(int begin, int end, int columns, F&& body) {
  for_rows_on_threads(begin, end, columns, [&](int j, int) { body(j); });
}

/// Several sweeps over the same rows in one skewed pass, so that a row is still in cache when the
/// next sweep wants it. stage(s, j, thread) runs sweep s on row j and may touch rows j−1…j+1 only;
/// it is called when sweep s−1 is done up to row j+2, which keeps any two sweeps two rows apart:
/// the result is that of whole sweeps one after the other. Threads first do a trapezoid each, then
/// the wedges left between them.
template <class F>
void skewed_sweeps(int rows, int stages, int columns, F&& stage) {
  constexpr int kLag = 2;
  int threads = threads_for(std::ptrdiff_t(rows) * columns * stages);
  const int most = rows / (2 * kLag * (stages + 1));
  if (threads > most) threads = most > 1 ? most : 1;
  auto run = [&](int begin, int end, int shrink_begin, int shrink_end, int thread) {
    // Rows of stage s: [begin + s·shrink_begin, end − s·shrink_end), in skewed order.
    const int first = begin < 0 ? 0 : begin;
    for (int t = first - kLag * stages; t < rows + kLag * stages; ++t)
      for (int s = 0; s < stages; ++s) {
        const int j = t - kLag * s;
        int low = begin + s * shrink_begin, high = end - s * shrink_end;
        if (low < 0) low = 0;
        if (high > rows) high = rows;
        if (j >= low && j < high) stage(s, j, thread);
        if (s == stages - 1 && j >= high) return;
      }
  };
  if (threads == 1) {
    run(0, rows, 0, 0, 0);
    return;
  }
#pragma omp parallel num_threads(threads)
  {
    const int n = omp_get_num_threads(), me = omp_get_thread_num();
    const auto cut = [&](int c) { return int(std::ptrdiff_t(rows) * c / n); };
    run(cut(me), cut(me + 1), me > 0 ? kLag : 0, me + 1 < n ? kLag : 0, me);
#pragma omp barrier
    if (me + 1 < n) run(cut(me + 1), cut(me + 1), -kLag, -kLag, me);
  }
}

}  // namespace drumhead::kernels
