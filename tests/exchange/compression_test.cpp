#include "knead/exchange/file_io.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>

#include "support.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::open_or_die;
using testing::step_text;
using testing::unit_square_points;

std::string a_model() { return step_text(unit_square_points() + bilinear_patch()); }

std::string little_endian(std::size_t value, int count) {
  std::string text;
  for (int k = 0; k < count; ++k, value >>= 8U) text += static_cast<char>(value & 0xFFU);
  return text;
}

/// What zlib's own writer makes of zeros, by parts: a bomb.
std::string gzip_of_zeros(std::size_t size) {
  z_stream stream = {};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_RLE), Z_OK);
  std::string zeros(std::size_t{1} << 20, '\0'), packed(std::size_t{1} << 16, '\0'), result;
  for (int state = Z_OK; state != Z_STREAM_END;) {
    if (stream.avail_in == 0) {
      stream.avail_in = static_cast<uInt>(std::min(size, zeros.size()));
      stream.next_in = reinterpret_cast<Bytef*>(zeros.data());
      size -= stream.avail_in;
    }
    stream.avail_out = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    state = deflate(&stream, size == 0 ? Z_FINISH : Z_NO_FLUSH);
    result.append(packed, 0, packed.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  return result;
}

std::string error_of(const std::string& bytes, std::size_t most = max_file_size) {
  const auto plain = uncompress(bytes, most);
  EXPECT_FALSE(plain);
  const auto source = open_source(bytes, "a.step", {.max_unpacked = most});
  EXPECT_FALSE(source);
  if (plain || source) return {};
  EXPECT_EQ(source.error().file, "a.step");
  EXPECT_EQ(source.error().what, plain.error().what);
  EXPECT_FALSE(plain.error().remedy.empty()) << plain.error().what;
  return plain.error().what;
}

/// As other programs write it: with a name, a date, an extra field and the checksum of the header.
std::string gzip_by_another() {
  const std::string header = std::string("\x1F\x8B\x08\x1E\x11\x22\x33\x44\x02\x03", 10) +
                             std::string("\x02\0ab", 4) + std::string("part.step\0", 10) +
                             std::string("a comment\0", 10) + "zz";
  const std::string stream = *compress(a_model(), Compression::gzip, "");
  return header + stream.substr(10);
}

class Compressed : public ::testing::TestWithParam<Compression> {
 protected:
  const std::string plain_ = a_model();
  const std::string packed_ = *compress(plain_, GetParam(), "part.stp");
};
INSTANTIATE_TEST_SUITE_P(Kinds, Compressed, ::testing::Values(Compression::gzip, Compression::zip),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(Compressed, HoldsWhatWasPutInAndIsSmaller) {
  EXPECT_EQ(compression_of(packed_), GetParam());
  EXPECT_LT(packed_.size(), plain_.size());
  EXPECT_EQ(uncompress(packed_), plain_);
  for (const std::string bytes : {"", "a", "PK\x03\x04"}) {
    EXPECT_EQ(uncompress(*compress(bytes, GetParam(), "x")), bytes);
  }
}

TEST_P(Compressed, IsOpenedByItsContentUnderAnyName) {
  for (const std::string name : {"part.stpZ", "part.step.gz", "part.p21.gz", "part.step", "part"}) {
    const auto source = open_or_die(packed_, name);
    EXPECT_EQ(source->format(), "STEP");
    EXPECT_EQ(source->name(), name);
    ASSERT_EQ(source->surfaces().size(), 1U);
    EXPECT_NE(source->remarks().front().find("compressed as " + std::string(name_of(GetParam()))),
              std::string::npos);
  }
}

TEST_P(Compressed, AnUnchangedFileKeepsItsBytesAndAChangedOneIsCompressedAgain) {
  const auto source = open_or_die(packed_, "part.stpZ");
  const auto& opened = *source->surfaces()[0].surface;
  EXPECT_EQ(source->save(std::array{source->surfaces()[0].surface}), packed_);
  Points points = opened.control_points();
  points(0, 2) = 0.5;
  const auto moved = std::make_shared<const Surface>(*opened.with_control_points(points));
  const auto plain = open_or_die(plain_, "part.stp");
  const auto saved = source->save(std::array{moved});
  ASSERT_TRUE(saved);
  EXPECT_EQ(compression_of(*saved), GetParam());
  EXPECT_EQ(uncompress(*saved), *plain->save(std::array{moved}))
      << "what is in it is what the plain file becomes";
}

TEST_P(Compressed, IsDamagedWhereAnyPartOfItIsMissingOrAByteOfItsDataIsAnother) {
  for (std::size_t size = 4; size < packed_.size(); ++size) {
    EXPECT_FALSE(uncompress(std::string_view(packed_).substr(0, size))) << size;
  }
  for (std::size_t k = 40; k < packed_.size() / 2; ++k) {
    std::string other = packed_;
    other[k] = static_cast<char>(other[k] ^ 0x10);
    const auto plain = uncompress(other);
    EXPECT_TRUE(!plain || *plain == plain_) << k;
  }
}

TEST_P(Compressed, WhatIsLargerThanAllowedIsRefusedUnlessMoreIsAllowed) {
  EXPECT_NE(error_of(packed_, plain_.size() - 1).find("more than"), std::string::npos);
  EXPECT_TRUE(uncompress(packed_, plain_.size()));
  EXPECT_TRUE(open_source(packed_, "a.step", {.max_unpacked = plain_.size()}));
}

TEST_P(Compressed, AFileThatIsCompressedTwiceIsRefused) {
  const auto source = open_source(*compress(packed_, Compression::gzip, ""), "a.step.gz");
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().what.find("twice"), std::string::npos);
}

TEST(Gzip, TheChecksumAndTheSizeAreThoseOfTheData) {
  const std::string packed = *compress(a_model(), Compression::gzip, "");
  for (const std::size_t from_end : {8U, 4U}) {
    std::string other = packed;
    ++other[other.size() - from_end];
    error_of(other);
  }
  std::string other = packed;
  ++other[other.size() - 8];
  EXPECT_NE(error_of(other).find("checksum"), std::string::npos);
}

TEST(Gzip, AHeaderOfAnotherProgramStays) {
  const std::string packed = gzip_by_another();
  EXPECT_EQ(uncompress(packed), a_model());
  EXPECT_EQ(compress_like(a_model(), packed), packed);
  const auto changed = compress_like(a_model() + "\n", packed);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->substr(0, 36), packed.substr(0, 36));
  EXPECT_EQ(uncompress(*changed), a_model() + "\n");
}

