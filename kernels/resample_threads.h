// SPDX-License-Identifier: MIT
#pragma once
// Independent tasks of uneven cost (tiles of pixels), handed out as threads become free.
#include <omp.h>

namespace drumhead::kernels {

inline int thread_count(int threads) { return threads > 0 ? threads : omp_get_max_threads(); }

/// Calls task(k, thread) for every k in [0, tasks), thread < thread_count(threads). Tasks must not
/// throw.
template <class Task>
void for_each_task(int tasks, int threads, const Task& task) {
  const int team = thread_count(threads);
#pragma omp parallel for schedule(dynamic) num_threads(team) if (team > 1 && tasks > 1)
  for (int k = 0; k < tasks; ++k) task(k, omp_get_thread_num());
}

}  // namespace drumhead::kernels
