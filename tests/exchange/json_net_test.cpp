#include "exchange/new_surfaces.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/format.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::open_or_die;
using testing::same_bits;

/// The bytes with one surface in the place of the first.
std::string with(const Source& source, const Surface& surface) {
  const std::vector made = {std::make_shared<const Surface>(surface)};
  const auto bytes = source.save(made);
  EXPECT_TRUE(bytes) << bytes.error().message();
  return bytes.value_or("");
}

std::string refusal_of(const std::string& text) {
  const auto source = open_source(text, "a.json");
  EXPECT_FALSE(source) << text;
  return source ? "" : source.error().message();
}

TEST(JsonNet, RowsOfPointsAreASurfaceWithUniformKnots) {
  const std::string text =
      "[\n [[0, 0, 0], [0, 1, 0.5]],\n [[1, 0, 1e-3], [1, 1, -2.5E0]],\n [[2,0,0],[2,1,0]]\n]\n";
  const auto source = open_or_die(text, "a.json");
  ASSERT_EQ(source->surfaces().size(), 1U);
  const Surface& s = *source->surfaces()[0].surface;
  EXPECT_EQ(s.net(), (std::array{3, 2}));
  EXPECT_EQ(s.knots(0).degree(), 2);
  EXPECT_EQ(s.knots(1).degree(), 1);
  EXPECT_EQ(Point(s.control_points().row(3)), Point(1, 1, -2.5));
  EXPECT_EQ(source->remarks().size(), 1U) << "that degrees are not the file's";
  EXPECT_EQ(with(*source, s), text) << "another object of the same numbers";

  Points moved = s.control_points();
  moved(3, 2) = 1.0 / 3;
  const auto lifted = Surface::create(s.knots(), moved);
  const std::string written = with(*source, *lifted);
  std::string expected = text;
  expected.replace(expected.find("-2.5E0"), 6, "0.33333333333333331");
  EXPECT_EQ(written, expected) << "one number";
}

TEST(JsonNet, ComesBackToTheSameBitsWithDegreesKnotsAndWeights) {
  const auto source = open_or_die("[[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]", "a.json");
  for (const auto& [name, surface, colour, id] : testing::new_surfaces()) {
    SCOPED_TRACE(name);
    const std::string text = with(*source, surface);
    const auto again = open_or_die(text, "b.json");
    ASSERT_EQ(again->surfaces().size(), 1U) << text.substr(0, 200);
    const Surface& read = *again->surfaces()[0].surface;
    EXPECT_TRUE(same_bits(read.control_points(), surface.control_points()));
    EXPECT_TRUE(std::ranges::equal(read.weights(), surface.weights()));
    for (int d = 0; d < 2; ++d) {
      EXPECT_EQ(read.knots(d).degree(), surface.knots(d).degree());
      EXPECT_TRUE(std::ranges::equal(read.knots(d).knots(), surface.knots(d).knots()));
    }
    EXPECT_TRUE(again->remarks().empty());
    EXPECT_EQ(with(*again, surface), text);
  }
}

TEST(JsonNet, FaultsAreNamedWithTheirLine) {
  const auto has = [](const std::string& text, const std::string& word) {
    EXPECT_NE(refusal_of(text).find(word), std::string::npos) << refusal_of(text);
  };
  has("[[[0,0,0],[0,1,0]],\n[[1,0,0],[1,1]]]", "a.json:2: a control point has 2 coordinates");
  has("[[[0,0,0],[0,1,0]],[[1,0,0]]]", "row 2 of the net has 1 items, the first row has 2");
  has("[[[0,0,0],[0,1,NaN]]]", "\"NaN\" is not a number");
  has("[[[0,0,0],[0,1,1e999]]]", "\"1e999\" is not a number");
  has("[[[0,0,0],[0,1,0]]]", "1 x 2 control points is no surface");
  has("[[[0,0,0],[0,1,0]]", "does not end");
  has(R"({"knead": 2, "commands": []})", "it is a script of commands");
  has(R"({"net": [], "net": []})", "\"net\" is there twice");
  has(R"({"degree": [1, 1.5]})", "whole number");
  has(R"({"degree": [1, 1]})", "no field \"net\"");
  has(R"({"net": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]], "knots": [[0,0,1,1],[0,0,1,1]]})",
      "no field \"degree\"");
  has("[[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]] x", "follows the net");
  has(std::string(100000, '['), "is not a number");
  EXPECT_FALSE(open_source("", "a.json"));
}

TEST(PlainNet, WithoutRowsIsAFileWhoseSurfaceCannotBeRead) {
  const auto source = open_or_die("0 0 0\n0 1 0\n1 0 0\n1 1 0\n", "a.ctrlpts");
  EXPECT_TRUE(source->surfaces().empty());
  ASSERT_EQ(source->unreadable().size(), 1U);
  EXPECT_EQ(source->unreadable()[0].reason.message(),
            "a.ctrlpts:1: 4 control points, but how many make a row is not said; put an empty line "
            "after each row, or each row in one line with semicolons");
}

}  // namespace
}  // namespace knead
