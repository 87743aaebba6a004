// SPDX-License-Identifier: MIT
#pragma once
// The values of SVG attributes: words, numbers, lengths with units.
#include <optional>
#include <string_view>
#include <vector>

namespace drumhead::driver {

/// Without the white space of XML and CSS around it.
std::string_view trimmed(std::string_view text);

/// Takes a number off the front; nothing, and nothing taken, where there is none.
std::optional<double> take_number(std::string_view& text);

/// Takes white space and at most one comma off the front.
void skip_separator(std::string_view& text);

/// The words of a text that white space parts.
std::vector<std::string_view> words(std::string_view text);

/// A number or a length of SVG in user units: px, mm, cm, in, pt, pc, Q at 96 to the inch, or % of
/// `whole`. Nothing if it is none of these.
std::optional<double> svg_length(std::string_view text, double whole);

/// Numbers separated by white space and at most one comma each; nothing if anything else is among
/// them.
std::optional<std::vector<double>> svg_numbers(std::string_view text);

}  // namespace drumhead::driver
