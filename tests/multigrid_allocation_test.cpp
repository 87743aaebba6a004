// SPDX-License-Identifier: MIT
// Nothing is allocated inside a multigrid cycle, nor by the kernels that Newton's method calls
// between cycles. Counts every global operator new of this program.
#include <atomic>
#include <cstdlib>
#include <new>

#include <drumhead/kernels/elastic.h>
#include <drumhead/kernels/reduce.h>
#include <drumhead/kernels/threads.h>
#include <gtest/gtest.h>

#include "cycle.h"
#include "support/scene_problem.h"

namespace {

std::atomic<int> allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded ? rounded : alignment)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, std::size_t(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace drumhead::multigrid {
namespace {

template <class T>
struct Fixture {
  explicit Fixture(int n = 64)
      : problem(scenes::problem(scenes::roundabout(90.0, scenes::kStudyOffset), n, 10.0)) {}
  WarpProblem problem;
  grid::MemoryMeter meter;
  Hierarchy<T> hierarchy{problem.lattice, problem.material,
                         grid::cut(problem.curves, problem.lattice, 1e6),
                         SceneTraits{.jump = 0.005}, meter};
};

TEST(Allocation, IsCounted) {
  const int before = allocations;
  const std::vector<double> memory(10);
  EXPECT_EQ(allocations - before, 1);
}

template <class T>
void expect_no_allocation_in_cycles(int threads, int n = 64) {
  const kernels::ThreadLimit limit(threads);
  Fixture<T> scene(n);
  Cycle<T> cycle(scene.hierarchy, 0, true, Cycle<T>::kDefinite);
  for (const CycleKind kind : {CycleKind::v, CycleKind::f}) {
    cycle.run(kind, true);  // what is kept from call to call is allocated once
    const int before = allocations;
    cycle.run(kind, true);
    cycle.run(kind, false);
    EXPECT_EQ(allocations - before, 0);
  }
}

TEST(Allocation, IsAbsentFromCyclesInSinglePrecision) { expect_no_allocation_in_cycles<float>(1); }
TEST(Allocation, IsAbsentFromCyclesInDoublePrecision) { expect_no_allocation_in_cycles<double>(1); }
// A lattice large enough to be shared out.
TEST(Allocation, IsAbsentFromCyclesOnTwoThreads) { expect_no_allocation_in_cycles<float>(2, 256); }

TEST(Allocation, IsAbsentFromForceEnergyAndNorms) {
  Fixture<float> scene;
  Level<float>& level = scene.hierarchy[0];
  auto once = [&] {
    const kernels::Membrane<float> membrane = level.membrane();
    kernels::force<float>(membrane, level.f.view());
    const kernels::Unknowns<const float> d = level.d.view();
    double sum = kernels::energy<float>(membrane, d, 1.0f).elastic;
    sum += kernels::dot<float>(d, d) + kernels::move<float>(1.0f, d.x, level.ux.view()).reach;
    return sum;
  };
  EXPECT_GE(once(), 0.0);
  const int before = allocations;
  EXPECT_GE(once(), 0.0);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace drumhead::multigrid
