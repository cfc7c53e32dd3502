#include "house/function_lengths.hpp"

#include <gtest/gtest.h>

namespace knead::house {
namespace {

void expect_lengths(const std::vector<std::string>& code,
                    const std::vector<std::pair<std::size_t, std::size_t>>& want) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (const FunctionLength& f : function_lengths(code)) found.emplace_back(f.line, f.lines);
  EXPECT_EQ(found, want) << testing::PrintToString(code);
}

TEST(FunctionLengths, CountFromTheHeadToTheClosingBrace) {
  expect_lengths(
      {"namespace a {", "", "int f(int x,", "      int y) {", "  return x + y;", "}", "}"},
      {{3, 4}});
}

TEST(FunctionLengths, LambdasAndLocalTypesCountToTheirFunction) {
  expect_lengths({"void f() {", "  struct S {", "    int g() { return 1; }", "  };",
                  "  auto h = [](int x) {", "    return x;", "  };", "}"},
                 {{1, 8}});
}

TEST(FunctionLengths, MembersAreFunctionsAndTypesAreNot) {
  expect_lengths({"template <int D>", "class A : B<D> {", " public:", "  enum class E { a, b };",
                  "  int f() const {", "    return 1;", "  }", "  int x = 0;",
                  " private:", "  void g();", "};"},
                 {{5, 3}});
}

TEST(FunctionLengths, InitialisersOfMembersDoNotEndAConstructor) {
  expect_lengths(
      {"A::A(int x)", "    : a_{x},", "      b_{x} {", "  f();", "}", "int y() { return 0; }"},
      {{1, 5}, {6, 1}});
}

TEST(FunctionLengths, DirectivesAreNoCode) {
  expect_lengths({"#define F(x) \\", "  g(x) {", "template <class T>", "T f(T t) {", "}"},
                 {{3, 3}});
}

TEST(FunctionLengths, ListsOfConstantsAreNoFunctions) {
  expect_lengths(
      {"constexpr std::array<int, 2> a = {", "    1,", "    2};", "static const int b[] = {1, 2};"},
      {});
}

}  // namespace
}  // namespace knead::house
