// SPDX-License-Identifier: MIT
#pragma once
// An SVG file as drawing programs save it: elements, their names and places for errors, and the
// view box that is stretched onto the picture.
#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace drumhead::driver {

/// The rectangle of user units that is stretched onto the picture.
struct SvgView {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

class SvgDocument {
 public:
  /// Throws std::invalid_argument naming the file, and the line where its XML is broken.
  explicit SvgDocument(std::filesystem::path file);

  const std::filesystem::path& file() const { return file_; }
  pugi::xml_node root() const { return root_; }

  /// viewBox, else width and height where both are lengths; nothing where the drawing has no size
  /// of its own, so that its user units are picture pixels. Throws where they are broken or not
  /// above 0.
  std::optional<SvgView> view() const;

  /// Throws std::invalid_argument "file:line: path 'name': what".
  [[noreturn]] void fail(pugi::xml_node element, const std::string& what) const;

  /// "file:line"
  std::string place(pugi::xml_node element) const;

  /// "file:line: path 'name'"
  std::string named_place(pugi::xml_node element) const;

  /// Writes the document with whatever was changed in it. Throws std::runtime_error if that fails.
  void save(const std::filesystem::path& file) const;

  /// The element with this id; a null node if there is none.
  pugi::xml_node by_id(std::string_view id) const;

 private:
  std::string at_line(std::ptrdiff_t offset) const;

  std::filesystem::path file_;
  std::string text_;
  pugi::xml_document xml_;
  pugi::xml_node root_;
};

/// "path" for <path> and <svg:path>; empty for what is no element.
std::string_view kind(pugi::xml_node element);

/// "g", "a" or "switch": what only holds others and moves them.
bool is_group(std::string_view kind);

/// inkscape:label, else data-name or serif:id (Illustrator's and Affinity's name where they had to
/// change the id), else id; trimmed.
std::string name_of(pugi::xml_node element);

}  // namespace drumhead::driver
