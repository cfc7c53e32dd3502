#include "knead/image_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace knead {
namespace {

/// A file in the temporary directory that goes with the test.
class ImageFile : public ::testing::Test {
 protected:
  std::string write(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return path_;
  }
  void TearDown() override { std::filesystem::remove(path_); }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() /
                       (std::string("knead_image_") + ::testing::UnitTest::GetInstance()->current_test_info()->name()))
                          .string();
};

Image steps() {
  Image image{16, 16, {}};
  for (int k = 0; k < 256; ++k) image.values.push_back(k / 255.0);
  return image;
}

TEST_F(ImageFile, APngComesBackAsItWasWritten) {
  const auto bytes = cli::png_of(steps());
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto read = cli::read_image(write(*bytes));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(*read, steps());
}

TEST_F(ImageFile, DamagedFilesAreRefusedOrRead) {
  const std::string good = *cli::png_of(steps());
  std::mt19937_64 random(2);
  int refused = 0;
  for (int k = 0; k < 400; ++k) {
    std::string bad = good;
    if (k % 2 == 0) bad.resize(random() % bad.size());
    for (int change = 0; change < 3 && !bad.empty(); ++change) bad[random() % bad.size()] = static_cast<char>(random());
    const auto read = cli::read_image(write(bad));
    if (read) {
      EXPECT_EQ(read->values.size(), static_cast<std::size_t>(read->width) * static_cast<std::size_t>(read->height));
    } else {
      EXPECT_FALSE(read.error().what.empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_FALSE(cli::read_image(write("ISO-10303-21;")));
  EXPECT_FALSE(cli::read_image(write(std::string("\xff\xd8\xff\xe0garbage"))));
}

}  // namespace
}  // namespace knead
