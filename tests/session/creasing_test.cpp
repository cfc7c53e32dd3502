// Seams that were smooth and are coupled in position only: what is said of them, and what keeps
// them smooth.
#include "pieces.hpp"
#include "support/error_codes.hpp"

#include <numbers>

namespace knead::testing {
namespace {

const std::vector<std::string> soft = {
    R"({"do":"material","preset":"clay"})",
    R"({"do":"tool","shape":"sphere","radius":20,"position":[100,100,60],"plasticity":1})"};
const std::string pressed = R"({"do":"stroke","path":[[40,120,12],[160,90,12]]})";

std::vector<std::string> creases(const Session& session) {
  std::vector<std::string> found;
  for (const std::string& note : session.state().notes) {
    if (note.find("has a crease of") != std::string::npos) found.push_back(note);
  }
  return found;
}

/// Largest angle, degrees, between the tangent planes at the three seams of `three`, and the
/// largest gap.
std::pair<double, double> worst(const Session& session) {
  const auto jet = [&](std::size_t k, double s, double t) {
    const Surface& surface = *session.state().surfaces[k].current;
    Parameters<2> at(1, 2);
    at << s, t;
    const auto found = evaluate<2>(surface, at, 1);
    const Point su = found->at({1, 0}).row(0), sv = found->at({0, 1}).row(0);
    return std::pair<Point, Point>(found->points().row(0), su.cross(sv).normalized());
  };
  double angle = 0, gap = 0;
  for (int k = 0; k <= 997; ++k) {
    const double t = k / 997.;
    for (const auto& [a, b] : {std::pair{jet(0, t, 0), jet(1, 0, t)},
                               {jet(0, 0, t), jet(2, t, 0)},
                               {jet(1, t, 0), jet(2, 0, t)}}) {
      gap = std::max(gap, (a.first - b.first).norm());
      angle = std::max(
          angle, std::atan2(a.second.cross(b.second).norm(), std::abs(a.second.dot(b.second))));
    }
  }
  return {angle * 180 / std::numbers::pi, gap};
}

TEST(Creasing, IsSaidWithItsPlaceAndItsReasonAndEndsWhereSeamsStaySmooth) {
  Session session = pieces(three(), soft);
  run(session, {pressed});
  const std::vector<std::string> said = creases(session);
  const auto [crease, gap] = worst(session);
  EXPECT_GT(crease, 1);
  EXPECT_LT(gap, 1e-12 * 200);
  ASSERT_GE(said.size(), 1U);
  EXPECT_TRUE(testing::has_note(session.state().notes, ErrorCode::seam_creased));
  EXPECT_NE(said[0].find("in no fixed ratio"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find(R"({"do":"seams","smooth":true})"), std::string::npos) << said[0];
  run(session, {R"({"do":"undo"})", R"({"do":"seams","smooth":true})", pressed});
  const auto [angle, still] = worst(session);
  double deepest = 0;
  for (const Surface* s : shapes_of(session, &SceneSurface::current)) {
    deepest = std::max(deepest, -s->control_points().col(2).minCoeff());
  }
  EXPECT_NEAR(deepest, 8, 0.64) << "and the groove is there";
  EXPECT_LT(angle, 1e-3);
  EXPECT_LT(still, 1e-12 * 200);
  EXPECT_TRUE(creases(session).empty());
}

TEST(Creasing, NothingIsSaidOfSeamsThatStaySmooth) {
  Session session = pieces(halves({40, 40}, {40, 40}), soft);
  run(session, {pressed});
  EXPECT_TRUE(creases(session).empty());
}

}  // namespace
}  // namespace knead::testing
