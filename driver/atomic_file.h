// SPDX-License-Identifier: MIT
#pragma once
// Outputs appear whole or not at all: each is written to a temporary file in its own folder and
// renamed at the end. Creating that file before the work starts also proves that the output can be
// written.
#include <filesystem>

namespace drumhead::driver {

class AtomicFile {
 public:
  /// Creates an empty temporary file beside `target`, with its extension. Throws
  /// std::invalid_argument naming `target` and the reason where it cannot be written or is not a
  /// regular file.
  explicit AtomicFile(const std::filesystem::path& target);
  /// Removes the temporary file if it was not committed.
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }

  /// Renames the temporary file to `target`, with the permissions of the file that it replaces or
  /// those of a new one. Throws std::runtime_error naming `target`.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

/// From here on SIGINT, SIGTERM and SIGHUP remove all temporary files before they end the program.
void remove_temporaries_on_signals();

}  // namespace drumhead::driver
