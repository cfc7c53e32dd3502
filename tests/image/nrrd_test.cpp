#include "knead/image/volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

namespace knead {
namespace {

namespace fs = std::filesystem;

std::string header(const std::string& type, const std::string& more = "",
                   const std::string& version = "NRRD0004") {
  return version + "\n# made by a test\ntype: " + type +
         "\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n" + more;
}

/// Values as bytes, the least first or last.
template <class T>
std::string bytes_of(const std::vector<T>& values, bool big) {
  std::string bytes;
  for (const T value : values) {
    char one[sizeof(T)];
    std::memcpy(one, &value, sizeof(T));
    if (big != (std::endian::native == std::endian::big)) std::ranges::reverse(one);
    bytes.append(one, sizeof(T));
  }
  return bytes;
}

Expected<VolumeImage> read(const std::string& file) {
  const auto header = parse_nrrd_header(file, "v.nrrd");
  if (!header) return std::unexpected(header.error());
  return nrrd_volume(*header, std::string_view(file).substr(header->data_at));
}

std::string refused(const std::string& file) {
  const auto volume = read(file);
  return volume ? "accepted" : volume.error().message();
}

template <class T>
void check_type(const std::string& name) {
  const T low = std::numeric_limits<T>::lowest(), high = std::numeric_limits<T>::max();
  const std::vector<T> values = {
      0, 1, 2, 3, 100, 101, static_cast<T>(low / 2), static_cast<T>(high / 2), low, high, 7, 8};
  for (const bool big : {false, true}) {
    const auto volume =
        read(header(name, big ? "endian: big\n\n" : "endian: little\n\n") + bytes_of(values, big));
    ASSERT_TRUE(volume) << name << " " << volume.error().message();
    EXPECT_EQ(volume->size, (std::array<int, 3>{3, 2, 2}));
    for (std::size_t k = 0; k < 12; ++k)
      EXPECT_EQ(volume->values[k], static_cast<double>(values[k])) << name;
    EXPECT_EQ(volume->at(1, 0, 1),
              static_cast<double>(values[7]));  // the first axis is the fastest
  }
}

TEST(Nrrd, NumbersOfEveryTypeAndByteOrderComeOutAsTheyWentIn) {
  for (const char* name : {"signed char", "int8", "int8_t"}) check_type<std::int8_t>(name);
  for (const char* name : {"uchar", "unsigned char", "uint8", "uint8_t"})
    check_type<std::uint8_t>(name);
  for (const char* name : {"short", "signed short int", "int16"}) check_type<std::int16_t>(name);
  for (const char* name : {"ushort", "unsigned short", "uint16_t"}) check_type<std::uint16_t>(name);
  for (const char* name : {"int", "int32"}) check_type<std::int32_t>(name);
  for (const char* name : {"uint", "unsigned int", "uint32"}) check_type<std::uint32_t>(name);
  check_type<float>("float");
  check_type<double>("double");
}

TEST(Nrrd, LargeIntegersThatNoDoubleHoldsAreRefused) {
  const std::vector<std::int64_t> values = {0, 1, 2, -5, 1LL << 53, 5, 6, 7, 8, 9, 10, 11};
  const auto volume = read(header("int64", "endian: little\n\n") + bytes_of(values, false));
  ASSERT_TRUE(volume);
  EXPECT_EQ(volume->values[4], 9007199254740992.0);
  std::vector<std::int64_t> more = values;
  more[3] = (1LL << 54) + 2;
  EXPECT_NE(
      refused(header("longlong", "endian: little\n\n") + bytes_of(more, false)).find("voxel 3"),
      std::string::npos);
}

const std::string data(12, '\5');

TEST(Nrrd, VoxelsStandWhereTheHeaderPutsThem) {
  const auto frame = [](const std::string& fields, const std::string& version = "NRRD0005") {
    const auto volume = read(header("uint8", fields + "\n", version) + data);
    EXPECT_TRUE(volume) << volume.error().message();
    return volume ? volume->frame : VolumeFrame{};
  };
  EXPECT_EQ(frame("", "NRRD0001"), VolumeFrame{});
  VolumeFrame wanted;
  wanted.directions.diagonal() << 0.5, 1, 2;
  EXPECT_EQ(frame("spacings: 0.5 1 2\n"), wanted);
  wanted.origin << 10.25, -3, 2;
  EXPECT_EQ(frame("spacings: 0.5 1 2\naxis mins: 10 -3 1\ncenters: cell node cell\n"), wanted);
  wanted.directions.col(0) << 0.5, 0.1, 0;
  wanted.directions.col(2) << 0, -0.3, 2;
  EXPECT_EQ(
      frame(
          "space: left-posterior-superior\r\nspace directions: (0.5,0.1,0) (0, 1, 0) (0,-0.3,2)\r\n"
          "space origin: (10.25,-3,2)\r\nkinds: domain domain domain\nkey:=value: 3\n"),
      wanted);
}

TEST(Nrrd, WhatIsWrittenComesBack) {
  VolumeImage mask{{3, 2, 2}, {0, 1, 0, 1, 1, 1, 0, 0, 1, 255, 0, 7}, {}};
  mask.frame.origin << 0.1, 0.2, 0.3;
  mask.frame.directions << 0.5, 0.1, 0, 0, 1, 1.0 / 3, 0, 0, 2;
  const std::string bytes = nrrd_bytes(mask, "right-anterior-superior");
  EXPECT_TRUE(is_nrrd(bytes));
  const auto again = read(bytes);
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(*again, mask);
  EXPECT_EQ(parse_nrrd_header(bytes)->space, "right-anterior-superior");
}

class NrrdFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override { fs::remove_all(directory_); }
  std::string write(const std::string& name, const std::string& bytes) {
    const fs::path path = directory_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

 private:
  fs::path directory_ =
      fs::temp_directory_path() / (std::string("knead_nrrd_") +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(NrrdFiles, DetachedHeadersFindTheirDataBesideThem) {
  write("v.raw", "two\nlines\nabc" + data);
  const auto at = [&](const std::string& fields) {
    const auto file = read_nrrd(write("v.nhdr", header("uint8", fields)));
    return file ? (file->volume.values == std::vector<double>(12, 5) ? "right" : "wrong")
                : file.error().message();
  };
  EXPECT_EQ(at("data file: v.raw\nline skip: 2\nbyte skip: 3\n"), "right");
  EXPECT_EQ(at("datafile: ./v.raw\nbyte skip: -1\n\n"), "right");
  EXPECT_NE(at("data file: v.raw\n").find("v.raw"), std::string::npos);
  EXPECT_NE(at("data file: v.raw\n").find("need 12 bytes of data, not 25"), std::string::npos);
  EXPECT_NE(at("data file: none.raw\n").find("none.raw"), std::string::npos);
  EXPECT_NE(at("data file: v%03d.raw 1 4 1\n").find("several files"), std::string::npos);
  EXPECT_NE(at("line skip: 9\ndata file: v.raw\n").find("line skip"), std::string::npos);
}

TEST_F(NrrdFiles, DetachedHeadersNameNoFileOutsideOfTheirFolder) {
  const std::string outside = write("v.raw", data);
  fs::create_directories(fs::path(outside).parent_path() / "in" / "deeper");
  write("in/deeper/v.raw", data);
  const auto link = [&](const std::string& name, const fs::path& to) {
    fs::create_symlink(to, fs::path(outside).parent_path() / "in" / name);
  };
  link("in.raw", "deeper/v.raw");
  link("out.raw", outside);
  link("up", "..");
  const auto at = [&](const std::string& name) {
    const auto file = read_nrrd(write("in/v.nhdr", header("uint8", "data file: " + name + "\n")));
    return file ? std::string("read") : file.error().message();
  };
  EXPECT_EQ(at("deeper/v.raw"), "read");
  EXPECT_EQ(at("in.raw"), "read");
  for (const std::string& name :
       {outside, std::string("../v.raw"), std::string("deeper/../../v.raw"),
        std::string("/dev/zero"), std::string("out.raw"), std::string("up/v.raw")}) {
    const std::string message = at(name);
    EXPECT_NE(message.find("v.nhdr: data file: \"" + name), std::string::npos) << message;
    EXPECT_NE(message.find("folder of the header"), std::string::npos) << message;
  }
  EXPECT_NE(at("deeper").find("no regular file"), std::string::npos);
}

TEST(Nrrd, ErrorsNameTheLineAndWhatWouldBeRight) {
  const auto says = [](const std::string& file, const std::string& what) {
    const std::string message = refused(file);
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  says("NRRD0009\n\n", "NRRD0001 to NRRD0005");
  says("ISO-10303-21;", "no NRRD file");
  says(header("uint8") + "no field\n\n", "v.nrrd:7: the line is no field");
  says(header("uint8", "type: float\n\n") + data, "type: it comes twice");
  says(header("block", "\n"), "v.nrrd:3: type: \"block\" is no type of numbers");
  says(header("short", "\n") + data + data, "endian: the order of the bytes is not said");
  says("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: gzip\n\n" + data,
       "unu save -f nrrd -e raw");
  says("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: ascii\n\n" + data,
       "data in \"ascii\" are not read");
  says("NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 2 1\nencoding: raw\n\n" + data,
       "dimension: \"4\" is not 3");
  says("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 0 2\nencoding: raw\n\n",
       "sizes: \"0\" is no size");
  says("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2\nencoding: raw\n\n",
       "there are not three sizes");
  // The memory is not asked for before the sizes are known to be right.
  says("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 99999 99999 99999\nencoding: raw\n\n",
       "too many");
  says("NRRD0004\ntype: double\nendian: big\ndimension: 3\nsizes: 500 500 500\nencoding: raw\n\n" +
           data,
       "not 12");
  says(header("uint8"), "the header does not end");
  says(header("uint8", "\n") + data + "x", "need 12 bytes of data, not 13");
  says(header("uint8", "spacings: 1 nan 1\n\n") + data, "spacings: \"nan\" is no number");
  says(header("uint8", "spacings: 1 0 1\n\n") + data, "in a plane");
  says(header("uint8", "axis mins: 0 0 0\n\n") + data, "of cells or of nodes");
  says(header("uint8", "space directions: (1,0,0) (0,1,0) none\n\n") + data, "three directions");
  says(header("uint8", "space directions: (1,0,0) (0,1,0) (1,1,0)\n\n") + data, "in a plane");
  says(header("uint8", "space dimension: 2\nspace directions: (1,0) (0,1) (1,1)\n\n") + data,
       "three dimensions");
  says(header("float", "endian: little\n\n") +
           bytes_of(std::vector<float>(12, std::nanf("")), false),
       "voxel 0");
}

TEST(Nrrd, DamagedFilesAreRefusedOrRead) {
  const std::string good =
      header("short", "endian: little\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n\n") + data +
      data;
  ASSERT_TRUE(read(good));
  std::mt19937_64 random(2);
  int refusals = 0;
  for (int k = 0; k < 2000; ++k) {
    std::string bad = good;
    if (k % 2 == 0) bad.resize(random() % bad.size());
    for (int change = 0; change < 3 && !bad.empty(); ++change)
      bad[random() % bad.size()] = static_cast<char>(random());
    const auto volume = read(bad);
    if (volume) {
      EXPECT_TRUE(check_volume(*volume));
    } else {
      EXPECT_FALSE(volume.error().what.empty());
      ++refusals;
    }
  }
  EXPECT_GT(refusals, 1500);
}

}  // namespace
}  // namespace knead
