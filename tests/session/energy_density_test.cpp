#include "scene/energy_density.hpp"

#include <cmath>

#include "base/gauss_legendre.hpp"
#include "scene/held_points.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::ball;
using testing::first;
using testing::fresh;
using testing::on_sheet;
using testing::run;

/// ∫ density over the scaled domain, by Gauss points in the cells between all knots and `breaks`
/// (fractions).
double integral(const Session& session, int points, const std::vector<double>& breaks = {}) {
  const SceneSurface& s = first(session);
  const auto rule = gauss_legendre(points);
  std::array<std::vector<double>, 2> at, weights;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = s.current->knots()[d];
    std::vector<double> ends;
    for (int span : knots.spans()) ends.push_back(knots[span]);
    ends.push_back(knots.domain().upper);
    for (double b : breaks) ends.push_back(knots.domain().lower + b * knots.domain().length());
    std::ranges::sort(ends);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      for (int g = 0; g < points; ++g) {
        const double half = 0.5 * (ends[k + 1] - ends[k]);
        at[d].push_back(ends[k] + half * (1 + rule.abscissae[static_cast<std::size_t>(g)]));
        weights[d].push_back(half * rule.weights[static_cast<std::size_t>(g)]);
      }
    }
  }
  std::array<BasisTable, 2> tables;
  for (std::size_t d = 0; d < 2; ++d) tables[d] = *tabulate_basis(s.current->knots()[d], at[d], 2);
  const auto scaling = energy_scaling(energy_scaling_input(session.state(), 0));
  const auto density = energy_density(s, *scaling, {at[0], at[1]}, {&tables[0], &tables[1]});
  double sum = 0;
  for (std::size_t k = 0; k < at[0].size(); ++k) {
    for (std::size_t l = 0; l < at[1].size(); ++l) {
      const double value = (*density)[k * at[1].size() + l];
      EXPECT_GE(value, -1e-15);
      sum += weights[0][k] * weights[1][l] * value;
    }
  }
  return sum * scaling->factors[0] * scaling->factors[1];
}

TEST(EnergyDensity, IntegratesToTheEnergyThatStepsReport) {
  Session session = on_sheet({R"({"do":"material","alpha":[2,0.7,1],"beta":[0.01,0.03,0.02]})",
                              ball, R"({"do":"step","count":3})"});
  const double energy = *session.energy();
  ASSERT_GT(energy, 0);
  EXPECT_NEAR(session.state().steps.back().energy, energy, 1e-12 * energy);
  EXPECT_NEAR(integral(session, 4), energy, 1e-11 * energy) << "degree 6: exact with 4 points";
  run(session, {R"({"do":"remove"})", R"({"do":"points","which":[33],"by":[0,0,1]})"});
  EXPECT_NEAR(integral(session, 4), *session.energy(), 1e-11 * *session.energy());
}

TEST(EnergyDensity, KnowsVaryingMaterialsRawUnitsAndTheShapeItself) {
  Session varying = on_sheet(
      {R"({"do":"material","coefficient":"alpha11","counts":[3,3],"samples":[1,2,3,2,5,1,4,1,2]})",
       ball, R"({"do":"step","count":3})"});
  EXPECT_NEAR(integral(varying, 5, {0.5}), *varying.energy(), 1e-11 * *varying.energy());
  Session raw = fresh();
  run(raw, {R"({"do":"scaling","mode":"raw"})", R"({"do":"new","size":[30,10],"net":[8,9]})",
            R"({"do":"edge"})", R"({"do":"load","vector":[0,0,1]})", R"({"do":"step","count":3})"});
  EXPECT_NEAR(integral(raw, 4), *raw.energy(), 1e-11 * *raw.energy());
  Session itself =
      on_sheet({R"({"do":"points","which":[44],"by":[0,0,3]})", R"({"do":"rest","mode":"none"})"});
  EXPECT_NEAR(integral(itself, 4), *itself.energy(), 1e-11 * *itself.energy());
}

TEST(EnergyDensity, OfARationalSurfaceToQuadratureAccuracy) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"cylinder","radius":3,"height":5})", R"({"do":"hold","rows":1})",
       R"({"do":"tool","radius":1,"position":[3.5,0,2.5]})", R"({"do":"step","count":3})"});
  ASSERT_GT(*session.energy(), 0);
  EXPECT_NEAR(integral(session, 16), *session.energy(), 1e-8 * *session.energy());
}

TEST(HeldPoints, CoverEveryWayOfHolding) {
  const auto held = [](const std::vector<std::string>& commands) {
    Session session = fresh();
    run(session, {testing::new_sheet});
    run(session, commands);
    return *held_points(held_input(first(session)));
  };
  const auto count = [](const std::vector<std::uint8_t>& flags, int kind) {
    return std::ranges::count(flags, static_cast<std::uint8_t>(kind));
  };
  EXPECT_EQ(count(held({}), 0), 100);
  EXPECT_EQ(count(held({R"({"do":"hold","rows":2})"}), 1), 100 - 36);
  EXPECT_EQ(held({R"({"do":"pin","control_points":[[3,4]]})"})[34], 1);
  EXPECT_EQ(count(held({R"({"do":"edge","which":"u0","hold":"tangent"})"}), 1), 20);
  EXPECT_EQ(count(held({R"({"do":"freeze","region":[[0.5,0.5],[0.5,0.5]]})"}), 1), 16)
      << "one span of degree 3";
  EXPECT_EQ(count(held({R"({"do":"pin","at":[0.5,0.5]})"}), 2), 16);
  const auto line = held({R"({"do":"keep","u":0.49})"});
  EXPECT_EQ(count(line, 2), 40);
  EXPECT_EQ(count(held({R"({"do":"symmetry","mirror":"u"})"}), 0), 100);
  // What does not move at all counts more than a condition.
  EXPECT_EQ(count(held({R"({"do":"hold","rows":1})", R"({"do":"keep","u":0.49})"}), 1), 36);
}

}  // namespace
}  // namespace knead
