// SPDX-License-Identifier: MIT
#pragma once
// A field that owns its memory: one number per node or cell in the split rows of kernels/views.h,
// aligned to 64 bytes and zero at first. A meter may count its bytes, so that a solver can say what
// it took, and hold them in one piece with those of other fields.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <drumhead/kernels/views.h>

namespace drumhead::grid {

/// Memory that is zero at first: from 2 MiB on straight from the system, on huge pages, and touched
/// by no one before its owner, so that each thread gets its rows' pages where it uses them.
class Memory {
 public:
  Memory() = default;
  /// Throws std::bad_alloc.
  explicit Memory(std::size_t bytes);
  std::byte* data() const { return data_.get(); }

 private:
  struct Release {
    std::size_t bytes;
    void operator()(std::byte* data) const;
  };
  std::unique_ptr<std::byte, Release> data_;
};

/// Asks for huge pages where [data, data + bytes) fills them, before it is first written: large
/// arrays that are not fields. Changes nothing but speed.
void prefer_huge_pages(void* data, std::size_t bytes);

/// Bytes in use and their peak.
class MemoryMeter {
 public:
  /// One piece for fields that are made after this, as far as it reaches; freed with the meter. Of
  /// use from some MiB on: a piece that large lies on huge pages, which single fields, of coarse
  /// levels above all, would not fill.
  void reserve(std::size_t bytes) {
    next_ = pieces_.emplace_back(bytes).data();
    left_ = bytes;
  }
  /// From the piece reserved last, or null where that does not do; zero. `bytes`: a multiple of 64.
  std::byte* take(std::size_t bytes) {
    if (bytes > left_) return nullptr;
    left_ -= bytes;
    return std::exchange(next_, next_ + bytes);
  }
  void add(std::size_t bytes) {
    const std::size_t now = current_ += bytes;
    if (now > peak_) peak_ = now;
  }
  void remove(std::size_t bytes) { current_ -= bytes; }
  /// The peak from here on.
  void forget_peak() { peak_ = current_; }
  std::size_t current() const { return current_; }
  std::size_t peak() const { return peak_; }

 private:
  std::size_t current_ = 0, peak_ = 0;
  std::vector<Memory> pieces_;
  std::byte* next_ = nullptr;
  std::size_t left_ = 0;
};

template <class T>
class Field {
 public:
  Field() = default;
  /// columns × rows values, all 0. Throws std::bad_alloc. `meter` must outlive the field.
  Field(int columns, int rows, MemoryMeter& meter) : Field(columns, rows, &meter) {}
  /// The same, counted by no meter.
  Field(int columns, int rows) : Field(columns, rows, nullptr) {}
  Field(Field&& other) noexcept { swap(other); }
  Field& operator=(Field&& other) noexcept {
    Field moved(std::move(other));
    swap(moved);
    return *this;
  }
  ~Field();

  /// A window; null for an empty field.
  kernels::Plane<T> view() { return plane_; }
  kernels::Plane<const T> view() const { return plane_; }
  explicit operator bool() const { return bool(plane_); }
  std::size_t bytes() const { return bytes(plane_); }
  /// Those of a field of this size.
  static std::size_t bytes(int columns, int rows) { return bytes(shape(columns, rows)); }
  void clear();

 private:
  Field(int columns, int rows, MemoryMeter* meter);
  static kernels::Plane<T> shape(int columns, int rows);
  static std::size_t bytes(const kernels::Plane<T>& plane) {
    return std::size_t(plane.stride) * std::size_t(plane.rows) * sizeof(T);
  }
  void swap(Field& other) noexcept {
    std::swap(plane_, other.plane_);
    std::swap(meter_, other.meter_);
    std::swap(own_, other.own_);
  }
  kernels::Plane<T> plane_;
  MemoryMeter* meter_ = nullptr;
  Memory own_;  ///< null: in the meter's piece
};

/// x, y per node and, if asked for, p per cell of an nx × ny lattice; `listed`: one per part of its
/// special cells; `curve`: two per curve node where a curve is soft.
template <class T>
struct UnknownFields {
  Field<T> x, y, p;
  std::vector<T> listed, curve;
  UnknownFields() = default;
  UnknownFields(int nx, int ny, bool pressure, MemoryMeter& meter)
      : x(nx + 1, ny + 1, meter), y(nx + 1, ny + 1, meter) {
    if (pressure) p = Field<T>(nx, ny, meter);
  }
  kernels::Unknowns<T> view() {
    return {x.view(),           y.view(),     p.view(),         listed.data(),
            int(listed.size()), curve.data(), int(curve.size())};
  }
  kernels::Unknowns<const T> view() const {
    return {x.view(),           y.view(),     p.view(),         listed.data(),
            int(listed.size()), curve.data(), int(curve.size())};
  }
  void clear() {
    x.clear();
    y.clear();
    p.clear();
    std::ranges::fill(listed, T(0));
    std::ranges::fill(curve, T(0));
  }
};

}  // namespace drumhead::grid
