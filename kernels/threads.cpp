// SPDX-License-Identifier: MIT
#include <drumhead/kernels/threads.h>

#include "parallel.h"

namespace drumhead::kernels {

int thread_limit() { return omp_get_max_threads(); }

ThreadLimit::ThreadLimit(int threads) : before_(thread_limit()) {
  if (threads > 0) omp_set_num_threads(threads);
}

ThreadLimit::~ThreadLimit() { omp_set_num_threads(before_); }

}  // namespace drumhead::kernels