TEST(Gzip, SeveralMembersAreRefused) {
  const std::string one = *compress(a_model(), Compression::gzip, "");
  EXPECT_NE(error_of(one + one).find("behind"), std::string::npos);
}

TEST(Gzip, ABombIsRefusedByWhatItStatesAndOneThatLiesAsSoonAsItGoesOn) {
  const std::string bomb = gzip_of_zeros((std::size_t{1} << 30) + 1);
  EXPECT_LT(bomb.size(), std::size_t{1} << 21);
  EXPECT_NE(error_of(bomb).find("1024.0 MiB, more than the 1024"), std::string::npos);
  std::string small = bomb;
  small.replace(small.size() - 4, 4, little_endian(1000, 4));
  EXPECT_NE(error_of(small).find("go on beyond"), std::string::npos);
  std::string large = *compress("a", Compression::gzip, "");
  large.replace(large.size() - 4, 4, little_endian(max_file_size, 4));
  EXPECT_NE(error_of(large).find("cannot have"), std::string::npos);
}

TEST(Zip, TheEntryKeepsItsNameItsDateAndItsAttributes) {
  std::string packed = *compress(a_model(), Compression::zip, "part \xC3\xA4.stp");
  const std::size_t directory = packed.find("PK\x01\x02");
  for (const std::size_t head : {std::size_t{6}, directory + 8})
    packed.replace(head + 4, 4, "\x21\x43\x65\x57");
  packed.replace(directory + 38, 4, std::string("\0\0\xA4\x81", 4));
  const auto changed = compress_like("changed", packed);
  ASSERT_TRUE(changed);
  EXPECT_EQ(uncompress(*changed), "changed");
  EXPECT_EQ(changed->substr(10, 4), "\x21\x43\x65\x57");
  EXPECT_EQ(changed->substr(30, 11), "part \xC3\xA4.stp");
  const std::size_t again = changed->find("PK\x01\x02");
  EXPECT_EQ(changed->substr(again + 38, 4), std::string("\0\0\xA4\x81", 4));
  EXPECT_EQ(changed->substr(again + 46, 11), "part \xC3\xA4.stp");
}

