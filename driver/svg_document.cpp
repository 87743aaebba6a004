// SPDX-License-Identifier: MIT
#include "svg_document.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "svg_text.h"

namespace drumhead::driver {
namespace {

/// Drawings are read by recursion; programs that write them nest a few dozen elements.
struct Depth : pugi::xml_tree_walker {
  static constexpr int kMost = 1000;
  bool for_each(pugi::xml_node&) override { return depth() < kMost; }
};

}  // namespace

SvgDocument::SvgDocument(std::filesystem::path file) : file_(std::move(file)) {
  std::ifstream stream(file_, std::ios::binary);
  std::ostringstream text;
  std::error_code error;
  if (!std::filesystem::exists(file_, error))
    throw std::invalid_argument(file_.string() + ": cannot be read: no such file");
  if (!stream || std::filesystem::is_directory(file_, error))
    throw std::invalid_argument(file_.string() + ": cannot be read: no file, or not permitted");
  text << stream.rdbuf();
  text_ = text.str();
  const auto result =
      xml_.load_buffer(text_.data(), text_.size(), pugi::parse_full | pugi::parse_ws_pcdata);
  if (!result) {
    throw std::invalid_argument(at_line(result.offset) +
                                ": is not well-formed XML: " + result.description());
  }
  if (Depth depth; !xml_.traverse(depth))
    throw std::invalid_argument(file_.string() + ": elements are nested deeper than " +
                                std::to_string(Depth::kMost));
  root_ = xml_.document_element();
  if (kind(root_) != "svg") throw std::invalid_argument(file_.string() + ": is not an SVG drawing");
}

std::optional<SvgView> SvgDocument::view() const {
  if (const auto box = root_.attribute("viewBox")) {
    const auto numbers = svg_numbers(box.value());
    if (!numbers || numbers->size() != 4 || (*numbers)[2] <= 0 || (*numbers)[3] <= 0) {
      fail(root_,
           std::string("viewBox '") + box.value() + "' must be four numbers, the last two above 0");
    }
    return SvgView{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  }
  SvgView view;
  for (const auto& [name, size] : {std::pair{"width", &view.width}, {"height", &view.height}}) {
    const std::string_view text = root_.attribute(name).value();
    if (trimmed(text).empty() || trimmed(text).ends_with('%') || text == "auto")
      return std::nullopt;
    const auto length = svg_length(text, 0.0);
    if (!length || *length <= 0) {
      fail(root_, std::string(name) + " '" + std::string(text) + "' must be a length above 0");
    }
    *size = *length;
  }
  return view;
}

std::string SvgDocument::place(pugi::xml_node element) const {
  return at_line(element.offset_debug());
}

std::string SvgDocument::at_line(std::ptrdiff_t offset) const {
  const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
  return file_.string() + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n'));
}

void SvgDocument::fail(pugi::xml_node element, const std::string& what) const {
  throw std::invalid_argument(named_place(element) + ": " + what);
}

std::string SvgDocument::named_place(pugi::xml_node element) const {
  const std::string name = name_of(element);
  return place(element) + ": " + std::string(kind(element)) +
         (name.empty() ? "" : " '" + name + "'");
}

void SvgDocument::save(const std::filesystem::path& file) const {
  if (!xml_.save_file(file.c_str(), "", pugi::format_raw)) {
    throw std::runtime_error(file.string() + ": cannot be written");
  }
}

pugi::xml_node SvgDocument::by_id(std::string_view id) const {
  return root_.find_node([&](pugi::xml_node node) { return node.attribute("id").value() == id; });
}

std::string_view kind(pugi::xml_node element) {
  if (element.type() != pugi::node_element) return {};
  const std::string_view name = element.name();
  return name.substr(name.find(':') + 1);  // find gives npos = -1 where there is no prefix
}

bool is_group(std::string_view kind) { return kind == "g" || kind == "a" || kind == "switch"; }

std::string name_of(pugi::xml_node element) {
  for (const char* attribute : {"inkscape:label", "data-name", "serif:id", "id"}) {
    const std::string_view name = trimmed(element.attribute(attribute).value());
    if (!name.empty()) return std::string(name);
  }
  return {};
}

}  // namespace drumhead::driver
