// SPDX-License-Identifier: MIT
#include <drumhead/grid/field.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <new>

namespace drumhead::grid {
namespace {

constexpr std::size_t kAlignment = 64, kHugePage = std::size_t(1) << 21;

/// A kernel walks down the rows of a dozen fields at once, each soon on another page: on pages of
/// 4 KiB a product on 800² cells takes a tenth longer.
std::align_val_t alignment(std::size_t bytes) {
  return std::align_val_t(bytes < kHugePage ? kAlignment : kHugePage);
}
void* allocate(std::size_t bytes) {
  void* const data = ::operator new(bytes, alignment(bytes));
#ifdef __linux__
  // Only pages that are filled; where the system has none for us, nothing is lost.
  if (bytes >= kHugePage) madvise(data, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
#endif
  return data;
}

}  // namespace

template <class T>
Field<T>::Field(int columns, int rows, MemoryMeter* meter) : meter_(meter) {
  constexpr int per_line = int(kAlignment / sizeof(T));
  const std::ptrdiff_t half = (columns + 1) / 2;
  plane_.odd = (half + per_line - 1) / per_line * per_line;
  plane_.stride = 2 * plane_.odd;
  plane_.columns = columns;
  plane_.rows = rows;
  plane_.data = static_cast<T*>(allocate(bytes()));
  if (meter_) meter_->add(bytes());
  clear();
}

template <class T>
Field<T>::~Field() {
  if (!plane_) return;
  if (meter_) meter_->remove(bytes());
  ::operator delete(plane_.data, alignment(bytes()));
}

template <class T>
void Field<T>::clear() {
  if (plane_) std::fill_n(plane_.data, std::size_t(plane_.stride) * std::size_t(plane_.rows), T(0));
}

template class Field<float>;
template class Field<double>;

}  // namespace drumhead::grid
