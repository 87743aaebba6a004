// SPDX-License-Identifier: MIT
#pragma once
// The library's version; CMakeLists.txt reads it here. Before 1.0 a minor version may change an
// interface.

#define DRUMHEAD_VERSION "0.1.0"
/// major·10000 + minor·100 + patch
#define DRUMHEAD_VERSION_NUMBER 100
