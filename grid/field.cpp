// SPDX-License-Identifier: MIT
#include <drumhead/grid/field.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdint>
#include <new>

namespace drumhead::grid {
namespace {

constexpr std::size_t kAlignment = 64, kHugePage = std::size_t(1) << 21;

#ifdef __linux__
constexpr bool kMaps = true;

std::size_t in_huge_pages(std::size_t bytes) {
  return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

/// A kernel walks down the rows of a dozen fields at once, each soon on another page: on pages of
/// 4 KiB a product on 800² cells takes a tenth longer.
std::byte* map(std::size_t bytes) {
  const std::size_t size = in_huge_pages(bytes);
  void* const mapped =
      mmap(nullptr, size + kHugePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  std::byte* const from = static_cast<std::byte*>(mapped);
  const std::size_t before = in_huge_pages(reinterpret_cast<std::uintptr_t>(from)) -
                             reinterpret_cast<std::uintptr_t>(from);
  if (before > 0) munmap(from, before);
  if (before < kHugePage) munmap(from + before + size, kHugePage - before);
  // Only pages that are filled for the most part; where the system has none, nothing is lost.
  madvise(from + before, (bytes + kHugePage / 2) / kHugePage * kHugePage, MADV_HUGEPAGE);
  return from + before;
}
void unmap(std::byte* data, std::size_t bytes) { munmap(data, in_huge_pages(bytes)); }
#else
constexpr bool kMaps = false;
std::byte* map(std::size_t) { throw std::bad_alloc(); }
void unmap(std::byte*, std::size_t) {}
#endif

bool mapped(std::size_t bytes) { return kMaps && bytes >= kHugePage; }

}  // namespace

Memory::Memory(std::size_t bytes) {
  if (mapped(bytes)) {
    data_ = {map(bytes), Release{bytes}};
    return;
  }
  void* const data = ::operator new(bytes, std::align_val_t(kAlignment));
  data_ = {static_cast<std::byte*>(data), Release{bytes}};
  std::fill_n(data_.get(), bytes, std::byte(0));
}

void Memory::Release::operator()(std::byte* data) const {
  if (mapped(bytes))
    unmap(data, bytes);
  else
    ::operator delete(data, std::align_val_t(kAlignment));
}

void prefer_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  const auto begin = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t from = in_huge_pages(begin), to = (begin + bytes) / kHugePage * kHugePage;
  if (from < to) madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

template <class T>
kernels::Plane<T> Field<T>::shape(int columns, int rows) {
  constexpr int per_line = int(kAlignment / sizeof(T));
  const std::ptrdiff_t half = (columns + 1) / 2, odd = (half + per_line - 1) / per_line * per_line;
  return {nullptr, 2 * odd, odd, columns, rows};
}

template <class T>
Field<T>::Field(int columns, int rows, MemoryMeter* meter)
    : plane_(shape(columns, rows)), meter_(meter) {
  std::byte* data = meter ? meter->take(bytes()) : nullptr;
  if (!data) {
    own_ = Memory(bytes());
    data = own_.data();
  }
  plane_.data = reinterpret_cast<T*>(data);
  if (meter_) meter_->add(bytes());
}

template <class T>
Field<T>::~Field() {
  if (meter_) meter_->remove(bytes());
}

template <class T>
void Field<T>::clear() {
  if (plane_) std::fill_n(plane_.data, std::size_t(plane_.stride) * std::size_t(plane_.rows), T(0));
}

template class Field<float>;
template class Field<double>;

}  // namespace drumhead::grid
