// SPDX-License-Identifier: MIT
#pragma once
// The report as a page: one HTML file with everything in it that loads nothing. Its text is
// page.html, compiled in; what stands there in {{…}} is filled in here.
#include <string>

#include "pictures.h"

namespace drumhead::driver {

/// The page of a run: `report` as report_json made it, `title` the picture's name.
std::string page_html(const std::string& title, const std::string& report,
                      const PagePictures& pictures);

}  // namespace drumhead::driver
