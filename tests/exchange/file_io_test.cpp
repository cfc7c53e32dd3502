#include "knead/exchange/file_io.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

namespace {

/// Which call of the system fails next, as a full or broken disk would have it.
enum class Fault { none, write, half_write, flush, rename, killed };
Fault fault = Fault::none;

}  // namespace

// These take the place of the C library's in this program.
extern "C" {
ssize_t write(int fd, const void* bytes, std::size_t count) {
  if (fault == Fault::write || (fault == Fault::half_write && count < 1000)) {
    errno = ENOSPC;
    return -1;
  }
  if (fault == Fault::half_write || fault == Fault::killed) count /= 2;
  const auto result = syscall(SYS_write, fd, bytes, count);
  if (fault == Fault::killed) _exit(9);
  return result;
}
int fsync(int fd) {
  if (fault != Fault::flush) return static_cast<int>(syscall(SYS_fsync, fd));
  errno = EIO;
  return -1;
}
int rename(const char* from, const char* to) noexcept {
  if (fault != Fault::rename) return static_cast<int>(syscall(SYS_rename, from, to));
  errno = EACCES;
  return -1;
}
}

namespace knead {
namespace {

namespace fs = std::filesystem;

class FileIo : public ::testing::Test {
 protected:
  FileIo() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    directory_ = fs::temp_directory_path() /
                 ("knead-file-io-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(directory_);
    fs::create_directories(directory_);
  }
  ~FileIo() override {
    fault = Fault::none;
    std::error_code ignored;
    fs::permissions(directory_, fs::perms::owner_all, ignored);
    fs::remove_all(directory_, ignored);
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
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
  EXPECT_EQ(fs::status(path).permissions(),
            fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
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
  EXPECT_FALSE(write_file_atomically(directory_ / std::string(256, 'x'), "1"));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(FileIo, ADiskThatFailsLeavesTheOldFileAndNothingElse) {
  const auto path = directory_ / "x.step";
  const std::string old(5000, 'o');
  ASSERT_TRUE(write_file_atomically(path, old));
  for (const Fault each : {Fault::write, Fault::half_write, Fault::flush, Fault::rename}) {
    fault = each;
    const auto result = write_file_atomically(path, std::string(5000, 'n'));
    fault = Fault::none;
    ASSERT_FALSE(result) << static_cast<int>(each);
    EXPECT_EQ(result.error().file, path.string());
    EXPECT_EQ(read_file(path), old);
    EXPECT_EQ(entries(), 1U) << static_cast<int>(each);
  }
}

TEST_F(FileIo, WhatAKilledProcessLeftIsRemovedByTheNextAndNothingElseIs) {
  const auto path = directory_ / "x.step";
  ASSERT_TRUE(write_file_atomically(path, "old"));
  const pid_t child = fork();
  if (child == 0) {
    fault = Fault::killed;
    static_cast<void>(write_file_atomically(path, std::string(5000, 'n')));
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(WEXITSTATUS(status), 9);
  EXPECT_EQ(read_file(path), "old");
  ASSERT_EQ(entries(), 2U) << "the temporary file of the dead process";
  ASSERT_TRUE(write_file_atomically(directory_ / ".knead-notes", "mine"));
  ASSERT_TRUE(write_file_atomically(path, "new"));
  EXPECT_EQ(read_file(path), "new");
  EXPECT_EQ(read_file(directory_ / ".knead-notes"), "mine");
  EXPECT_EQ(entries(), 2U);
}

TEST_F(FileIo, WritersAtTheSameTimeDoNotTakeEachOtherForDead) {
  std::vector<std::thread> writers;
  std::vector<int> failed(4);
  for (std::size_t k = 0; k < failed.size(); ++k) {
    writers.emplace_back([&, k] {
      for (int round = 0; round < 50; ++round) {
        failed[k] +=
            !write_file_atomically(directory_ / std::to_string(k), std::string(100000, 'a'));
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failed, std::vector<int>(4));
  EXPECT_EQ(entries(), 4U);
}

TEST_F(FileIo, AProtectedFileIsNotReplaced) {
  const auto path = directory_ / "x.step";
  ASSERT_TRUE(write_file_atomically(path, "1"));
  fs::permissions(path, fs::perms::owner_read);
  for (const auto& status : {check_writable(path), write_file_atomically(path, "2")}) {
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message().find("may not be written to"), std::string::npos)
        << status.error().message();
  }
  EXPECT_EQ(read_file(path), "1");
}

TEST_F(FileIo, ALinkToNothingIsFollowedAndOneInACircleIsAnError) {
  fs::create_directory(directory_ / "there");
  fs::create_symlink("there/x.step", directory_ / "link");
  fs::create_symlink("link", directory_ / "outer");
  ASSERT_TRUE(write_file_atomically(directory_ / "outer", "1"));
  EXPECT_TRUE(fs::is_symlink(directory_ / "link"));
  EXPECT_TRUE(fs::is_symlink(directory_ / "outer"));
  EXPECT_EQ(read_file(directory_ / "there/x.step"), "1");
  fs::create_symlink("circle", directory_ / "circle");
  EXPECT_FALSE(write_file_atomically(directory_ / "circle", "1"));
}

TEST_F(FileIo, TheLongestNameCanBeWritten) {
  const std::string name(255, 'x');
  ASSERT_TRUE(write_file_atomically(directory_ / name, "1"));
  EXPECT_EQ(read_file(directory_ / name), "1");
}

TEST_F(FileIo, APipeIsReadAsSoonAsSomebodyWritesAndNotWaitedForForever) {
  const auto pipe = directory_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto start = std::chrono::steady_clock::now();
  const auto nobody = read_file(pipe);
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().what.find("nothing writes"), std::string::npos)
      << nobody.error().message();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  const std::string bytes(300000, 'p');
  std::thread writer([&] {
    const int fd = ::open(pipe.c_str(), O_WRONLY);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    for (std::size_t at = 0; at < bytes.size();)
      at += static_cast<std::size_t>(::write(fd, &bytes[at], 30000));
    ::close(fd);
  });
  EXPECT_EQ(read_file(pipe), bytes);
  writer.join();
}

TEST_F(FileIo, AFileThatIsTooLargeIsRefusedBeforeItIsRead) {
  ASSERT_TRUE(write_file_atomically(directory_ / "x", std::string(1001, 'x')));
  EXPECT_TRUE(read_file(directory_ / "x", 1001));
  EXPECT_FALSE(read_file(directory_ / "x", 1000));
  const auto endless = read_file("/dev/zero", 1 << 20);
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().what.find("more than 1 MiB"), std::string::npos)
      << endless.error().message();
  fs::resize_file(directory_ / "x", std::uintmax_t{1} << 40);  // sparse
  EXPECT_FALSE(read_file(directory_ / "x"));
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
