// Loads and coefficients by samples, mirrored tools, the force route and lattices as commands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::first;
using testing::fresh;
using testing::refusal;
using testing::run;

const std::string sheet = R"({"do":"new","size":[1,1],"net":[12,12]})";

double highest(const Session& session) {
  return first(session).current->control_points().col(2).maxCoeff();
}

TEST(Command, ALoadBySamplesIsTheLoadThatTheySay) {
  // Constant samples are the constant load; linear ones lift one side more.
  Session constant = fresh(), sampled = fresh(), slanted = fresh();
  const std::string edge = R"({"do":"edge","hold":"position"})",
                    solve = R"({"do":"evolve","mode":"static"})";
  run(constant, {sheet, edge, R"({"do":"load","vector":[0,0,0.01]})", solve});
  run(sampled,
      {sheet, edge,
       R"({"do":"load","counts":[2,2],"samples":[[0,0,0.01],[0,0,0.01],[0,0,0.01],[0,0,0.01]]})",
       solve});
  run(slanted,
      {sheet, edge,
       R"({"do":"load","counts":[2,2],"samples":[[0,0,0],[0,0,0],[0,0,0.02],[0,0,0.02]]})", solve});
  const Points a = first(constant).current->control_points(),
               b = first(sampled).current->control_points(),
               c = first(slanted).current->control_points();
  EXPECT_GT(highest(constant), 1e-4);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(c(8 * 12 + 6, 2), 1.2 * c(3 * 12 + 6, 2));
  EXPECT_EQ(refusal(sampled, R"({"do":"load","counts":[2,2],"samples":[[0,0,1]]})").kind,
            ErrorKind::input);
  EXPECT_EQ(refusal(sampled, R"({"do":"load","counts":[1,2],"samples":[[0,0,1],[0,0,1]]})").kind,
            ErrorKind::input);
}

TEST(Command, ACoefficientBySamplesVariesAsTheySay) {
  Session uniform = fresh(), stiff = fresh();
  const std::vector<std::string> rest = {R"({"do":"edge","hold":"position"})",
                                         R"({"do":"load","vector":[0,0,0.01]})",
                                         R"({"do":"evolve","mode":"static"})"};
  run(uniform, {sheet});
  run(uniform, rest);
  run(stiff,
      {sheet, R"({"do":"material","coefficient":"alpha11","counts":[2,2],"samples":[1,1,50,50]})"});
  run(stiff, rest);
  const Points &a = first(uniform).current->control_points(),
               &b = first(stiff).current->control_points();
  EXPECT_NEAR(a(8 * 12 + 6, 2), a(3 * 12 + 6, 2), 1e-12);
  EXPECT_LT(b(8 * 12 + 6, 2), 0.7 * b(3 * 12 + 6, 2));
  EXPECT_EQ(refusal(stiff,
                    R"({"do":"material","coefficient":"gamma","counts":[2,2],"samples":[1,1,1,1]})")
                .where,
            "coefficient");
  EXPECT_EQ(
      refusal(stiff,
              R"({"do":"material","coefficient":"beta11","counts":[2,2],"samples":[1,1,-1,1]})")
          .kind,
      ErrorKind::input);
}

/// What a coefficient is at fractions of the domain.
double coefficient_at(const Coefficient<2>& c, double s, double t) {
  const double u[] = {s}, v[] = {t};
  const auto values = std::get<SplineField<2>>(c).on_grid({u, v});
  EXPECT_TRUE(values);
  return values ? values->front() : 0;
}

std::string by_formula(const std::string& coefficient, const std::string& formula,
                       const std::string& more = "") {
  return R"({"do":"material","coefficient":")" + coefficient + R"(","formula":")" + formula + "\"" +
         more + "}";
}

