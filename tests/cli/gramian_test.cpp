#include "knead/gramian/gramian.hpp"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include "program.hpp"

namespace knead::testing {
namespace {

const std::string thesis_knots = "0,0,0,0,1,2,3,3,3,3";

KnotVector knot_vector(int degree, std::vector<double> knots) {
  return *KnotVector::create(degree, std::move(knots));
}

/// Row i of the band is G(i, i − p) … G(i, i + p), zero outside of the matrix; equal to the last
/// bit.
void expect_band(const Json& band, const BandMatrix& expected, int degree) {
  ASSERT_EQ(band.size(), static_cast<std::size_t>(expected.size()));
  for (int i = 0; i < expected.size(); ++i) {
    const Json& row = band.at(static_cast<std::size_t>(i));
    ASSERT_EQ(row.size(), static_cast<std::size_t>(2 * degree + 1));
    for (int s = -degree; s <= degree; ++s) {
      const int j = i + s;
      const double value = j < 0 || j >= expected.size() ? 0 : expected(i, j);
      EXPECT_EQ(row.at(static_cast<std::size_t>(s + degree)).get<double>(), value)
          << i << ", " << j;
    }
  }
}

TEST(GramianCommand, AllPrintsFourMatricesBitForBit) {
  for (const char* method : {"gauss", "gauss-reduced", "analytic", "recurrence"}) {
    const Json out =
        knead({"gramian", "--degree", "3", "--knots", thesis_knots, "--all", "--method", method})
            .json();
    EXPECT_EQ(out.at("degree"), 3);
    EXPECT_EQ(out.at("count"), 6);
    EXPECT_EQ(out.at("method"), method);
    const auto set =
        gramians(knot_vector(3, {0, 0, 0, 0, 1, 2, 3, 3, 3, 3}), *gramian_method(method));
    ASSERT_TRUE(set);
    const Json& g = out.at("gramians");
    EXPECT_EQ(g.size(), 4U);
    expect_band(g.at("00").at("band"), set->g00, 3);
    expect_band(g.at("11").at("band"), set->g11, 3);
    expect_band(g.at("22").at("band"), set->g22, 3);
    expect_band(g.at("10").at("band"), set->g10, 3);
  }
}

TEST(GramianCommand, TheMassOfOneSpanIsThatOfTheTextbook) {
  for (const char* method : {"gauss", "gauss-reduced", "analytic", "recurrence"}) {
    const Json out =
        knead({"gramian", "--degree", "1", "--knots", "0,0,1,1", "--method", method}).json();
    const Json band = out.at("gramians").at("00").at("band");  // hat functions: thirds and sixths
    EXPECT_EQ(band.at(0).at(0), 0);
    EXPECT_DOUBLE_EQ(band.at(0).at(1).get<double>(), 1.0 / 3);
    EXPECT_DOUBLE_EQ(band.at(0).at(2).get<double>(), 1.0 / 6);
    EXPECT_DOUBLE_EQ(band.at(1).at(0).get<double>(), 1.0 / 6);
    EXPECT_DOUBLE_EQ(band.at(1).at(1).get<double>(), 1.0 / 3);
    EXPECT_EQ(band.at(1).at(2), 0);
  }
}

TEST(GramianCommand, SecondDerivativesOfLinesArePrintedAsZero) {
  const Json g =
      knead({"gramian", "--degree", "1", "--knots", "0,0,1,1", "--all", "--method", "gauss"})
          .json();
  EXPECT_EQ(g.at("gramians").at("22").at("band"), Json::parse("[[0,0,0],[0,0,0]]"));
}

TEST(GramianCommand, OneTermIsNamedByItsOrders) {
  const Json out = knead({"gramian", "--degree", "2", "--knots", "0,0,0,1,1,1", "--a", "0", "--b",
                          "1", "--method", "gauss"})
                       .json();
  ASSERT_EQ(out.at("gramians").size(), 1U);
  const auto expected = gramian(knot_vector(2, {0, 0, 0, 1, 1, 1}), 0, 1, GramianMethod::gauss);
  ASSERT_TRUE(expected);
  expect_band(out.at("gramians").at("01").at("band"), *expected, 2);
}

TEST(GramianCommand, TheMethodIsTheOneThatWasUsed) {
  const auto used = [](const char* a, const char* b, const std::string& wanted,
                       const std::string& term) {
    const Json out = knead({"gramian", "--degree", "3", "--knots", thesis_knots, "--a", a, "--b", b,
                            "--method", wanted})
                         .json();
    const auto expected = gramian(knot_vector(3, {0, 0, 0, 0, 1, 2, 3, 3, 3, 3}), std::atoi(a),
                                  std::atoi(b), *gramian_method(wanted));
    expect_band(out.at("gramians").at(term).at("band"), *expected, 3);
    return out.at("method").get<std::string>();
  };
  EXPECT_EQ(used("2", "2", "recurrence", "22"), "recurrence");
  EXPECT_EQ(used("2", "0", "recurrence", "20"), "gauss");
  EXPECT_EQ(used("3", "3", "recurrence", "33"), "gauss");
  EXPECT_EQ(used("3", "1", "analytic", "31"), "analytic");
  EXPECT_EQ(used("3", "1", "gauss-reduced", "31"), "gauss-reduced");
  EXPECT_EQ(used("12", "1", "gauss", "12,1"), "gauss");  // above the degree, zero
  const Json tiny =
      knead({"gramian", "--degree", "1", "--knots", "0,0,1e-80,1e-80", "--all"}).json();
  EXPECT_EQ(tiny.at("method"), "gauss") << "out of the range of the recurrence";
}

TEST(GramianCommand, NumbersCarrySeventeenDigits) {
  const Outcome run =
      knead({"gramian", "--degree", "3", "--knots", thesis_knots, "--method", "gauss"});
  EXPECT_NE(run.out.find("0.14285714285714288"), std::string::npos)
      << run.out;  // the double nearest to 1/7, + 1 ulp
  EXPECT_NE(run.out.find("0.087499999999999994"), std::string::npos) << "not shortened to 0.0875";
}

TEST(GramianCommand, AKnotListMayBeginWithAMinusSign) {
  const auto band = [](const std::vector<std::string>& knots) {
    std::vector<std::string> arguments{"gramian", "--degree", "1", "--method", "gauss"};
    arguments.insert(arguments.end(), knots.begin(), knots.end());
    const Outcome run = knead(arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json().at("gramians");
  };
  const Json expected = band({"--knots", "0,0,2,2"});
  EXPECT_EQ(band({"--knots", "-1,-1,1,1"}), expected);
  EXPECT_EQ(band({"--knots=-1,-1,1,1"}), expected);
  EXPECT_EQ(band({"--knots", "-1e0,-1.0,+1,1."}), expected);
}

TEST(GramianCommand, KnotsMayComeFromAFile) {
  const Workshop workshop;
  const std::string list = "0,0,0,0,1,2,3,3,3,3";
  const Outcome direct = knead({"gramian", "--degree", "3", "--knots", list, "--all"});
  for (const char* text :
       {"0,0,0,0,1,2,3,3,3,3\n", "0 0\t0 0\r\n1\n2\n3 3 3 3", "0,\n0,\n0,\n0,\n1,2,3,3,3,3,\n"}) {
    const Outcome run = knead(
        {"gramian", "--degree", "3", "--knots-file", workshop.file("knots.txt", text), "--all"});
    EXPECT_EQ(run.out, direct.out) << text;
  }
}

TEST(GramianCommand, CsvHasTheSameEntries) {
  std::vector<std::string> arguments{"gramian", "--degree", "1", "--knots", "0,0,1,2,2", "--all"};
  const Json gramians = knead(arguments).json().at("gramians");
  arguments.insert(arguments.end(), {"--format", "csv"});
  std::istringstream csv(knead(arguments).out);
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  EXPECT_EQ(line, "term,i,j,value");
  int entries = 0;
  for (; std::getline(csv, line); ++entries) {
    char term[3] = {};
    std::size_t i = 0, j = 0;
    double value = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%2[0-2],%zu,%zu,%lg", term, &i, &j, &value), 4) << line;
    EXPECT_EQ(gramians.at(term).at("band").at(i).at(j + 1 - i).get<double>(), value) << line;
  }
  EXPECT_EQ(entries, 4 * 7) << "entries outside of the matrix are left out";
}

TEST(GramianCommand, WhatIsWrongIsNamed) {
  const auto fails = [](std::vector<std::string> arguments, int code,
                        const std::vector<std::string>& named) {
    arguments.insert(arguments.begin(), "gramian");
    return fails_with(knead(arguments), code, named);
  };
  EXPECT_TRUE(fails({"--degree", "3"}, 2, {"--knots"}));
  EXPECT_TRUE(fails({"--knots", "0,0,1,1"}, 2, {"--degree"}));
  EXPECT_TRUE(fails({"--degree", "x", "--knots", "0,0,1,1"}, 2, {"--degree"}));
  EXPECT_TRUE(fails({"--degree", "26", "--knots", "0,0,1,1"}, 2, {"26", "1 to 25"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,z,1"}, 2, {"--knots", "entry 2", "\"z\""}));
  EXPECT_TRUE(
      fails({"--degree", "1", "--knots", "0,0,nan,1"}, 2, {"--knots", "entry 2", "finite"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,,0,1,1"}, 2, {"--knots", "entry 1", "comma"}));
  EXPECT_TRUE(
      fails({"--degree", "1", "--knots", "0,0,2,1,3,3"}, 2, {"knot 3", "decrease", "sort"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,1,1,1,2,2"}, 2, {"knot 4", "repeated"}));
  EXPECT_TRUE(fails({"--degree", "3", "--knots", "0,0,1,1"}, 2, {"too few", "8"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,1,1", "--a", "26"}, 2, {"--a", "0 to 25"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,1,1", "--b", "-1"}, 2, {"--b"}));
  EXPECT_TRUE(
      fails({"--degree", "1", "--knots", "0,0,1,1", "--a", "1", "--all"}, 2, {"--a", "--all"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,1,1", "--method", "simpson"}, 2,
                    {"simpson", "gauss", "analytic"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,1,1", "--format", "xml"}, 2,
                    {"--format", "json", "csv"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots", "0,0,1,1", "--knots-file", "x"}, 2,
                    {"--knots-file", "either"}));
  EXPECT_TRUE(fails({"--degree", "1", "--knots-file", "/no/such/file"}, 3, {"/no/such/file"}));
  const Workshop workshop;
  const std::string words = workshop.file("words.txt", "0 0 one one");
  EXPECT_TRUE(fails({"--degree", "1", "--knots-file", words}, 3, {words, "entry 2", "\"one\""}));
  const std::string few = workshop.file("few.txt", "0 0 1");
  EXPECT_TRUE(fails({"--degree", "1", "--knots-file", few}, 3, {few, "too few"}));
}

TEST(GramianCommand, NumbersBeyondDoubleAreANumericalFailure) {
  const std::string k = "1e-200";
  const std::string knots = "0,0,0,0," + k + "," + k + "," + k + "," + k;
  EXPECT_TRUE(fails_with(
      knead({"gramian", "--degree", "3", "--knots", knots, "--all", "--method", "gauss"}), 4,
      {"Gramian 22", "scale the knots"}));
}

TEST(GramianCommand, TheAnalyticMethodSaysHowManyDigitsAreLeft) {
  const auto run = [](const std::string& knots) {
    return knead({"gramian", "--degree", "3", "--knots", knots, "--all", "--method", "analytic"});
  };
  const Outcome even = run("0,1,2,3,4,5,6,7,8");
  EXPECT_EQ(even.err, "");
  EXPECT_GT(even.json().at("digits").get<double>(), 12);
  const Outcome close = run("0,1,2,3,4,4.000000001,6,7,8");
  EXPECT_EQ(close.code, 0);
  EXPECT_LT(close.json().at("digits").get<double>(), 8);
  EXPECT_NE(close.err.find("knead: warning: the method analytic has"), std::string::npos)
      << close.err;
  EXPECT_FALSE(
      knead({"gramian", "--degree", "3", "--knots", "0,1,2,3,4,5,6,7,8", "--method", "recurrence"})
          .json()
          .contains("digits"));
}

}  // namespace
}  // namespace knead::testing
