#include <cmath>

#include "program.hpp"

namespace knead::testing {
namespace {

const std::vector<std::string> bernstein = {"basis",       "--degree", "2", "--knots",
                                            "0,0,0,1,1,1", "--index",  "1"};

Outcome run(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return knead(arguments);
}

TEST(BasisCommand, SamplesTheFunctionOverItsDomain) {
  const Json out = run(bernstein, {"--samples", "5", "--format", "json"}).json();
  EXPECT_EQ(out.at("degree"), 2);
  EXPECT_EQ(out.at("count"), 3);
  EXPECT_EQ(out.at("derivative"), 0);
  ASSERT_EQ(out.at("samples").size(), 5U);
  for (const Json& s : out.at("samples")) {
    const double u = s.at(0).get<double>();
    EXPECT_DOUBLE_EQ(s.at(1).get<double>(), 2 * u * (1 - u));
  }
}

TEST(BasisCommand, PrintsCsvByDefault) {
  const Outcome out = run(bernstein, {"--derivative", "1", "--samples", "3"});
  EXPECT_EQ(out.code, 0);
  EXPECT_EQ(out.out, "u,value\n0,2\n0.5,0\n1,-2\n");
}

TEST(BasisCommand, IntegratesLeftAndRightOfTheSupport) {
  // ∫∫ 2u(1 − u) = u³/3 − u⁴/6 on [0, 1]; beyond, 1/6 + (u − 1)/3.
  const Json samples = run(bernstein, {"--integral", "2", "--from", "-1", "--to", "2", "--samples",
                                       "4", "--format", "json"})
                           .json()
                           .at("samples");
  EXPECT_EQ(samples.at(0).at(1), 0);
  EXPECT_EQ(samples.at(1).at(1), 0);
  EXPECT_DOUBLE_EQ(samples.at(2).at(1).get<double>(), 1.0 / 6);
  EXPECT_DOUBLE_EQ(samples.at(3).at(1).get<double>(), 0.5);
}

TEST(BasisCommand, ListsTheDiracWeightsOfTheThesis) {
  // The (p + 1)th derivative of the uniform linear hat on 0, 1, 2: impulses 1, −2, 1.
  const Json diracs = knead({"basis", "--degree", "1", "--knots", "0,1,2,3", "--index", "0",
                             "--derivative", "2", "--samples", "1", "--format", "json"})
                          .json()
                          .at("diracs");
  ASSERT_EQ(diracs.size(), 3U);
  const double weights[] = {1, -2, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(diracs.at(k).at("knot"), static_cast<double>(k));
    EXPECT_EQ(diracs.at(k).at("weight"), weights[k]);
  }
}

TEST(BasisCommand, RefusesWhatThereIsNot) {
  EXPECT_TRUE(
      fails_with(knead({"basis", "--degree", "2", "--knots", "0,0,0,1,1,1", "--index", "3"}), 2,
                 {"--index", "0 to 2"}));
  EXPECT_TRUE(fails_with(run(bernstein, {"--derivative", "-1"}), 2, {"--derivative"}));
  EXPECT_TRUE(fails_with(run(bernstein, {"--samples", "0"}), 2, {"--samples"}));
  EXPECT_TRUE(
      fails_with(run(bernstein, {"--integral", "1", "--derivative", "1"}), 2, {"--integral"}));
  EXPECT_TRUE(
      fails_with(knead({"basis", "--degree", "2", "--knots", "0,0,1,0,1,1"}), 2, {"knot 3"}));
}

const std::vector<std::string> arc = {"gramian",
                                      "--degree",
                                      "2",
                                      "--knots",
                                      "0,0,0,1,1,1",
                                      "--rational-weights",
                                      "1,0.70710678118654752,1"};

TEST(RationalGramianCommand, TellsItsErrorBound) {
  const Json fine = run(arc, {"--tolerance", "1e-12"}).json(),
             coarse = run(arc, {"--tolerance", "1e-4"}).json();
  EXPECT_EQ(fine.at("method"), "rational");
  EXPECT_LE(fine.at("error_bound").get<double>(), 1e-12);
  const double bound = coarse.at("error_bound").get<double>();
  EXPECT_GT(bound, 0);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t s = 0; s < 5; ++s) {
      const double exact = fine.at("gramians").at("00").at("band").at(i).at(s).get<double>();
      EXPECT_NEAR(coarse.at("gramians").at("00").at("band").at(i).at(s).get<double>(), exact,
                  bound + 1e-12);
      sum += exact;
    }
  }
  EXPECT_NEAR(sum, 1, 1e-11);  // the functions sum to one over a domain of length one
}

TEST(RationalGramianCommand, OffersTheConstantDenominatorByItsName) {
  const Json exact = run(arc, {}).json();
  const Json rough = run(arc, {"--method", "constant-denominator"}).json();
  EXPECT_EQ(rough.at("method"), "constant-denominator");
  EXPECT_FALSE(rough.contains("error_bound"));
  const auto entry = [](const Json& j) {
    return j.at("gramians").at("00").at("band").at(0).at(2).get<double>();
  };
  EXPECT_GT(std::abs(entry(rough) / entry(exact) - 1), 0.01);
}

TEST(RationalGramianCommand, RefusesWeightsThatDoNotFit) {
  EXPECT_TRUE(fails_with(
      knead({"gramian", "--degree", "1", "--knots", "0,0,1,1", "--rational-weights", "1"}), 2,
      {"weight"}));
  EXPECT_TRUE(fails_with(
      knead({"gramian", "--degree", "1", "--knots", "0,0,1,1", "--rational-weights", "1,-1"}), 2,
      {"weight"}));
  EXPECT_TRUE(fails_with(run(arc, {"--method", "gauss"}), 2, {"--method", "constant-denominator"}));
}

TEST(BasisCommand, ListsTheDerivativesOfImpulsesAtRepeatedKnots) {
  // (1 − u)² on [0, 1): its third derivative is 2 δ − 2 δ′ + δ″ at 0 and −2 δ at 1.
  const Json diracs = knead({"basis", "--degree", "2", "--knots", "0,0,0,1,1,1", "--derivative",
                             "3", "--samples", "1", "--format", "json"})
                          .json()
                          .at("diracs");
  EXPECT_EQ(
      diracs,
      Json::parse(
          R"([{"knot":0,"weight":2,"weights":[2,-2,1]},{"knot":1,"weight":-2,"weights":[-2]}])"));
}

}  // namespace
}  // namespace knead::testing
