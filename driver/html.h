// SPDX-License-Identifier: MIT
#pragma once
// Pieces of self-contained HTML pages: safe text, embedded pictures, templates.
#include <map>
#include <string>
#include <string_view>

namespace drumhead::html {

/// Text that may stand in HTML and SVG, between tags and in attributes: &, <, > and quotes as
/// character references.
std::string escaped(std::string_view text);

/// Bytes of a PNG file as the address of a picture.
std::string data_uri(std::string_view png);

/// The template with each {{key}} replaced by its value, which is not looked at again. Throws
/// std::out_of_range where a key has no value.
std::string filled(std::string_view text, const std::map<std::string, std::string>& values);

}  // namespace drumhead::html