/// An archive of stored entries, without data descriptors.
std::string stored(const std::vector<std::pair<std::string, std::string>>& entries,
                   unsigned flags = 0, unsigned method = 0) {
  std::string text, directory;
  for (const auto& [name, bytes] : entries) {
    const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    const std::string common =
        little_endian(20, 2) + little_endian(flags, 2) + little_endian(method, 2) +
        little_endian(0, 4) + little_endian(crc, 4) + little_endian(bytes.size(), 4) +
        little_endian(bytes.size(), 4) + little_endian(name.size(), 2) + little_endian(0, 2);
    directory += "PK\x01\x02" + little_endian(20, 2) + common + little_endian(0, 10) +
                 little_endian(text.size(), 4) + name;
    text += "PK\x03\x04" + common + name + bytes;
  }
  const std::size_t begin = text.size();
  return text + directory + "PK\x05\x06" + little_endian(0, 4) + little_endian(entries.size(), 2) +
         little_endian(entries.size(), 2) + little_endian(directory.size(), 4) +
         little_endian(begin, 4) + little_endian(9, 2) + "a comment";
}

TEST(Zip, AStoredEntryIsReadAndStaysStored) {
  const std::string packed = stored({{"a.stp", a_model()}});
  EXPECT_EQ(uncompress(packed), a_model());
  EXPECT_EQ(compress_like(a_model(), packed), packed);
  const auto changed = compress_like(a_model() + "\n", packed);
  ASSERT_TRUE(changed);
  EXPECT_NE(changed->find(a_model()), std::string::npos);
  EXPECT_EQ(uncompress(*changed), a_model() + "\n");
}

TEST(Zip, SeveralEntriesNoneEncryptedOnesAndOtherMethodsAreRefusedByName) {
  EXPECT_NE(error_of(stored({{"a.stp", a_model()}, {"b.stp", a_model()}})).find("holds 2 files"),
            std::string::npos);
  EXPECT_NE(error_of(stored({{"a.stp", a_model()}}, 1)).find("encrypted"), std::string::npos);
  EXPECT_NE(error_of(stored({{"a.stp", a_model()}}, 0, 12)).find("method 12"), std::string::npos);
  std::string large = stored({{"a.stp", a_model()}});
  large.replace(large.rfind("PK\x05\x06") + 16, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_NE(error_of(large).find("ZIP64"), std::string::npos);
}

TEST(Zip, ABombIsRefusedByItsDirectoryAndOneThatLiesAsSoonAsItGoesOn) {
  std::string bomb = *compress(std::string(std::size_t{1} << 20, '\0'), Compression::zip, "a.stp");
  const std::size_t size = bomb.find("PK\x01\x02") + 24;
  bomb.replace(size, 4, little_endian(max_file_size + 1, 4));
  EXPECT_NE(error_of(bomb).find("more than the 1024"), std::string::npos);
  bomb.replace(size, 4, little_endian(1000, 4));
  EXPECT_NE(error_of(bomb).find("go on beyond"), std::string::npos);
}

TEST(Compression, NamesSayHowAFileIsCompressedInAnyCase) {
  EXPECT_EQ(compression_of_name("a.step.gz"), Compression::gzip);
  EXPECT_EQ(compression_of_name("a.P21.GZ"), Compression::gzip);
  EXPECT_EQ(compression_of_name("a.stpZ"), Compression::zip);
  EXPECT_EQ(compression_of_name("a.stp"), Compression::none);
  EXPECT_EQ(uncompressed_name("a.step.gz"), "a.step");
  EXPECT_EQ(uncompressed_name("a.stpZ"), "a.stp");
  EXPECT_EQ(uncompressed_name("a.stp"), "a.stp");
  EXPECT_EQ((*format_of_name("a.stpZ", FormatContent::surfaces))->id, "step");
  EXPECT_EQ((*format_of_name("a.igs.gz", FormatContent::surfaces))->id, "iges");
  EXPECT_FALSE(format_of_name("a.stl.gz", FormatContent::triangles));
}

}  // namespace
}  // namespace knead
