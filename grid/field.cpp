// SPDX-License-Identifier: MIT
#include <drumhead/grid/field.h>

#include <algorithm>
#include <new>

namespace drumhead::grid {
namespace {

constexpr std::size_t kAlignment = 64;

}  // namespace

template <class T>
Field<T>::Field(int columns, int rows, MemoryMeter* meter) : meter_(meter) {
  constexpr int per_line = int(kAlignment / sizeof(T));
  const std::ptrdiff_t half = (columns + 1) / 2;
  plane_.odd = (half + per_line - 1) / per_line * per_line;
  plane_.stride = 2 * plane_.odd;
  plane_.columns = columns;
  plane_.rows = rows;
  plane_.data = static_cast<T*>(::operator new(bytes(), std::align_val_t(kAlignment)));
  if (meter_) meter_->add(bytes());
  clear();
}

template <class T>
Field<T>::~Field() {
  if (!plane_) return;
  if (meter_) meter_->remove(bytes());
  ::operator delete(plane_.data, std::align_val_t(kAlignment));
}

template <class T>
void Field<T>::clear() {
  if (plane_) std::fill_n(plane_.data, std::size_t(plane_.stride) * std::size_t(plane_.rows), T(0));
}

template class Field<float>;
template class Field<double>;

}  // namespace drumhead::grid