TEST(Command, ACoefficientByFormulaIsWhatItSaysToTheTolerance) {
  Session session = fresh();
  run(session,
      {sheet, by_formula("beta11", "1+4*exp(-40*((s-.5)^2+(t-.5)^2))", R"(,"tolerance":1e-6)"),
       by_formula("alpha22", "1 + x^2 + 2*y")});
  const MaterialFieldOf<2>& material = first(session).material;
  const Surface& shape = *first(session).current;
  double beta = 0, alpha = 0;
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const double s = i / 40.0, t = j / 40.0;
      const double swelling = 1 + 4 * std::exp(-40 * (std::pow(s - 0.5, 2) + std::pow(t - 0.5, 2)));
      beta = std::max(beta, std::abs(coefficient_at(material.beta[0], s, t) - swelling));
      const auto place = evaluate(shape, Parameters<2>{{s, t}});
      ASSERT_TRUE(place);
      const double x = place->points()(0, 0), y = place->points()(0, 1);
      alpha =
          std::max(alpha, std::abs(coefficient_at(material.alpha[2], s, t) - (1 + x * x + 2 * y)));
    }
  }
  EXPECT_LE(beta, 1e-6);
  EXPECT_LE(alpha, 4e-6);  // 1e-6 of the largest value, 4
  EXPECT_EQ(refusal(session, by_formula("beta11", "1 +")).where, "formula: character 4");
  EXPECT_EQ(refusal(session, by_formula("beta11", "s - 0.5")).what,
            "the formula is -0.5 at s = 0, t = 0");
  EXPECT_EQ(refusal(session, by_formula("beta11", "1/(s - 0.5)^2")).kind, ErrorKind::input);
  EXPECT_EQ(refusal(session, R"({"do":"material","formula":"s"})").where, "coefficient");
  EXPECT_EQ(refusal(session, by_formula("mass", "s", R"(,"tolerance":0)")).where, "tolerance");
  EXPECT_EQ(refusal(session, R"({"do":"material","alpha":[1,0,1],"tolerance":1})").where,
            "tolerance");
  run(session, {by_formula("alpha12", "-0.5*s")});  // which may be negative
}

TEST(Command, ALoadByFormulaIsTheLoadThatItSays) {
  const std::string edge = R"({"do":"edge","hold":"position"})",
                    solve = R"({"do":"evolve","mode":"static"})";
  const auto shape_under = [&](const std::string& load) {
    Session session = fresh();
    run(session, {sheet, edge, load, solve});
    return Points(first(session).current->control_points());
  };
  // A linear load is the same by samples and by formula, of fractions and of places.
  const Points samples = shape_under(
      R"({"do":"load","counts":[2,2],"samples":[[0,0,0],[0,0,0],[0,0,0.02],[0,0,0.02]]})");
  for (const std::string formula : {"0.02*s", "0.02*x"}) {
    const Points same = shape_under(R"({"do":"load","formula":["0","0",")" + formula + "\"]}");
    EXPECT_GT(same.col(2).maxCoeff(), 1e-4);
    EXPECT_LT((same - samples).cwiseAbs().maxCoeff(), 1e-12) << formula;
  }
  // Added to a constant one, and not polynomial: against a fine grid of samples.
  std::string fine;
  for (int k = 0; k < 201; ++k) {
    const double force = 0.01 + 0.02 * std::sin(std::numbers::pi * k / 200);
    for (int side = 0; side < 2; ++side)
      fine += fmt::format("{}[0,0,{:.17g}]", fine.empty() ? "" : ",", force);
  }
  const Points by_samples =
      shape_under(R"({"do":"load","counts":[201,2],"samples":[)" + fine + "]}");
  const Points both =
      shape_under(R"({"do":"load","vector":[0,0,0.01],"formula":["0","0","0.02*sin(pi*s) + )"
                  R"(0"],"tolerance":1e-9})");
  EXPECT_LT((both - by_samples).cwiseAbs().maxCoeff(),
            5e-5 * both.col(2).maxCoeff());  // h² of the samples
  Session session = fresh();
  run(session, {sheet});
  EXPECT_EQ(refusal(session, R"({"do":"load","formula":["0","0"]})").kind, ErrorKind::input);
  EXPECT_EQ(refusal(session, R"({"do":"load","formula":["0","y +","0"]})").where,
            "formula[1]: character 4");
  EXPECT_EQ(refusal(session, R"({"do":"load","tolerance":1e-3})").where, "tolerance");
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
      {sheet, hold, left, right,
       R"({"do":"force","name":"a","at":[0.25,0.25],"to":[0.25,0.25,0.1],"strength":0.1})",
       R"({"do":"force","name":"b","at":[0.75,0.25],"to":[0.75,0.25,0.1],"strength":0.1})", step});
  const Points &a = first(mirrored).current->control_points(),
               &b = first(both).current->control_points();
  EXPECT_LT(a.col(2).minCoeff(), -0.01);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Command, AForceIsMirroredAtTheSurfaceItWasMadeFor) {
  const std::string beside = R"({"do":"new","net":[7,7],"position":[5,0,0]})",
                    force = R"({"do":"force","at":[0.2,0.5],"to":[5.2,0.5,1],"strength":100})",
                    step = R"({"do":"step","count":3})";
  Session alone = fresh(), both = fresh();
  run(alone, {beside, R"({"do":"symmetry","mirror":"u"})", force, step});
  run(both, {R"({"do":"new","net":[7,7]})", beside, R"({"do":"select","surface":"#2"})",
             R"({"do":"symmetry","mirror":"u"})", force,
             R"({"do":"select","surfaces":["#1","#2"]})", step});
  EXPECT_EQ(both.largest_displacement(0), 0);
  const Points &a = first(alone).current->control_points(),
               &b = both.state().surfaces[1].current->control_points();
  EXPECT_GT(a.col(2).minCoeff(), 0.9);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9);
  const Points& rest = both.state().surfaces[1].rest->control_points();
  for (int k = 0; k < 49; ++k) {  // as in a mirror at x = 5.5; the field u varies slowest
    const int image = (6 - k / 7) * 7 + k % 7;
    EXPECT_NEAR(b(k, 0) - rest(k, 0), rest(image, 0) - b(image, 0), 1e-12);
    EXPECT_NEAR(b(k, 2), b(image, 2), 1e-12);
  }
}

TEST(Command, TheAnalyticRouteIsCloseToGauss) {
  Session gauss = fresh(), analytic = fresh();
  const std::vector<std::string> press = {
      R"({"do":"edge","hold":"position"})",
      R"({"do":"tool","radius":0.3,"position":[0.5,0.47,0.25],"stiffness":50})"};
  for (auto* session : {&gauss, &analytic}) {
    run(*session, {sheet});
    run(*session, press);
  }
  run(gauss, {R"({"do":"evolve","mode":"static"})"});
  run(analytic, {R"({"do":"evolve","mode":"static","route":"analytic"})"});
  const Points &a = first(gauss).current->control_points(),
               &b = first(analytic).current->control_points();
  EXPECT_LT(a.col(2).minCoeff(), -0.005);
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 0);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 0.2 * -a.col(2).minCoeff());
}

