#include "knead/exchange/file_io.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace knead {
namespace {

namespace fs = std::filesystem;

class FileIo : public ::testing::Test {
 protected:
  FileIo() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    directory_ = fs::temp_directory_path() / ("knead-file-io-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(directory_);
    fs::create_directories(directory_);
  }
  ~FileIo() override {
    std::error_code ignored;
    fs::permissions(directory_, fs::perms::owner_all, ignored);
    fs::remove_all(directory_, ignored);
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }
  fs::path directory_;
};

TEST_F(FileIo, WhatIsWrittenIsRead) {
  const std::string bytes("a\0b\r\n\xFF", 6);
  ASSERT_TRUE(write_file_atomically(directory_ / "x.step", bytes));
  EXPECT_EQ(read_file(directory_ / "x.step"), bytes);
  ASSERT_TRUE(write_file_atomically(directory_ / "x.step", ""));
  EXPECT_EQ(read_file(directory_ / "x.step"), "");
  EXPECT_EQ(entries(), 1U) << "no temporary file is left";
}

TEST_F(FileIo, TheFileThatIsReplacedKeepsItsPermissions) {
  const auto path = directory_ / "x.step";
  ASSERT_TRUE(write_file_atomically(path, "1"));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  ASSERT_TRUE(write_file_atomically(path, "2"));
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
}

TEST_F(FileIo, ALinkIsWrittenThrough) {
  ASSERT_TRUE(write_file_atomically(directory_ / "x.step", "1"));
  fs::create_symlink("x.step", directory_ / "link.step");
  ASSERT_TRUE(write_file_atomically(directory_ / "link.step", "2"));
  EXPECT_TRUE(fs::is_symlink(directory_ / "link.step"));
  EXPECT_EQ(read_file(directory_ / "x.step"), "2");
}

TEST_F(FileIo, AFailureLeavesNothingBehind) {
  const auto missing = write_file_atomically(directory_ / "no/such/x.step", "1");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::input);
  EXPECT_EQ(missing.error().file, (directory_ / "no/such/x.step").string());
  fs::create_directory(directory_ / "d");
  EXPECT_FALSE(write_file_atomically(directory_ / "d", "1"));
  EXPECT_FALSE(write_file_atomically(directory_ / std::string(300, 'x'), "1"));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(FileIo, WhatCannotBeReadIsAnError) {
  const auto missing = read_file(directory_ / "x.step");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::input);
  EXPECT_NE(missing.error().message().find("x.step"), std::string::npos);
  EXPECT_FALSE(read_file(directory_));
}

}  // namespace
}  // namespace knead
