#include "knead/base/error.hpp"

#include <gtest/gtest.h>

namespace knead {
namespace {

TEST(Error, MessageNamesFileLinePlaceCauseAndRemedy) {
  const Error error{ErrorKind::input, "the knots decrease", "knot 7",
                    "sort the knots", "wing.step",          12};
  EXPECT_EQ(error.message(), "wing.step:12: knot 7: the knots decrease; sort the knots");
}

TEST(Error, MessageLeavesOutWhatIsUnknown) {
  EXPECT_EQ(Error(ErrorKind::input, "it is empty").message(), "it is empty");
  EXPECT_EQ(Error(ErrorKind::input, "it is empty", "list").message(), "list: it is empty");
  EXPECT_EQ(Error(ErrorKind::input, "it is empty", {}, "fill it").message(),
            "it is empty; fill it");
  EXPECT_EQ(Error(ErrorKind::input, "it is empty", {}, {}, "a.step").message(),
            "a.step: it is empty");
  EXPECT_EQ(Error(ErrorKind::input, "it is empty", {}, {}, {}, 3).message(), "line 3: it is empty");
}

TEST(Error, MessageIsOneLine) {
  const Error error{ErrorKind::input, "the knots decrease", "knot 7",
                    "sort the knots", "wing.step",          12};
  EXPECT_EQ(error.message().find('\n'), std::string::npos);
}

TEST(Error, WithinPutsThePlaceInsideALargerOneAndKeepsTheRest) {
  const Error inner{ErrorKind::numerical, "it is singular", "row 3", "pin a point", "a.json", 4};
  const Error outer = inner.within("commands[2]");
  EXPECT_EQ(outer.where, "commands[2]: row 3");
  EXPECT_EQ(outer.kind, ErrorKind::numerical);
  EXPECT_EQ(outer.what, inner.what);
  EXPECT_EQ(outer.remedy, inner.remedy);
  EXPECT_EQ(outer.file, inner.file);
  EXPECT_EQ(outer.line, inner.line);
  EXPECT_EQ(Error(ErrorKind::input, "it is singular").within("step").where, "step");
}

TEST(Error, ShorthandsSayWhoseFaultItIs) {
  EXPECT_EQ(input_error("a").error().kind, ErrorKind::input);
  EXPECT_EQ(numerical_error("a").error().kind, ErrorKind::numerical);
  EXPECT_EQ(usage_error("a").error().kind, ErrorKind::usage);
  const Expected<int> failed = input_error("what", "where", "remedy");
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message(), "where: what; remedy");
}

}  // namespace
}  // namespace knead
