// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <utility>

#include "atomic_file.h"
#include "driver_scratch.h"

namespace drumhead::driver {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::FILE* stream = std::fopen(file.c_str(), "w");
  ASSERT_NE(stream, nullptr);
  std::fputs(text.c_str(), stream);
  std::fclose(stream);
}

TEST(DriverAtomicFile, AppearsWithItsWholeContentWhenCommitted) {
  const Scratch scratch;
  AtomicFile file(scratch / "a.png");
  write(file.temporary(), "new");
  EXPECT_FALSE(fs::exists(scratch / "a.png"));
  EXPECT_EQ(file.temporary().extension(), ".png");
  EXPECT_EQ(file.temporary().parent_path(), scratch.folder());
  file.commit();
  EXPECT_EQ(read_text(scratch / "a.png"), "new");
  EXPECT_EQ(scratch.files(), std::vector<std::string>{"a.png"});
}

TEST(DriverAtomicFile, LeavesNothingWhenItIsNotCommitted) {
  const Scratch scratch;
  scratch.write("a.png", "old");
  {
    AtomicFile file(scratch / "a.png");
    write(file.temporary(), "new");
    const AtomicFile moved(std::move(file));
  }
  EXPECT_EQ(scratch.files(), std::vector<std::string>{"a.png"});
  EXPECT_EQ(read_text(scratch / "a.png"), "old");
}

TEST(DriverAtomicFile, KeepsThePermissionsAndTheLinkOfWhatItReplaces) {
  const Scratch scratch;
  scratch.write("a.png", "old");
  fs::permissions(scratch / "a.png", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a.png", scratch / "link.png");
  AtomicFile file(scratch / "link.png");
  write(file.temporary(), "new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(scratch / "link.png"));
  EXPECT_EQ(read_text(scratch / "a.png"), "new");
  EXPECT_EQ(fs::status(scratch / "a.png").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST(DriverAtomicFile, ANewFileIsReadableAsTheUserWants) {
  const Scratch scratch;
  AtomicFile file(scratch / "a.png");
  file.commit();
  scratch.write("b.png", "");
  EXPECT_EQ(fs::status(scratch / "a.png").permissions(),
            fs::status(scratch / "b.png").permissions());
}

TEST(DriverAtomicFile, RefusesWhatCannotBeWrittenAtOnce) {
  const Scratch scratch;
  EXPECT_NE(message_of([&] { AtomicFile(scratch / "none" / "a.png"); }).find("none/a.png: cannot"),
            std::string::npos);
  EXPECT_NE(message_of([&] { AtomicFile file(scratch.folder()); }).find("not a regular file"),
            std::string::npos);
}

}  // namespace
}  // namespace drumhead::driver
