#include "knead/base/printable.hpp"

#include <gtest/gtest.h>

#include <array>

#include "base/counts.hpp"
#include "knead/base/error.hpp"

namespace knead {
namespace {

TEST(Printable, TextIsUnchangedAndWhatControlsATerminalIsEscaped) {
  EXPECT_EQ(printable("Außenhaut 面 😀 \\ \"a\""), "Außenhaut 面 😀 \\ \"a\"");
  EXPECT_EQ(printable(std::string("a\nb\tc\rd\0e", 9)), "a\\nb\\tc\\rd\\x00e");
  EXPECT_EQ(printable("\x1B[2J\x7F"), "\\x1B[2J\\x7F");
  EXPECT_EQ(printable("\xC2\x9B"), "\\xC2\\x9B") << "C1: the one-byte form of ESC [";
}

TEST(Printable, OfXmlHasNoCharactersOfItsOwn) {
  EXPECT_EQ(xml_text("Grüße, a < b & \"c\" > d"), "Grüße, a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(xml_text(std::string("a\nb\0c\x1B", 6)), "a b c ");
}

TEST(Printable, BytesThatAreNotUtf8AreEscaped) {
  EXPECT_EQ(printable("Gr\xFC\xDF e"), "Gr\\xFC\\xDF e");
  EXPECT_EQ(printable("\xC0\xAF"), "\\xC0\\xAF") << "longer than needed";
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xED\\xA0\\x80") << "half of a pair";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80") << "beyond the last character";
  EXPECT_EQ(printable("\xE9\x9D"), "\\xE9\\x9D") << "cut off";
}

TEST(Printable, LongTextKeepsItsBeginningAndEnd) {
  const std::string text = std::string(5000, 'a') + "end";
  const std::string shown = printable(text, 100);
  EXPECT_EQ(shown.size(), 100U);
  EXPECT_TRUE(shown.starts_with("aaa") && shown.ends_with("end"));
  EXPECT_NE(shown.find("…"), std::string::npos);
  std::string wide;
  for (int k = 0; k < 1000; ++k) wide += "面";
  for (std::size_t most = 16; most < 40; ++most) {
    EXPECT_EQ(printable(wide, most).find('\\'), std::string::npos)
        << "cut between characters: " << most;
    EXPECT_LE(printable(wide, most).size(), most);
  }
}

TEST(Printable, ErrorsThatQuoteAnythingStayOneShortLine) {
  const Error error{ErrorKind::input,
                    "\"" + std::string(2000000, 'x') + "\" is no name",
                    "a\nb",
                    "\x1B[31m",
                    "f\r",
                    1};
  const std::string message = error.message();
  EXPECT_LT(message.size(), 2200U);
  EXPECT_EQ(message.find_first_of("\n\r\x1B"), std::string::npos);
  EXPECT_NE(message.find("is no name"), std::string::npos);
}

TEST(Counts, ProductsAreExactOrRefused) {
  EXPECT_EQ(product_of(std::array{3, 4, 5}), 60);
  EXPECT_EQ(product_of(std::array{8192, 8192}), max_spline_size);
  EXPECT_EQ(product_of(std::array{8192, 8193}), std::nullopt);
  EXPECT_EQ(product_of(std::array{32768, 131072}), std::nullopt) << "2^32, 0 in 32 bits";
  EXPECT_EQ(product_of(std::array{65536, 65537}), std::nullopt) << "65536 in 32 bits";
  EXPECT_EQ(product_of(std::array{2000000000, 2000000000, 2000000000}), std::nullopt);
  EXPECT_EQ(product_of(std::array{2000000000, 2000000000, 0}), 0);
  EXPECT_EQ(product_of(std::array{10, 10}, 99), std::nullopt);
  EXPECT_EQ(product_of(std::array{10, 10}, 100), 100);
}

}  // namespace
}  // namespace knead
