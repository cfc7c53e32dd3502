#include "knead/image_file.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <jpeglib.h>

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
                       (std::string("knead_image_") +
                        ::testing::UnitTest::GetInstance()->current_test_info()->name()))
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

/// A PNG of these bytes by libpng; `type` and `depth` as in its header.
std::string png_with(int width, int height, int type, int depth, std::vector<unsigned char> bytes) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth,
               type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[] = {{255, 0, 0}, {0, 0, 255}};
  if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
  png_write_info(png, info);
  const std::size_t row = bytes.size() / static_cast<std::size_t>(height);
  for (int y = 0; y < height; ++y)
    png_write_row(png, bytes.data() + static_cast<std::size_t>(y) * row);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

TEST_F(ImageFile, SixteenBitsKeepTheirDigits) {
  const auto read =
      cli::read_image(write(png_with(2, 1, PNG_COLOR_TYPE_GRAY, 16, {0x12, 0x34, 0xff, 0xff})));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->width, 2);
  EXPECT_EQ(read->values, (std::vector<double>{0x1234 / 65535.0, 1}));
}

TEST_F(ImageFile, ColoursAreTheirLumaOrOneOfThem) {
  const std::string path = write(png_with(1, 2, PNG_COLOR_TYPE_RGB, 8, {255, 51, 0, 0, 0, 102}));
  const auto grey = cli::read_image(path), red = cli::read_image(path, ImageChannel::red);
  ASSERT_TRUE(grey && red);
  EXPECT_EQ(grey->height, 2);
  EXPECT_NEAR(grey->values[0], 0.2125 + 0.2 * 0.7154, 1e-15);
  EXPECT_NEAR(grey->values[1], 0.4 * 0.0721, 1e-15);
  EXPECT_EQ(red->values, (std::vector<double>{1, 0}));
  EXPECT_EQ(cli::read_image(path, ImageChannel::green)->values[0], 0.2);
  EXPECT_EQ(cli::read_image(path, ImageChannel::blue)->values[1], 0.4);
  const auto palette =
      cli::read_image(write(png_with(2, 1, PNG_COLOR_TYPE_PALETTE, 8, {1, 0})), ImageChannel::blue);
  ASSERT_TRUE(palette) << palette.error().message();
  EXPECT_EQ(palette->values, (std::vector<double>{1, 0}));
  const auto transparent =
      cli::read_image(write(png_with(1, 1, PNG_COLOR_TYPE_RGBA, 8, {0, 0, 0, 51})));
  ASSERT_TRUE(transparent) << transparent.error().message();
  EXPECT_NEAR(transparent->values[0], 0.8, 1e-15);
}

TEST_F(ImageFile, AJpegIsReadWithinItsLosses) {
  jpeg_compress_struct state{};
  jpeg_error_mgr failure{};
  state.err = jpeg_std_error(&failure);
  jpeg_create_compress(&state);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&state, &bytes, &size);
  state.image_width = 32;
  state.image_height = 16;
  state.input_components = 3;
  state.in_color_space = JCS_RGB;
  jpeg_set_defaults(&state);
  jpeg_set_quality(&state, 95, TRUE);
  jpeg_start_compress(&state, TRUE);
  std::vector<unsigned char> row;
  for (int x = 0; x < 32; ++x) row.insert(row.end(), {200, 100, 50});
  for (int y = 0; y < 16; ++y) {
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&state, &line, 1);
  }
  jpeg_finish_compress(&state);
  const std::string path = write({reinterpret_cast<char*>(bytes), size});
  jpeg_destroy_compress(&state);
  std::free(bytes);
  const auto grey = cli::read_image(path), blue = cli::read_image(path, ImageChannel::blue);
  ASSERT_TRUE(grey && blue);
  EXPECT_EQ(grey->width, 32);
  EXPECT_EQ(grey->height, 16);
  for (const double x : grey->values)
    EXPECT_NEAR(x, (200 * 0.2125 + 100 * 0.7154 + 50 * 0.0721) / 255, 0.02);
  for (const double x : blue->values) EXPECT_NEAR(x, 50 / 255.0, 0.02);
}

TEST_F(ImageFile, DamagedFilesAreRefusedOrRead) {
  const std::string good = *cli::png_of(steps());
  std::mt19937_64 random(2);
  int refused = 0;
  for (int k = 0; k < 400; ++k) {
    std::string bad = good;
    if (k % 2 == 0) bad.resize(random() % bad.size());
    for (int change = 0; change < 3 && !bad.empty(); ++change)
      bad[random() % bad.size()] = static_cast<char>(random());
    const auto read = cli::read_image(write(bad));
    if (read) {
      EXPECT_EQ(read->values.size(),
                static_cast<std::size_t>(read->width) * static_cast<std::size_t>(read->height));
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
