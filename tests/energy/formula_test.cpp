#include "energy/formula.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace knead {
namespace {

constexpr std::string_view variables[] = {"s", "t"};

double value_of(std::string_view text, double s = 0.25, double t = 3) {
  const auto formula = Formula::parse(text, variables);
  EXPECT_TRUE(formula) << text << ": " << (formula ? "" : formula.error().message());
  const double at[] = {s, t};
  return formula ? (*formula)(at) : std::numeric_limits<double>::quiet_NaN();
}

TEST(Formula, HasTheValueThatItsArithmeticSays) {
  using std::numbers::pi;
  const struct {
    const char* text;
    double value;
  } cases[] = {{"1", 1},
               {" .5 ", 0.5},
               {"1e-3", 1e-3},
               {"2E+2", 200},
               {"1 + 2*3", 7},
               {"(1 + 2)*3", 9},
               {"7 - 2 - 1", 4},
               {"8/2/2", 2},
               {"-2^2", -4},
               {"2^-1", 0.5},
               {"2^3^2", 512},
               {"-s*t", -0.75},
               {"--1", 1},
               {"+-+1", -1},
               {"2*-3", -6},
               {"s^2 + t", 3.0625},
               {"sin(pi/2) + cos(0)", 2},
               {"log(e)", 1},
               {"log2(8) + log10(1000)", 6},
               {"atan2(1, -1)", 3 * pi / 4},
               {"hypot(3, 4)", 5},
               {"max(s, t) - min(s, t)", 2.75},
               {"step(0.25, s) + step(0.26, s)", 1},
               {"clamp(t, 0, 1) + clamp(s, 0.5, 1)", 1.5},
               {"smoothstep(0, 1, s)", 0.15625},
               {"smoothstep(0, 1, t) + smoothstep(4, 5, t)", 1},
               {"mix(1, 5, s)", 2},
               {"abs(-2) + sign(-3) + floor(-0.5) + ceil(0.5)", 1},
               {"sqrt(16) + cbrt(27)", 7},
               {"tan(0) + asin(1) - acos(0) + atan(0)", 0},
               {"sinh(0) + cosh(0) + tanh(0)", 1},
               {"1+4*exp(-40*((s-.5)^2+(t-3)^2))", 1 + 4 * std::exp(-2.5)}};
  for (const auto& [text, value] : cases) EXPECT_DOUBLE_EQ(value_of(text), value) << text;
  EXPECT_TRUE(std::isnan(value_of("sqrt(-1)")));
  EXPECT_TRUE(std::isinf(value_of("1/(s - s)")));
}

TEST(Formula, SaysWhereItIsNotUnderstood) {
  const struct {
    const char* text;
    const char* where;
  } cases[] = {{"", "character 1"},
               {"1 +", "character 4"},
               {"1 2", "character 3"},
               {"(1", "character 3"},
               {"1)", "character 2"},
               {"q + 1", "character 1"},
               {"s t", "character 3"},
               {"sin 1", "character 5"},
               {"sin()", "character 5"},
               {"min(1)", "character 6"},
               {"1e999", "character 1"},
               {".", "character 1"},
               {"2 ** 3", "character 4"},
               {"s = 1", "character 3"},
               {"negative(1)", "character 1"},
               {"max(1, 2, 3)", "character 9"}};
  for (const auto& [text, where] : cases) {
    const auto formula = Formula::parse(text, variables);
    ASSERT_FALSE(formula) << text;
    EXPECT_EQ(formula.error().where, where) << text << ": " << formula.error().message();
  }
  EXPECT_NE(Formula::parse("q", variables).error().message().find("s, t"), std::string::npos);
  const std::string open(100000, '(');
  EXPECT_FALSE(Formula::parse(open, variables));
  EXPECT_FALSE(Formula::parse(open.substr(0, 1000), variables));
  EXPECT_FALSE(Formula::parse(std::string(1000, '-') + "1", variables));
  std::string powers = "2";
  for (int k = 0; k < 500; ++k) powers += "^1";
  EXPECT_FALSE(Formula::parse(powers, variables));
}

TEST(Formula, KnowsWhichVariablesItUses) {
  const auto formula = Formula::parse("1 + t", variables);
  ASSERT_TRUE(formula);
  EXPECT_FALSE(formula->uses(0));
  EXPECT_TRUE(formula->uses(1));
}

/// A random expression as text, with the value that C++ gives it.
struct Written {
  std::string text;
  double value;
};

Written random_expression(std::mt19937_64& random, int depth, double s, double t) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  if (depth == 0) {
    switch (below(3)) {
      case 0:
        return {"s", s};
      case 1:
        return {"t", t};
      default: {
        const double x = std::uniform_real_distribution<double>(0, 3)(random);
        return {fmt::format("{}", x), x};
      }
    }
  }
  const Written a = random_expression(random, depth - 1, s, t);
  const Written b = random_expression(random, below(depth), s, t);
  const auto spaced = [&](const char* op) {
    return fmt::format("({}{}{}{}{})", a.text, below(2) ? " " : "", op, below(2) ? " " : "",
                       b.text);
  };
  switch (below(9)) {
    case 0:
      return {spaced("+"), a.value + b.value};
    case 1:
      return {spaced("-"), a.value - b.value};
    case 2:
      return {spaced("*"), a.value * b.value};
    case 3:
      return {spaced("/"), a.value / b.value};
    case 4:
      return {fmt::format("(-{})", a.text), -a.value};
    case 5:
      return {fmt::format("abs({})^{}", a.text, b.text), std::pow(std::abs(a.value), b.value)};
    case 6:
      return {fmt::format("sin({})", a.text), std::sin(a.value)};
    case 7:
      return {fmt::format("max({},{})", a.text, b.text), std::max(a.value, b.value)};
    default:
      return {fmt::format("hypot({}, {})", a.text, b.text), std::hypot(a.value, b.value)};
  }
}

TEST(Formula, RandomExpressionsHaveTheValuesOfCpp) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 3000; ++k) {
    const double s = std::uniform_real_distribution<double>(-1, 1)(random), t = 2 * s + 1;
    const Written written = random_expression(random, 1 + k % 6, s, t);
    const double value = value_of(written.text, s, t);
    // A power of b that begins with a power is to the right: written with parentheses unless b is
    // simple.
    if (std::isnan(written.value)) {
      EXPECT_TRUE(std::isnan(value)) << written.text;
    } else {
      EXPECT_EQ(value, written.value) << written.text;
    }
  }
}

TEST(Formula, TextThatIsDamagedIsReadOrRefused) {
  std::mt19937_64 random(4);
  const std::string_view letters = "st01.9eE+-*/^(), abcosinmxy\t%\n\0\x80";
  int read = 0;
  for (int k = 0; k < 30000; ++k) {
    std::string text = random_expression(random, k % 5, 0.5, 0.5).text;
    for (unsigned changes = static_cast<unsigned>(random() % 4); changes > 0 && !text.empty();
         --changes) {
      const std::size_t at = random() % text.size();
      const char c = letters[random() % letters.size()];
      switch (random() % 3) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        default:
          text.erase(at, 1);
      }
    }
    const auto formula = Formula::parse(text, variables);
    if (!formula) {
      EXPECT_FALSE(formula.error().what.empty());
      continue;
    }
    ++read;
    const double at[] = {0.5, 0.25};
    const double first = (*formula)(at), second = (*formula)(at);
    EXPECT_TRUE(first == second || (std::isnan(first) && std::isnan(second))) << text;
  }
  EXPECT_GT(read, 5000);
}

}  // namespace
}  // namespace knead