TEST(Command, ALatticeCarriesTheSurfaceAlongAsOneStepOfUndo) {
  Session session = fresh();
  run(session, {sheet, R"({"do":"tool","radius":0.25,"position":[0.5,0.5,0.3]})"});
  const Points before = first(session).current->control_points();
  run(session,
      {R"({"do":"lattice","net":[6,6,4],"degree":[2,2,2],"margin":0.1,"steps":4,"hold":["u0",)"
       R"("u1"]})"});
  const Points after = first(session).current->control_points();
  EXPECT_LT(after.col(2).minCoeff(), -0.01);
  EXPECT_EQ(first(session).rest, first(session).current);
  run(session, {R"({"do":"undo"})"});
  EXPECT_EQ(first(session).current->control_points(), before);
  EXPECT_EQ(refusal(session, R"({"do":"lattice","hold":["top"]})").where, "hold[0]");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","margin":0})").where, "margin");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","steps":0})").where, "steps");
}

TEST(Command, AControlPointOfALatticeIsMovedByHandAndTheSurfaceFollows) {
  Session session = fresh();
  run(session, {sheet});
  const Points before = first(session).current->control_points();
  // All points of the block: the surface is carried along as a rigid body, to rounding.
  std::string all;
  for (int k = 0; k < 64; ++k) all += (k > 0 ? "," : "") + std::to_string(k);
  run(session, {R"({"do":"lattice","net":[4,4,4],"which":[)" + all + R"(],"by":[0.1,0,-0.2]})"});
  Points carried = before;
  carried.rowwise() += Eigen::RowVector3d(0.1, 0, -0.2);
  EXPECT_LT((first(session).current->control_points() - carried).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(first(session).rest, first(session).current);
  run(session, {R"({"do":"undo"})"});
  // One point, twice named: x moves by N_i(u) N_j(v) N_k(w) times the move.
  run(session, {R"({"do":"lattice","net":[4,4,4],"degree":[3,3,3],"margin":0.25,"which":[21,21],)"
                R"("by":[0,0,1]})"});
  const Points after = first(session).current->control_points();
  const Point lower = before.colwise().minCoeff().transpose(),
              upper = before.colwise().maxCoeff().transpose();
  const double margin = 0.25 * (upper - lower).norm();
  const auto bernstein = [](double u) {
    return 3 * u * (1 - u) * (1 - u);
  };  // number 1 of four cubic ones
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    double share = 1;
    for (Eigen::Index d = 0; d < 3; ++d) {
      share *= bernstein((before(i, d) - lower[d] + margin) / (upper[d] - lower[d] + 2 * margin));
    }
    EXPECT_NEAR(after(i, 2) - before(i, 2), share, 1e-14);
    EXPECT_EQ(after(i, 0), before(i, 0));
  }
  EXPECT_EQ(refusal(session, R"({"do":"lattice","net":[4,4,4],"which":[64],"by":[0,0,1]})").where,
            "which[0]");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","which":[1]})").where, "by");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","by":[0,0,1]})").where, "which");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","which":[1],"by":[0,0,1],"hold":["u0"]})").where,
            "hold");
}

