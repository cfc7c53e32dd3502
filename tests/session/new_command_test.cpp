#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sheet.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::at;
using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

using testing::epsilon;

TEST(NewCommand, RoundShapesAreExactAndSelectThemselves) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"sphere","radius":2,"position":[10,0,0],"unit":"inch"})",
       R"({"do":"new","shape":"cylinder","radius":3,"height":5,"degree":[3,2],"net":[8,6]})",
       R"({"do":"new","shape":"torus","radius":4,"minor":0.5})",
       R"({"do":"new","shape":"revolution","profile":[[1,0],[3,2],[1,4],[2,6],[0,7]],)"
       R"("name":"vase"})"});
  const auto& surfaces = session.state().surfaces;
  ASSERT_EQ(surfaces.size(), 4U);
  EXPECT_EQ(session.state().selection(), std::vector<int>{3});
  EXPECT_EQ(surfaces[1].current->net(), (std::array<int, 2>{9, 6}));
  EXPECT_EQ(surfaces[1].current->knots(1).degree(), 2);
  EXPECT_EQ(surfaces[3].current->net(), (std::array<int, 2>{9, 5}));
  for (double s : {0., 0.1, 0.25, 0.6, 1.}) {
    for (double t : {0., 0.3, 0.5, 0.9, 1.}) {
      EXPECT_NEAR((at(*surfaces[0].current, s, t) - Point(10, 0, 0)).norm(), 2, 8 * epsilon * 12);
      const Point c = at(*surfaces[1].current, s, t), o = at(*surfaces[2].current, s, t);
      EXPECT_NEAR(std::hypot(c.x(), c.y()), 3, 8 * epsilon * 3);
      EXPECT_NEAR(c.z(), 5 * t, 8 * epsilon * 5);
      EXPECT_NEAR(std::hypot(std::hypot(o.x(), o.y()) - 4, o.z()), 0.5, 8 * epsilon * 5);
    }
  }
  const std::vector<std::string> names = {"sphere", "cylinder", "torus", "vase"};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(surfaces[k].name, names[k]);
  const auto saved = step::File::parse(*session.save(), "saved");
  ASSERT_TRUE(saved) << saved.error().message();
  EXPECT_EQ(saved->model().length_unit(), "inch");
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_TRUE(same_bits(saved->surfaces()[k].surface, *surfaces[k].current));
  EXPECT_EQ(saved->surfaces()[2].closed, (std::array<bool, 2>{true, true}));
  run(session, {R"({"do":"undo"})"});
  EXPECT_EQ(session.state().selected, 2);
}

TEST(NewCommand, RoundShapesCanBeSculpted) {
  for (const char* shape : {"sphere", "cylinder", "torus"}) {
    Session session = fresh();
    run(session,
        {std::string(R"({"do":"new","shape":")") + shape + R"(","radius":1})",
         R"({"do":"refine","region":[[0,1],[0,1]]})",
         R"({"do":"tool","radius":0.4,"position":[1.6,0,0.2],"plasticity":1})",
         R"({"do":"move","by":[-0.3,0,0]})", R"({"do":"step","count":3})", R"({"do":"remove"})"});
    EXPECT_GT(session.largest_displacement(0), 0.02) << shape;
    EXPECT_LT(session.largest_displacement(0), 0.5) << shape;
  }
}

TEST(NewCommand, PointsAreTakenBitForBit) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","degree":[1,2],"net":[2,3],)"
       R"("points":[[0,0,-0.0],[0,1,0.1],[0,2,0],[1,0,0],[1,1,0.3],[1,2,1e-300]]})",
       R"({"do":"new","degree":[1,1],"net":[2,2],"knots_u":[0,0,3,3],)"
       R"("points":[[0,0,0],[0,1,0],[1,0,0],[1,1,1]],"weights":[1,2,0.5,1],"position":[1,1,1]})"});
  const Surface& a = *session.state().surfaces[0].current;
  EXPECT_FALSE(a.rational());
  EXPECT_TRUE(std::signbit(a.control_points()(0, 2)));
  EXPECT_EQ(a.control_points()(1, 2), 0.1);
  EXPECT_EQ(a.control_points()(5, 2), 1e-300);
  const Surface& b = *session.state().surfaces[1].current;
  EXPECT_EQ(b.weights()[2], 0.5);
  EXPECT_EQ(b.knots(0)[2], 3);
  EXPECT_EQ(b.control_points().row(3), Eigen::RowVector3d(2, 2, 2));
  Session again = fresh();
  for (const Command& c : session.journal()) ASSERT_TRUE(again.execute(*parse_command(to_json(c))));
  EXPECT_TRUE(same_state(again.state(), session.state()));
}

TEST(NewCommand, RefusesWithThePlace) {
  Session session = fresh();
  const std::string square =
      R"("degree":[1,1],"net":[2,2],"points":[[0,0,0],[0,1,0],[1,0,0],[1,1,0]])";
  for (const auto& [fields, where] : std::vector<std::pair<std::string, std::string>>{
           {R"("shape":"cube")", "shape"},
           {R"("shape":"sphere","radius":0)", "radius"},
           {R"("shape":"cylinder","height":-1)", "height"},
           {R"("shape":"torus","radius":1,"minor":1)", "minor"},
           {R"("shape":"torus","weights":[1])", "weights"},
           {R"("shape":"sphere","knots_v":[0,0,1,1])", "knots_v"},
           {R"("shape":"cylinder","knots_u":[0,0,1,1])", "knots_u"},
           {R"("shape":"cylinder","net":[9,3])", "net"},
           {R"("shape":"revolution")", "profile"},
           {R"("shape":"revolution","profile":[[1,0],[1,1],[-1,2],[1,3]])", "profile[2]"},
           {R"("shape":"revolution","profile":[[1,0],[1,1],[1,2],[1,3]],)"
            R"("knots_v":[0,0,0,0,1,2,2,2,2])",
            "profile"},
           {R"("shape":"sphere",)" + square, "points"},
           {R"("degree":[1,1],"net":[2,3],"points":[[0,0,0],[0,1,0],[1,0,0],[1,1,0]])", "points"},
           {square + R"(,"weights":[1,1,1])", "weights"},
           {square + R"(,"weights":[1,1,0,1])", "weights[2]"},
           {square + R"(,"weights":[1,-1,0,1])", "weights[1]"},
           {square + R"(,"unit":"parsec")", "unit"}}) {
    const Error e = refusal(session, R"({"do":"new",)" + fields + "}");
    EXPECT_EQ(e.kind, ErrorKind::input) << fields;
    EXPECT_EQ(e.where.substr(0, where.size()), where) << fields << ": " << e.message();
    EXPECT_FALSE(e.remedy.empty()) << e.message();
  }
  EXPECT_FALSE(session.can_undo());
  run(session, {R"({"do":"new"})"});
  EXPECT_EQ(refusal(session, R"({"do":"new","unit":"inch"})").where, "unit");
}

}  // namespace
}  // namespace knead
