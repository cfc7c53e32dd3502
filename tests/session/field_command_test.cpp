// Loads and coefficients by samples, mirrored tools, the force route and lattices as commands.
#include <gtest/gtest.h>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::first;
using testing::fresh;
using testing::refusal;
using testing::run;

const std::string sheet = R"({"do":"new","size":[1,1],"net":[12,12]})";

double highest(const Session& session) { return first(session).current->control_points().col(2).maxCoeff(); }

TEST(Command, ALoadBySamplesIsTheLoadThatTheySay) {
  // Constant samples are the constant load; linear ones lift one side more.
  Session constant = fresh(), sampled = fresh(), slanted = fresh();
  const std::string edge = R"({"do":"edge","hold":"position"})", solve = R"({"do":"evolve","mode":"static"})";
  run(constant, {sheet, edge, R"({"do":"load","vector":[0,0,0.01]})", solve});
  run(sampled,
      {sheet, edge, R"({"do":"load","counts":[2,2],"samples":[[0,0,0.01],[0,0,0.01],[0,0,0.01],[0,0,0.01]]})", solve});
  run(slanted,
      {sheet, edge, R"({"do":"load","counts":[2,2],"samples":[[0,0,0],[0,0,0],[0,0,0.02],[0,0,0.02]]})", solve});
  const Points a = first(constant).current->control_points(), b = first(sampled).current->control_points(),
               c = first(slanted).current->control_points();
  EXPECT_GT(highest(constant), 1e-4);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(c(8 * 12 + 6, 2), 1.2 * c(3 * 12 + 6, 2));
  EXPECT_EQ(refusal(sampled, R"({"do":"load","counts":[2,2],"samples":[[0,0,1]]})").kind, ErrorKind::input);
  EXPECT_EQ(refusal(sampled, R"({"do":"load","counts":[1,2],"samples":[[0,0,1],[0,0,1]]})").kind, ErrorKind::input);
}

TEST(Command, ACoefficientBySamplesVariesAsTheySay) {
  Session uniform = fresh(), stiff = fresh();
  const std::vector<std::string> rest = {R"({"do":"edge","hold":"position"})", R"({"do":"load","vector":[0,0,0.01]})",
                                         R"({"do":"evolve","mode":"static"})"};
  run(uniform, {sheet});
  run(uniform, rest);
  run(stiff, {sheet, R"({"do":"material","coefficient":"alpha11","counts":[2,2],"samples":[1,1,50,50]})"});
  run(stiff, rest);
  const Points &a = first(uniform).current->control_points(), &b = first(stiff).current->control_points();
  EXPECT_NEAR(a(8 * 12 + 6, 2), a(3 * 12 + 6, 2), 1e-12);
  EXPECT_LT(b(8 * 12 + 6, 2), 0.7 * b(3 * 12 + 6, 2));
  EXPECT_EQ(refusal(stiff, R"({"do":"material","coefficient":"gamma","counts":[2,2],"samples":[1,1,1,1]})").where,
            "coefficient");
  EXPECT_EQ(refusal(stiff, R"({"do":"material","coefficient":"beta11","counts":[2,2],"samples":[1,1,-1,1]})").kind,
            ErrorKind::input);
}

TEST(Command, MirrorSymmetryMirrorsToolsAndForces) {
  Session mirrored = fresh(), both = fresh();
  const std::string hold = R"({"do":"edge","hold":"position"})";
  const std::string left = R"({"do":"tool","name":"a","radius":0.1,"position":[0.25,0.5,0.07]})",
                    right = R"({"do":"tool","name":"b","radius":0.1,"position":[0.75,0.5,0.07]})",
                    step = R"({"do":"step","count":5})";
  run(mirrored, {sheet, hold, R"({"do":"symmetry","mirror":"u"})", left,
                 R"({"do":"force","at":[0.25,0.25],"to":[0.25,0.25,0.1],"strength":0.1})", step});
  run(both,
      {sheet, hold, left, right, R"({"do":"force","name":"a","at":[0.25,0.25],"to":[0.25,0.25,0.1],"strength":0.1})",
       R"({"do":"force","name":"b","at":[0.75,0.25],"to":[0.75,0.25,0.1],"strength":0.1})", step});
  const Points &a = first(mirrored).current->control_points(), &b = first(both).current->control_points();
  EXPECT_LT(a.col(2).minCoeff(), -0.01);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Command, TheAnalyticRouteIsCloseToGauss) {
  Session gauss = fresh(), analytic = fresh();
  const std::vector<std::string> press = {R"({"do":"edge","hold":"position"})",
                                          R"({"do":"tool","radius":0.3,"position":[0.5,0.47,0.25],"stiffness":50})"};
  for (auto* session : {&gauss, &analytic}) {
    run(*session, {sheet});
    run(*session, press);
  }
  run(gauss, {R"({"do":"evolve","mode":"static"})"});
  run(analytic, {R"({"do":"evolve","mode":"static","route":"analytic"})"});
  const Points &a = first(gauss).current->control_points(), &b = first(analytic).current->control_points();
  EXPECT_LT(a.col(2).minCoeff(), -0.005);
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 0);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 0.2 * -a.col(2).minCoeff());
}

TEST(Command, ALatticeCarriesTheSurfaceAlongAsOneStepOfUndo) {
  Session session = fresh();
  run(session, {sheet, R"({"do":"tool","radius":0.25,"position":[0.5,0.5,0.3]})"});
  const Points before = first(session).current->control_points();
  run(session, {R"({"do":"lattice","net":[6,6,4],"degree":[2,2,2],"margin":0.1,"steps":4,"hold":["u0","u1"]})"});
  const Points after = first(session).current->control_points();
  EXPECT_LT(after.col(2).minCoeff(), -0.01);
  EXPECT_EQ(first(session).rest, first(session).current);
  run(session, {R"({"do":"undo"})"});
  EXPECT_EQ(first(session).current->control_points(), before);
  EXPECT_EQ(refusal(session, R"({"do":"lattice","hold":["top"]})").where, "hold");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","margin":0})").where, "margin");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","steps":0})").where, "steps");
}

}  // namespace
}  // namespace knead
