// How far what presses, strokes, brushes and drags move goes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::run;

double furthest(const Session& session) { return session.largest_displacement(0); }

std::vector<std::string> pressed_sheet(double radius, double depth) {
  return {R"({"do":"new","size":[200,200],"net":[20,20]})", R"({"do":"hold","rows":2})",
          R"({"do":"material","preset":"clay"})",
          fmt::format(R"({{"do":"tool","name":"b","radius":{},"position":[100,100,{}]}})", radius, 2 * radius),
          fmt::format(R"({{"do":"stroke","tool":"b","path":[[100,100,{}]]}})", radius - depth)};
}

TEST(MotionLaw, ABallLargerThanTheSheetGoesAsDeepAsAsked) {
  for (const auto& [radius, depth] : {std::pair{20., 8.}, {200., 100.}, {500., 250.}}) {
    Session session = fresh();
    run(session, pressed_sheet(radius, depth));
    EXPECT_GE(furthest(session), 0.9 * depth) << radius;
    EXPECT_LE(furthest(session), 1.05 * depth) << radius;
  }
}

TEST(MotionLaw, StepsUnderABallLargerThanTheSheetGoAsDeepAsAsked) {
  for (const auto& [radius, depth] : {std::pair{200., 100.}, {500., 250.}}) {
    Session session = fresh();
    run(session,
        {R"({"do":"new","size":[200,200],"net":[20,20]})", R"({"do":"hold","rows":2})",
         fmt::format(R"({{"do":"tool","name":"b","radius":{},"position":[100,100,{}]}})", radius, radius - depth),
         R"({"do":"step","count":10})"});
    EXPECT_GE(furthest(session), 0.9 * depth) << radius;
    EXPECT_LE(furthest(session), 1.05 * depth) << radius;
  }
}

}  // namespace
}  // namespace knead
