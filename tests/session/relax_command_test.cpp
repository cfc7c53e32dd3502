#include <gtest/gtest.h>

#include <cmath>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::on_sheet;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

constexpr const char* bump = R"({"do":"drag","at":[0.5,0.5],"by":[0,0,1],"radius":1.5})";

TEST(Relax, LowersABumpAndKeepsTheRestToTheBit) {
  Session session = on_sheet({bump});
  const auto before = std::make_shared<const SessionState>(session.state());
  const double height = at(*first(session).current, 0.5, 0.5).z();
  ASSERT_GT(height, 0.3);
  run(session, {R"({"do":"relax","at":[0.5,0.5],"radius":3})"});
  const double lower = at(*first(session).current, 0.5, 0.5).z();
  EXPECT_LT(lower, 0.95 * height) << "a bump as wide as the disc gives way least";
  EXPECT_GT(lower, 0);
  // Greville abscissae of the corner lie further away than the radius.
  const Points &old = before->surfaces[0].current->control_points(),
               &now = first(session).current->control_points();
  EXPECT_EQ(Point(old.row(0)), Point(now.row(0)));
  EXPECT_EQ(Point(old.row(11)), Point(now.row(11)));
  EXPECT_TRUE(same_bits(*first(session).rest, *first(session).current)) << "it stays";
  EXPECT_EQ(session.state().steps.size(), before->steps.size()) << "no step of the scene";
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), *before));
}

TEST(Relax, StrongerTakesMore) {
  double last = 1e9;
  for (const char* strength : {"0.1", "0.5", "0.9", "1"}) {
    Session session = on_sheet({bump});
    run(session,
        {std::string(R"({"do":"relax","at":[0.5,0.5],"radius":3,"strength":)") + strength + "}"});
    const double height = at(*first(session).current, 0.5, 0.5).z();
    EXPECT_LT(height, last) << strength;
    last = height;
  }
}

/// A plane is what a plate is at rest in.
TEST(Relax, LeavesAPlaneAlone) {
  Session session = on_sheet({R"({"do":"relax","at":[0.4,0.6],"radius":4})"});
  const Points difference =
      first(session).current->control_points() - first(session).opened->control_points();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-11) << "sheet of size 10: the solve's rounding";
}

TEST(Relax, KeepsWhatIsHeldAndMirrored) {
  Session held = on_sheet({bump, R"({"do":"freeze","region":[[0.4,0.6],[0.4,0.6]]})"});
  const Point middle = at(*first(held).current, 0.5, 0.5);
  run(held, {R"({"do":"relax","at":[0.5,0.5],"radius":4})"});
  EXPECT_LT((at(*first(held).current, 0.5, 0.5) - middle).norm(), 1e-14);

  Session mirrored = on_sheet({R"({"do":"symmetry","mirror":"u"})",
                               R"({"do":"drag","at":[0.3,0.5],"by":[0,0,1],"radius":1.5})"});
  const double before = at(*first(mirrored).current, 0.3, 0.5).z();
  ASSERT_GT(before, 0.2);
  run(mirrored, {R"({"do":"relax","at":[0.3,0.5],"radius":2})"});
  const double left = at(*first(mirrored).current, 0.3, 0.5).z();
  EXPECT_LT(left, 0.95 * before);
  EXPECT_NEAR(left, at(*first(mirrored).current, 0.7, 0.5).z(), 1e-9);
}

TEST(Relax, Refuses) {
  Session session = on_sheet({});
  EXPECT_EQ(refusal(session, R"({"do":"relax","at":[2,0]})").where, "at");
  EXPECT_EQ(refusal(session, R"({"do":"relax","at":[0,0],"radius":0})").where, "radius");
  EXPECT_EQ(refusal(session, R"({"do":"relax","at":[0,0],"strength":0})").where, "strength");
  EXPECT_EQ(refusal(session, R"({"do":"relax","at":[0,0],"strength":1.1})").where, "strength");
}

}  // namespace
}  // namespace knead
