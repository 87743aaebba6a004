// SPDX-License-Identifier: MIT
#pragma once
// How many threads the kernels may use. Results do not depend on it.

namespace drumhead::kernels {

/// The number of threads that a kernel called now would use at most.
int thread_limit();

/// Sets the limit for the life of the object, then what it was before; 0 leaves it as it is.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  int before_;
};

}  // namespace drumhead::kernels
