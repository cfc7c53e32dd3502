#include "program.hpp"

namespace knead::testing {
namespace {

TEST(StiffnessCommand, ReproducesThePublishedCheckValues) {
  // Thesis Eq. 4.8 with all six terms on open uniform knots, p = 3, 128²: nnz = (7·128 − 12)², norm
  // to 12 digits.
  for (const char* method : {"gauss", "analytic", "recurrence"}) {
    const Json out = knead({"stiffness", "--degree", "3", "--net", "128x128", "--alpha",
                            "1,0.3,0.5", "--beta", "1e-3,2e-3,5e-4", "--method", method, "--json"})
                         .json();
    EXPECT_EQ(out.at("rows"), 16384);
    EXPECT_EQ(out.at("nnz"), 781456);
    EXPECT_NEAR(out.at("frobenius").get<double>(), 1.14119150436e4, 0.5e-7) << method;
    EXPECT_GT(out.at("seconds").get<double>(), 0);
  }
}

TEST(StiffnessCommand, TheTwoDirectionsMayDiffer) {
  const auto norm = [](const std::string& degree, const std::string& net,
                       const std::string& alpha) {
    return knead({"stiffness", "--degree", degree, "--net", net, "--alpha", alpha, "--json"})
        .json();
  };
  const Json a = norm("2x3", "7x9", "1,0.25,2"), b = norm("3x2", "9x7", "2,0.25,1");
  EXPECT_EQ(a.at("rows"), 63);
  EXPECT_NEAR(a.at("frobenius").get<double>(), b.at("frobenius").get<double>(), 1e-14 * 63);
}

TEST(StiffnessCommand, TakesKnotsAndWeights) {
  const auto out = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {"stiffness", "--degree", "2x1", "--beta", "0.1,0.2,0.3", "--json"});
    return knead(arguments).json();
  };
  const std::string u = "0,0,0,0.5,1,1,1", v = "0,0,1,1", ones = "1,1,1,1,1,1,1,1";
  const Json uniform = out({"--net", "4x2"}), given = out({"--knots-u", u, "--knots-v", v});
  EXPECT_EQ(given.at("rows"), 8);
  EXPECT_EQ(given.at("frobenius"), uniform.at("frobenius"));
  const double norm = given.at("frobenius");
  EXPECT_NEAR(
      out({"--knots-u", u, "--knots-v", v, "--weights", ones}).at("frobenius").get<double>(), norm,
      1e-12 * norm);
  const Json rational = out({"--knots-u", u, "--knots-v", v, "--weights", "1,1,0.5,0.5,1,1,2,1"});
  EXPECT_GT(std::abs(rational.at("frobenius").get<double>() - norm), 0.01 * norm);
  EXPECT_TRUE(fails_with(knead({"stiffness", "--knots-u", u}), 2, {"--net", "--knots-v"}));
  EXPECT_TRUE(fails_with(
      knead({"stiffness", "--degree", "2x1", "--knots-u", u, "--knots-v", v, "--weights", "1,2"}),
      2, {"weight"}));
}

TEST(StiffnessCommand, OfAWeightedNetKeepsATolerance) {
  const auto run = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"stiffness", "--degree", "2", "--knots-u", "0,0,0,1,1,1",
                                         "--knots-v", "0,0,0,1,1,1", "--beta", "1,1,1"});
    return knead(arguments);
  };
  const std::string weights = "1,0.1,2,5,10,0.3,1,1,4";
  const Json usual = run({"--weights", weights, "--json"}).json(),
             coarse = run({"--weights", weights, "--tolerance", "1e-4", "--json"}).json();
  EXPECT_LE(usual.at("error_bound").get<double>(), 1e-10);
  EXPECT_LE(coarse.at("error_bound").get<double>(), 1e-4);
  EXPECT_GT(coarse.at("error_bound").get<double>(), usual.at("error_bound").get<double>());
  const double norm = usual.at("frobenius");
  EXPECT_NEAR(coarse.at("frobenius").get<double>(), norm, 1e-3 * norm);
  EXPECT_NE(run({"--weights", weights}).out.find("no entry errs by more than"), std::string::npos);
  // The thesis' approximation has no bound, and needs one here.
  const Json constant = run({"--weights", weights, "--denominator", "constant", "--json"}).json();
  EXPECT_TRUE(constant.at("error_bound").is_null());
  EXPECT_GT(std::abs(constant.at("frobenius").get<double>() - norm), 0.5 * norm);
  EXPECT_EQ(knead({"stiffness", "--net", "4x4", "--json"}).json().at("error_bound"), 0);

  EXPECT_TRUE(fails_with(run({"--weights", "1,1e-40,2,5,1e40,0.3,1,1,4"}), 4,
                         {"1e-40 to 1e+40", "larger tolerance"}));
  EXPECT_TRUE(fails_with(run({"--tolerance", "0"}), 2, {"--tolerance", "0"}));
  EXPECT_TRUE(fails_with(run({"--denominator", "some"}), 2, {"--denominator", "some", "constant"}));
}

TEST(StiffnessCommand, NegativeCoefficientsAreReadAsNumbers) {
  EXPECT_EQ(knead({"stiffness", "--net", "4x4", "--alpha", "1,-0.5,1", "--json"}).code, 0);
  EXPECT_TRUE(
      fails_with(knead({"stiffness", "--net", "4x4", "--alpha", "-1,0,1"}), 2, {"alpha11", "-1"}));
}

TEST(StiffnessCommand, WhatIsWrongIsNamed) {
  const auto fails = [](std::vector<std::string> arguments, int code,
                        const std::vector<std::string>& named) {
    arguments.insert(arguments.begin(), "stiffness");
    return fails_with(knead(arguments), code, named);
  };
  EXPECT_TRUE(fails({}, 2, {"--net", "knead stiffness --help"}));
  EXPECT_TRUE(fails({"--net", "4"}, 2, {"--net", "64x64"}));
  EXPECT_TRUE(fails({"--net", "4x4x4"}, 2, {"--net", "64x64"}));
  EXPECT_TRUE(fails({"--net", "2x4"}, 2, {"--net", "first", "at least 4"}));
  EXPECT_TRUE(fails({"--net", "4x4", "--alpha", "1,1"}, 2, {"--alpha", "three"}));
  EXPECT_TRUE(fails({"--net", "4x4", "--alpha", "1,2,1"}, 2, {"alpha12"}));
  EXPECT_TRUE(fails({"--net", "4x4", "--beta", "0,x,0"}, 2, {"--beta", "entry 1"}));
  EXPECT_TRUE(fails({"--net", "100000x100000"}, 2, {"--net", "too large", "at most"}));
  EXPECT_TRUE(
      fails({"--net", "3000x3000"}, 2, {"--net", "4.4e+08", "2e+08"}));  // before it takes them
  EXPECT_TRUE(fails({"--net", "8x8", "--alpha", "1e305,0,1e305"}, 4, {"range"}));
}

}  // namespace
}  // namespace knead::testing
