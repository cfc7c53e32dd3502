#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <set>

#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "oracle/occt_model.hpp"
#include "support/own_files.hpp"

namespace knead::oracle {

namespace fs = std::filesystem;

/// The records of a file, without the ";" that ends them.
inline std::multiset<std::string> records_of(const std::string& text) {
  std::multiset<std::string> result;
  std::size_t begin = 0;
  for (std::size_t at = text.find(";\n"); at != std::string::npos; at = text.find(";\n", begin)) {
    result.insert(text.substr(begin, at - begin));
    begin = at + 2;
  }
  return result;
}

/// One STEP file, and what Open CASCADE makes of it.
class StepOracle : public testing::FileTest {
 protected:
  void SetUp() override {
    KNEAD_NEEDS(path_);
    auto read = step::File::read(path_);
    ASSERT_TRUE(read) << read.error().message();
    file_ = std::make_unique<step::File>(*std::move(read));
    directory_ = fs::temp_directory_path() / ("knead-oracle-" + std::to_string(getpid()));
    fs::create_directories(directory_);
    if (file_->bytes().find("&SCOPE") != std::string::npos) {
      // It may abort there; then there is no second opinion.
      const auto child = fork();
      if (child == 0) {
        static_cast<void>(freopen("/dev/null", "w", stderr));
        static_cast<void>(occt_read(path_, "mm"));
        _exit(0);
      }
      int status = 0;
      waitpid(child, &status, 0);
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        GTEST_SKIP() << "Open CASCADE aborts on &SCOPE; nothing is left to compare";
    }
    before_ = occt_read(path_, file_->model().length_unit());
    ASSERT_TRUE(before_);
  }
  void TearDown() override {
    if (!directory_.empty()) fs::remove_all(directory_);
  }

  OcctModel read_written(const Expected<std::string>& bytes) {
    EXPECT_TRUE(bytes) << bytes.error().message();
    if (!bytes) return {};
    const auto path = directory_ / path_.filename();
    EXPECT_TRUE(write_file_atomically(path, *bytes));
    auto model = occt_read(path, file_->model().length_unit());
    EXPECT_TRUE(model);
    return model.value_or(OcctModel{});
  }

  std::unique_ptr<step::File> file_;
  fs::path directory_;
  std::optional<OcctModel> before_;
};

}  // namespace knead::oracle