/// A pull of one control point of a block of 4 × 4 × 4.
std::string pull(int which, const std::string& by, bool again) {
  return R"({"do":"lattice","net":[4,4,4],"which":[)" + std::to_string(which) + R"(],"by":)" + by +
         (again ? R"(,"again":true})" : "}");
}

TEST(Command, ALatticeThatIsPulledOnDeformsTheShapeThatItWasPutRound) {
  const auto after = [](const std::vector<std::string>& commands) {
    Session session = fresh();
    run(session, {sheet});
    run(session, commands);
    return Points(first(session).current->control_points());
  };
  const std::string up = "[0,0,0.4]", side = "[0.3,0.1,0]", back = "[0,0,-0.4]";
  const Points start = after({}), one = after({pull(21, up, false)}),
               two = after({pull(38, side, false)});
  const Points both = after({pull(21, up, false), pull(38, side, true)});
  // The pulls add up as displacements of the first shape.
  EXPECT_LT((both - (one + two - start)).cwiseAbs().maxCoeff(), 1e-15);
  // Round the new shape it is another block.
  EXPECT_GT((after({pull(21, up, false), pull(38, side, false)}) - both).cwiseAbs().maxCoeff(),
            1e-3);
  // In either order, and back again.
  EXPECT_EQ(after({pull(38, side, false), pull(21, up, true)}), both);
  EXPECT_LT((after({pull(21, up, false), pull(21, back, true)}) - start).cwiseAbs().maxCoeff(),
            1e-16);
}

TEST(Command, APulledLatticeIsInTheHistoryTheJournalAndTheSnapshot) {
  Session session = fresh();
  run(session, {sheet, pull(21, "[0,0,0.4]", false), pull(38, "[0.3,0.1,0]", true)});
  const Points both = first(session).current->control_points();
  run(session, {R"({"do":"undo"})", R"({"do":"undo"})", R"({"do":"redo"})", R"({"do":"redo"})"});
  EXPECT_EQ(first(session).current->control_points(), both);
  auto restored = Session::restore(Document::fresh("test"), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  Session replayed = fresh();
  for (const Command& command : session.journal()) ASSERT_TRUE(replayed.execute(command));
  for (Session* each : {&session, &*restored, &replayed})
    run(*each, {pull(42, "[0,0,-0.2]", true)});
  EXPECT_GT((first(session).current->control_points() - both).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_EQ(first(*restored).current->control_points(), first(session).current->control_points());
  EXPECT_EQ(first(replayed).current->control_points(), first(session).current->control_points());
}

TEST(Command, ALatticeIsNotPulledOnWhereTheSurfacesHaveChanged) {
  Session session = fresh();
  run(session, {sheet});
  const std::string on = pull(21, "[0,0,0.1]", true);
  EXPECT_EQ(refusal(session, on).where, "again");
  run(session, {pull(21, "[0,0,0.4]", false)});
  EXPECT_EQ(
      refusal(session, R"({"do":"lattice","net":[4,4,5],"which":[21],"by":[0,0,1],"again":true})")
          .where,
      "again");
  EXPECT_EQ(refusal(session, R"({"do":"lattice","net":[4,4,4],"again":true})").where, "again");
  run(session, {R"({"do":"hold","rows":1})", on});  // the shape is the same
  run(session, {R"({"do":"points","which":[5],"by":[0,0,0.1]})"});
  EXPECT_EQ(refusal(session, on).where, "again");
  run(session, {R"({"do":"undo"})", on});
  run(session, {R"({"do":"refine","region":[[0,1],[0,1]]})"});
  EXPECT_EQ(refusal(session, on).where, "again");
}

}  // namespace
}  // namespace knead
