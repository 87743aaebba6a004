// SPDX-License-Identifier: MIT
#pragma once
// An array of VTK's XML files in their "binary" format: base64 of the number of bytes and the
// values.
#include <OpenImageIO/strutil.h>
#include <drumhead/kernels/version.h>
#include <bit>
#include <cstdint>
#include <ostream>
#include <string>
#include <type_traits>

namespace drumhead::driver {

/// T: double, std::int64_t or std::uint8_t. Whole with its destruction.
template <class T>
class VtkArray {
 public:
  VtkArray(std::ostream& stream, const std::string& name, int components, std::size_t values)
      : stream_(stream) {
    stream_ << "<DataArray type=\"" << type() << "\" Name=\"" << name << "\" NumberOfComponents=\""
            << components << "\" format=\"binary\">";
    const std::uint64_t bytes = values * sizeof(T);
    append(&bytes, sizeof bytes);
  }
  ~VtkArray() { stream_ << OIIO::Strutil::base64_encode(pending_) << "</DataArray>\n"; }
  VtkArray(const VtkArray&) = delete;
  VtkArray& operator=(const VtkArray&) = delete;

  void add(T value) { append(&value, sizeof value); }

 private:
  static const char* type() {
    if constexpr (sizeof(T) == 1) return "UInt8";
    return std::is_floating_point_v<T> ? "Float64" : "Int64";
  }
  void append(const void* bytes, std::size_t count) {
    constexpr std::size_t kGroups = 3 * 8192;  // of three bytes, which are four letters
    pending_.append(static_cast<const char*>(bytes), count);
    if (pending_.size() < kGroups) return;
    stream_ << OIIO::Strutil::base64_encode(OIIO::string_view(pending_.data(), kGroups));
    pending_.erase(0, kGroups);
  }

  std::ostream& stream_;
  std::string pending_;
};

/// The first lines of a VTK XML file of picture pixels, up to the element `type`, which is open.
inline void begin_vtk(std::ostream& stream, const char* type) {
  stream << "<?xml version=\"1.0\"?>\n<!-- drumhead " DRUMHEAD_VERSION
            ": picture pixels, x right, y down, 0 at the left and top edge -->\n"
         << "<VTKFile type=\"" << type << "\" version=\"1.0\" byte_order=\""
         << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
         << "\" header_type=\"UInt64\">\n";
}

}  // namespace drumhead::driver
