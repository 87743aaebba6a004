// SPDX-License-Identifier: MIT
#include "atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace drumhead::driver {
namespace {

namespace fs = std::filesystem;

// What a signal handler may read: plain memory, changed only while `used` is 0.
struct Slot {
  volatile std::sig_atomic_t used = 0;
  char path[4096] = {};
};
std::array<Slot, 16> slots;

void remember(const fs::path& path) {
  for (Slot& slot : slots) {
    if (slot.used || path.native().size() >= sizeof slot.path) continue;
    std::strcpy(slot.path, path.c_str());
    slot.used = 1;
    return;
  }
}

void forget(const fs::path& path) {
  for (Slot& slot : slots) {
    if (slot.used && path == slot.path) slot.used = 0;
  }
}

extern "C" void remove_temporaries(int signal) {
  for (const Slot& slot : slots) {
    if (slot.used) unlink(slot.path);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::string reason() { return std::strerror(errno); }

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) {
  const auto fail = [&](const std::string& why) {
    throw std::invalid_argument(target.string() + ": cannot be written: " + why);
  };
  std::error_code ignored;
  // A link stays a link: the file that it names is replaced.
  target_ = fs::is_symlink(target, ignored) ? fs::weakly_canonical(target, ignored) : target;
  if (fs::exists(target_, ignored)) {
    if (!fs::is_regular_file(target_, ignored)) fail("not a regular file");
    if (access(target_.c_str(), W_OK) != 0) fail(reason());
  }
  const std::string extension = target_.extension();
  std::string name = ".";
  name += target_.stem().string() + ".XXXXXX" + extension;
  name = (target_.parent_path() / name).string();
  const int file = mkstemps(name.data(), int(extension.size()));
  if (file < 0) fail(reason());
  close(file);
  temporary_ = name;
  remember(temporary_);
}

AtomicFile::~AtomicFile() {
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  forget(temporary_);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})) {}

void AtomicFile::commit() {
  struct stat old {};
  const mode_t mask = umask(0);
  umask(mask);
  chmod(temporary_.c_str(), stat(target_.c_str(), &old) == 0 ? old.st_mode & 07777 : 0666 & ~mask);
  if (rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw std::runtime_error(target_.string() + ": cannot be written: " + reason());
  }
  forget(temporary_);
  temporary_.clear();
}

void remove_temporaries_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, remove_temporaries);
}

}  // namespace drumhead::driver
