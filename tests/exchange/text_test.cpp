#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "exchange/support.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::step_text;

// The x coordinate of control point 0 written as `text`.
Expected<double> read_real(const std::string& text) {
  const auto file = parse_or_die(step_text(
      "#1=CARTESIAN_POINT('',(" + text +
      ",0.,0.));\n#2=CARTESIAN_POINT('',(0.,1.,0.));\n#3=CARTESIAN_POINT('',(1.,0.,0.));\n"
      "#4=CARTESIAN_POINT('',(1.,1.,0.));\n" +
      bilinear_patch()));
  if (file.surfaces().empty()) return std::unexpected(file.model().unreadable.at(0).reason);
  return file.surfaces()[0].surface.control_points()(0, 0);
}

std::string read_name(const std::string& literal) {
  auto patch = bilinear_patch();
  patch.replace(patch.find("'patch'"), 7, literal);
  return parse_or_die(step_text(testing::unit_square_points() + patch)).surfaces().at(0).name;
}

TEST(StepReals, AreCorrectlyRounded) {
  const struct {
    const char* text;
    double value;
  } cases[] = {{"1.", 1},
               {"-1.5", -1.5},
               {"+2.E+02", 200},
               {"1.E2", 100},
               {"1.e2", 100},
               {"1.D2", 100},
               {".5", 0.5},
               {"-.5E-1", -0.05},
               {"7", 7},
               {"0.1", 0.1},
               {"9007199254740993.", 9007199254740992.},
               {"9007199254740993.00000000000000000000000000000000000001", 9007199254740994.},
               {"0.1000000000000000055511151231257827021181583404541015625", 0.1},
               {"9.999999999999999E49", std::nextafter(1e50, 0)},
               {"4.9E-324", std::numeric_limits<double>::denorm_min()},
               {"1.E-400", 0},
               {"1.E-99999999999999999999", 0},
               {"0.E99999999999999999999", 0}};
  for (const auto& c : cases) {
    const auto value = read_real(c.text);
    ASSERT_TRUE(value) << c.text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(*value), std::bit_cast<std::uint64_t>(c.value))
        << c.text;
  }
  EXPECT_TRUE(std::signbit(*read_real("-0.")));
  EXPECT_TRUE(std::signbit(*read_real("-1.E-400")));
  EXPECT_EQ(*read_real("0." + std::string(400, '0') + "1E+401"), 1.0);
}

TEST(StepReals, TooLargeForADoubleIsAnErrorOfTheSurface) {
  for (const auto* text : {"1.E309", "-1.E99999999999999999999", "1.E+400"})
    EXPECT_FALSE(read_real(text)) << text;
  EXPECT_FALSE(read_real(std::string(400, '9') + "."));
}

// Everything that can be a coordinate survives writing and reading, as a legal REAL with 17
// significant digits.
TEST(StepReals, AnyDoubleSurvivesWritingToTheLastBit) {
  const auto file = parse_or_die(step_text(testing::unit_square_points() + bilinear_patch()));
  std::mt19937_64 random(7);
  std::vector<double> values = {
      -0.0, 0.1, 1.0 / 3, -1e23, 5e-324, -2.2250738585072014e-308, largest_number, -largest_number};
  while (values.size() < 3000) {
    const double value = std::bit_cast<double>(random());
    if (std::abs(value) <= largest_number) values.push_back(value);
  }
  for (std::size_t k = 0; k + 12 <= values.size(); k += 12) {
    Points points = Eigen::Map<const Points>(values.data() + k, 4, 3);
    const step::Edit edit{"#10", points};
    const auto bytes = file.with_control_points({&edit, 1});
    ASSERT_TRUE(bytes) << bytes.error().message();
    EXPECT_TRUE(
        testing::same_bits(parse_or_die(*bytes).surfaces()[0].surface.control_points(), points));
  }
}

TEST(StepReals, AreWrittenWithSeventeenDigits) {
  const auto file = parse_or_die(step_text(testing::unit_square_points() + bilinear_patch()));
  Points points = file.surfaces()[0].surface.control_points();
  points(0, 0) = -0.1;
  points(0, 1) = -0.0;
  points(0, 2) = 1e40;
  const step::Edit edit{"#10", points};
  EXPECT_NE(file.with_control_points({&edit, 1})
                ->find("#1=CARTESIAN_POINT('',(-1.0000000000000001E-01,-0.0000000000000000E+00,1."
                       "0000000000000000E+40));\n"),
            std::string::npos);
}

TEST(StepStrings, AreDecodedToUtf8) {
  EXPECT_EQ(read_name("'plain'"), "plain");
  EXPECT_EQ(read_name("''"), "");
  EXPECT_EQ(read_name("$"), "");
  EXPECT_EQ(read_name("'it''s'"), "it's");
  EXPECT_EQ(read_name("'a\\\\b'"), "a\\b");
  EXPECT_EQ(read_name("'\\X\\E9t\\X\\E9'"), "été");
  EXPECT_EQ(read_name("'\\X2\\03B103B2\\X0\\!'"), "αβ!");
  EXPECT_EQ(read_name("'\\X4\\0001F697\\X0\\'"), "🚗");
  EXPECT_EQ(read_name("'\\X2\\D83DDE97\\X0\\'"), "🚗");
  EXPECT_EQ(read_name("'\\S\\i'"), "é");
  EXPECT_EQ(read_name("'\\PE\\\\S\\0\\PA\\\\S\\0'"), "А°");
  EXPECT_EQ(read_name("'\\PG\\\\S\\a'"), "α");
  EXPECT_EQ(read_name("'wrapped\r\n line'"), "wrapped line");
  EXPECT_EQ(read_name("'C:\\dir'"), "C:\\dir");
  EXPECT_EQ(read_name("'caf\xE9'"), "café");
  EXPECT_EQ(read_name("'caf\xC3\xA9'"), "café");
  EXPECT_EQ(read_name("'\\X2\\D83D\\X0\\'"), "\xEF\xBF\xBD");
  EXPECT_EQ(read_name("'\\X2\\00'"), "");
}

}  // namespace
}  // namespace knead
